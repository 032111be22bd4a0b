// Twins of things that are scattered, each in or near a cell of its own. They look at two cells to each side: a pattern
// that cut a thing off at the end of its window would differ.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace haptel::ports {
namespace {

constexpr int around = 2;

template <typename Visit>
void visit_cells(dvec2 q, Visit visit) // in no order that counts
{
    const dvec2 low = glm::floor(q);
    for (int i = around; i >= -around; --i)
        for (int j = around; j >= -around; --j) visit(low + dvec2(i, j));
}

double polka_dots(dvec3 q)
{
    const dvec2 at = turned(dvec2(q), pi / 4), cell = glm::floor(at);
    const double radius = 0.2 + 0.25 * sine_hash(cell.x * 21.98 + cell.y * 61.23, 397.53);
    const double square = std::pow(glm::distance(at, cell + 0.5) / radius, 2);
    return square < 1 ? radius / 0.45 * std::pow(1 - square, 2) : 0;
}

double splats(dvec3 q)
{
    double dry = 1; // each drop leaves this share of what lacks to a height of 2
    visit_cells(dvec2(q), [&](dvec2 cell) {
        uint32_t state = (whole(cell.x) * 40503u + whole(cell.y) * 26699u) * 2654435769u | 1u;
        const auto next = [&state] {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            return (state / 16) / 268435456.0;
        };
        for (int k = 0; k < 3; ++k) {
            const double x = next(), y = next(), radius = 0.2 + 0.5 * next();
            const dvec2 way = cell + dvec2(x, y) - dvec2(q);
            const double left = 1 - glm::dot(way, way) / (radius * radius);
            if (left > 0) dry *= 1 - radius * std::pow(left, 3) / 2;
        }
    });
    const double height = 2 * (1 - dry), apart = std::fabs(height - 0.1);
    return std::max(height, 0.1) + (apart < 0.1 ? std::pow(0.1 - apart, 2) / 0.4 : 0);
}

double scratches(dvec3 q)
{
    double deepest = 0;
    visit_cells(dvec2(q), [&](dvec2 c) {
        const double angles[] = {c.x * 11.3 + c.y * 47.9, c.x * 83.1 + c.y * 29.7, c.x * 53.7 + c.y * 71.3,
                                 c.x * 19.9 + c.y * 67.7};
        double h[4];
        for (int i = 0; i < 4; ++i) h[i] = sine_hash(angles[i], 1973.137);
        const double length = 0.2 + 0.4 * h[3]; // to each side of the middle
        const dvec2 from_middle = turned(dvec2(q) - c - 0.25 - dvec2(h[1], h[2]) / 2.0, -2 * pi * h[0]);
        const double beyond = std::max(std::fabs(from_middle.x) - length, 0.0);
        deepest = std::max(deepest, ramp(0.1, 0.02, std::hypot(beyond, from_middle.y)) * (0.3 + 0.7 * h[2]));
    });
    return -deepest;
}

double sparse_gabor(dvec3 q)
{
    double sum = 0;
    visit_cells(dvec2(q), [&](dvec2 cell) {
        uint32_t s = whole(cell.x) * 19u + whole(cell.y) * 47u + 101u;
        s ^= s << 11;
        const auto next = [&s] {
            s = s * 1664525u + 1013904223u;
            return (s / 256) / 16777216.0;
        };
        next();
        if (next() < 0.25) return;
        for (int k = 0; k < 2; ++k) {
            const double x = next(), y = next(), way = 0.6 + 0.5 * (next() - 0.5), phase = next();
            const dvec2 from = turned(dvec2(q) - cell - dvec2(x, y), -way);
            const double left = 1 - glm::dot(from, from);
            if (left > 0) sum += std::pow(left, 3) * std::cos(2 * pi * (3 * from.x + phase));
        }
    });
    return sum / 2;
}

double fingerprint(dvec3 q)
{
    std::complex<double> sum = 0;
    visit_cells(dvec2(q), [&](dvec2 c) {
        const double n = c.x + 37 * c.y;
        const dvec2 random(fraction(0.7548776662 * n), fraction(0.5698402910 * n));
        const dvec2 from = dvec2(q) - c - random;
        const double left = 1 - glm::dot(from, from);
        if (left <= 0) return;
        const double way = 0.6 * std::sin(0.31 * (c.x + 0.5)) + 0.8 * std::cos(0.23 * (c.y + 0.5)) + 0.5;
        sum += std::polar(left * left, 8 * turned(from, -way).x + 6.2831853 * random.x);
    });
    const double strength = std::abs(sum);
    return strength > 0 ? ramp(0, 0.3, strength) * (1 + sum.imag() / strength) / 2 : 0;
}

double confetti(dvec3 q)
{
    double level = 0;
    visit_cells(dvec2(q), [&](dvec2 c) {
        const double n = c.x + 57 * c.y;
        const auto hash = [n](double more) { return sine_hash((n + more) * 17.231, 9173.31); };
        const dvec2 from = turned(dvec2(q) - c - 0.3 - 0.4 * dvec2(hash(0), hash(0.5)), -pi * hash(0.25));
        if (std::fabs(from.x) <= 0.4 && std::fabs(from.y) <= 0.3) level = std::max(level, 0.2 + 0.8 * hash(0.75));
    });
    return level;
}

double hammered(dvec3 q)
{
    double deepest = 0;
    for (const double layer : {0, 1}) {
        const dvec2 at = (1 + layer / 2) * dvec2(q) + layer * dvec2(0.37, 0.71);
        visit_cells(at, [&](dvec2 c) {
            const double n = c.x * 7 + c.y * 113 + layer * 271;
            const dvec2 random(sine_hash(n, 431.7), fraction(std::cos(n * 1.7) * 277.3));
            const dvec2 way = c + 0.25 + random / 2.0 - at;
            deepest = std::min(deepest, glm::dot(way, way) - 0.49);
        });
    }
    return deepest;
}

} // namespace

std::span<const Twin> scatter_twins()
{
    static constexpr const char* within = "each thing is 0 at its own rim, which is within the window";
    static constexpr Twin twins[] = {
        {"polka_dots", polka_dots, Borders::meet, within},
        {"splats", splats, Borders::meet, within},
        {"scratches", scratches, Borders::meet, within},
        {"sparse_gabor", sparse_gabor, Borders::meet, within},
        {"fingerprint", fingerprint, Borders::meet, within},
        {"confetti", confetti, Borders::jump, "squares of different heights have hard edges"},
        {"hammered", hammered, Borders::meet, within},
    };
    return twins;
}

} // namespace haptel::ports
