#include "tests/stdlib/lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace haptel::test {

namespace {

double value_change(const FieldSample& a, const FieldSample& b)
{
    return std::fabs(a.value - b.value);
}

double gradient_change(const FieldSample& a, const FieldSample& b)
{
    return std::hypot(a.gradient[0] - b.gradient[0], a.gradient[1] - b.gradient[1], a.gradient[2] - b.gradient[2]);
}

} // namespace

Jumps jumps_along_lines(const Field& field, double size, int count)
{
    constexpr int steps = 64, halvings = 30;
    std::mt19937_64 random(7);
    const auto within = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    Jumps greatest;
    for (int line = 0; line < count; ++line) {
        const double x = within(-size, size), y = within(-size, size), angle = within(0, 2 * std::numbers::pi);
        const auto at = [&](double t) { return field({x + t * std::cos(angle), y + t * std::sin(angle), 0}); };
        for (const auto change : {value_change, gradient_change}) {
            double from = 0, most = -1;
            FieldSample before = at(0);
            for (int i = 0; i < steps; ++i) {
                const FieldSample after = at((i + 1.0) / steps);
                if (change(before, after) > most) most = change(before, after), from = static_cast<double>(i) / steps;
                before = after;
            }
            double to = from + 1.0 / steps;
            FieldSample first = at(from), last = at(to);
            for (int i = 0; i < halvings; ++i) {
                const double middle = from + (to - from) / 2;
                const FieldSample between = at(middle);
                const bool is_left = change(first, between) > change(between, last);
                (is_left ? to : from) = middle;
                (is_left ? last : first) = between;
            }
            double& found = change == value_change ? greatest.value : greatest.gradient;
            found = std::max(found, change(first, last));
        }
    }
    return greatest;
}

} // namespace haptel::test
