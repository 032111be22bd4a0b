#include "jit/check/short_paths.h"

#include <algorithm>
#include <cmath>

namespace haptel::jit {

namespace {

constexpr int halvings = 26, halvings_before = 13; // of a path; by then what is smooth looks straight
constexpr double rounding = 1e-9;                  // of the largest values met

// Far enough to meet a seam that crosses the box once, and near enough to meet one of many.
constexpr double shares[] = {1.0 / 4, 1.0 / 32, 1.0 / 256};
// As many as a texture of 10 000 operations follows within a second.
constexpr uint64_t operations_most = 400'000'000, paths_least = 12, paths_most = 1200;

double distance(const double (&a)[3], const double (&b)[3])
{
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

} // namespace

void ShortPaths::Worst::meet(double other, const double (&at_m)[3])
{
    if (other <= size) return;
    size = other;
    std::copy(at_m, at_m + 3, p_m);
}

void ShortPaths::follow(uint64_t index, double share, bool by_height_alone)
{
    const haptel_point first = points.random(2 * index), second = points.random(2 * index + 1);
    double end[3];
    for (size_t i = 0; i < 3; ++i) end[i] = first.p[i] + (second.p[i] - first.p[i]) * share;
    halve(touch(first.p), touch(end), true);
    if (!by_height_alone) halve(touch(first.p), touch(end), false);
}

ShortPaths::Touch ShortPaths::touch(const double (&p_m)[3])
{
    Touch touched{points.at(p_m), {}};
    binding.texture->height_gradient(&touched.point, binding.block, &touched.sample);
    const double slope = distance(touched.sample.gradient, {});
    if (slope > binding.facts.slope_max * (1 + rounding)) {
        ++too_steep;
        steepest.meet(slope, p_m);
    }
    largest_height = std::max(largest_height, std::fabs(touched.sample.height_m));
    largest_gradient = std::max(largest_gradient, slope);
    return touched;
}

void ShortPaths::halve(Touch a, Touch b, bool by_height)
{
    const auto change = [by_height](const Touch& one, const Touch& other) {
        return by_height ? std::fabs(one.sample.height_m - other.sample.height_m)
                         : distance(one.sample.gradient, other.sample.gradient);
    };
    // Of two halves the one that a jump is in: what the gradients at both ends account for is no jump, and were it
    // counted, a steep half would hide one in the other.
    const auto unaccounted = [&](const Touch& one, const Touch& other) {
        double by_gradient = 0;
        for (size_t k = 0; k < 3; ++k)
            by_gradient +=
                (one.sample.gradient[k] + other.sample.gradient[k]) / 2 * (other.point.p[k] - one.point.p[k]);
        const double rest = std::fabs(other.sample.height_m - one.sample.height_m - by_gradient);
        return by_height && std::isfinite(rest) ? rest : change(one, other);
    };
    double before = 0;
    for (int i = 0; i < halvings; ++i) {
        double p_m[3];
        for (size_t k = 0; k < 3; ++k) p_m[k] = a.point.p[k] / 2 + b.point.p[k] / 2;
        const Touch middle = touch(p_m);
        if (i == halvings_before) before = change(a, b);
        (unaccounted(a, middle) > unaccounted(middle, b) ? b : a) = middle;
    }
    const double left = change(a, b);
    const double size = by_height ? largest_height : largest_gradient;
    if (left > 0.4 * before && left > 100 * rounding * size) {
        const uint32_t met = by_height ? HAPTEL_CONTINUITY_JUMP : HAPTEL_CONTINUITY_C0;
        if (met < roughest) {
            roughest = met;
            std::copy(a.point.p, a.point.p + 3, roughest_p_m);
        }
        if (by_height && (!highest_jump || left > highest_jump->height_m))
            highest_jump = Jump{left, {a.point.p[0], a.point.p[1], a.point.p[2]}, a.point.time_s};
    }
    const bool is_promised = binding.facts.continuity == HAPTEL_CONTINUITY_C1;
    const double length = distance(a.point.p, b.point.p), turned = distance(a.sample.gradient, b.sample.gradient);
    const double reach = length * binding.facts.curvature_max_per_m;
    if (is_promised && turned > reach * (1 + rounding) + rounding * largest_gradient) {
        ++too_curved;
        most_curved.meet(turned / length, a.point.p);
    }
}

std::optional<Jump> find_jump(const TextureBinding& binding, const CheckBox& box)
{
    const CheckPoints points(box, 1);
    ShortPaths paths(binding, points);
    const uint64_t operations = std::max<uint64_t>(binding.facts.operations_max, 1);
    const uint64_t count = std::clamp(operations_most / (halvings * operations), paths_least, paths_most);
    for (uint64_t i = 0; i < count; ++i) paths.follow(i, shares[i % std::size(shares)], true);
    return paths.highest_jump;
}

} // namespace haptel::jit
