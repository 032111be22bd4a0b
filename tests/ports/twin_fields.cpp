// Twins of fields without cells, or with few: level sets in space, waves, rings, wood and sand, orbits.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace haptel::ports {
namespace {

double gyroid_sheet(dvec3 q)
{
    const auto sheet = [&q](double k, double thickness) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) sum += std::sin(k * q[i]) * std::cos(k * q[(i + 2) % 3]);
        return std::fabs(sum) / k - thickness;
    };
    return ramp(0.25, -0.05, std::max(sheet(1.7, 0.03), -0.7 * sheet(4.3, 0.02)));
}

double schwarz_p(dvec3 q)
{
    const dvec2 around = turned(dvec2(q), -0.1 * q.z);
    const double sum = std::cos(2 * around.x) + std::cos(2 * around.y) + std::cos(2 * q.z);
    return (1 + std::sin(std::atan(sum))) / 2; // the sine of the angle with that tangent
}

double wood_rings(dvec3 q)
{
    const auto noise = [](dvec2 at) {
        return blend_corners(at, [](dvec2 c) { return fraction(std::sin(c.x * 41.0 + c.y * 289.0) * 4567.13); }, fade3);
    };
    const double x = q.x + 0.4 * noise(0.7 * dvec2(q.x, q.z)), y = q.y + 0.4 * noise(0.7 * dvec2(q.y, q.z) + 9.0);
    const double ring = fraction(1.2 * std::hypot(x + 0.3, y + 11));
    return std::min(ring / 0.8, (1 - ring) / 0.2);
}

double wood_grain(dvec3 q)
{
    const auto noise = [](double x, double y) {
        const auto corner = [](dvec2 c) {
            uint32_t h = whole(c.x) * 0x27d4eb2fu ^ whole(c.y) * 0x165667b1u;
            h = (h ^ h >> 15) * 0x85ebca77u;
            return (h / 256) / 16777216.0;
        };
        return blend_corners(dvec2(x, y), corner, fade3);
    };
    const double fibres = 0.6 * noise(0.6 * q.x, 9 * q.y) + 0.4 * noise(1.38 * q.x + 40, 20.7 * q.y + 40);
    const double pore = ramp(0.7, 0.85, noise(1.5 * q.x, 14 * q.y));
    return fibres + 0.2 * std::sin(5 * q.y + 2 * noise(0.2 * q.x, q.y)) - 0.6 * pore;
}

double sand_ripples(dvec3 q)
{
    const auto slow = [](dvec2 at) {
        return blend_corners(at, [](dvec2 c) { return fraction(std::sin(c.x + 57 * c.y) * 1751.5453); }, fade5);
    };
    const auto crest = [](double phase) { return std::pow(1 - std::fabs(std::sin(phase)), 2); };
    const dvec2 at(q);
    const double bend = 2.5 * slow(0.4 * at) + 0.4 * slow(1.7 * at + 31.0), share = 0.3 * slow(0.2 * at + 7.0);
    return (1 - share) * crest(2 * q.x + bend) + share * crest(2.6 * q.x + 1 - bend);
}

double caustic_net(dvec3 q)
{
    double light = 0;
    for (int n = 1; n <= 5; ++n) {
        const double t = 1.3 * n, x = q.x;
        q.x += 0.6 / n * std::sin(1.7 * q.y + t);
        q.y += 0.6 / n * std::cos(1.9 * x - t);
        light += 0.02 / (0.1 + std::hypot(std::sin(q.x + t), std::cos(q.y - t)));
    }
    return std::min(1.5 * std::pow(light, 1.4), 1.0);
}

double sine_storm(dvec3 q)
{
    const std::complex<double> at(1.3 * q.x, 1.3 * q.y);
    std::complex<double> bend = 0;
    double height = 0;
    for (int f = 1; f <= 5; ++f) {
        const double share = 0.5 * std::pow(0.75, f - 1);
        const std::complex<double> way = std::polar(1.0, 2.4 * f);
        const double phase = f * (std::conj(way) * (at + bend)).real() + f * f, up = (1 + std::sin(phase)) / 2;
        height += share * std::pow(up, 3);
        bend += 0.4 * share * up * std::cos(phase) * way;
    }
    return height;
}

double orbit_trap(dvec3 q)
{
    const auto mirrored = [](double x) { return 2 * std::fabs(x / 10 - std::round(x / 10)) - 0.5; };
    std::complex<double> z(mirrored(q.x), mirrored(q.y));
    double least = 1e3;
    for (int i = 0; i < 5; ++i) {
        z = z * z + std::complex<double>(-0.4, 0.6);
        if (std::norm(z) > 1.5) break;
        const double to_ring = std::fabs(std::abs(z) - 0.5);
        least = std::min({least, std::fabs(z.real()) + 0.01 * i, std::fabs(z.imag()) + 0.01 * i, to_ring + 0.01 * i});
    }
    return 1 - std::exp(-4 * least);
}

double concentric_waves(dvec3 q)
{
    const double column = std::floor(q.x / 2), row = std::floor(q.y / 2);
    const double r = std::hypot(q.x - 2 * column - 1, q.y - 2 * row - 1); // in tiles of 2, whose middles are odd
    const double wave = std::pow(std::cos(12 * r), 2) * ramp(0.95, 0.6, r);
    return std::fmod(column + row, 2) != 0 ? -wave : wave;
}

double moire_rings(dvec3 q)
{
    const auto grating = [](double phase) { return (1 + std::sin(phase)) / 2; };
    return grating(9 * glm::distance(q, dvec3(1, 0.5, -0.7))) *
               grating(9.5 * glm::distance(q, dvec3(-0.8, 0.6, -0.2))) +
           0.2 * grating(7 * q.x + 2.1 * q.y);
}

double spiral_groove(dvec3 q)
{
    const double r = std::hypot(q.x, q.y), winds = 0.8 * r - std::atan2(q.y, q.x) / (2 * pi);
    return -ramp(0.25, 0, 0.5 - std::fabs(winds - std::round(winds))) * ramp(0.5, 1.5, r);
}

double quasi_crystal(dvec3 q)
{
    double sum = 0;
    for (int k = 0; k < 7; ++k) sum += std::cos(4 * turned(dvec2(q), -pi * k / 7).x); // of the default
    return std::fabs(sum / 2 - 2 * std::round(sum / 4));
}

double while_folds(dvec3 q)
{
    const double eighth = pi / 4, r = std::hypot(q.x, q.y), angle = std::atan2(q.y, q.x);
    const double folded = std::fabs(angle - eighth * std::round(angle / eighth));
    const double wave = std::cos(3 * r * std::cos(folded)) * std::cos(5 * r * std::sin(folded));
    return 0.4 + 0.4 * wave + 0.1 * std::fabs(r - 4 * std::round(r / 4));
}

} // namespace

std::span<const Twin> field_twins()
{
    static constexpr const char* none = "no cells";
    static constexpr const char* shared = "neighbouring cells share their corners";
    static constexpr Twin twins[] = {
        {"gyroid_sheet", gyroid_sheet, Borders::meet, none},
        {"schwarz_p", schwarz_p, Borders::meet, none},
        {"wood_rings", wood_rings, Borders::meet, "a ring rises from 0 and falls to 0"},
        {"wood_grain", wood_grain, Borders::meet, shared},
        {"sand_ripples", sand_ripples, Borders::meet, shared},
        {"caustic_net", caustic_net, Borders::meet, none},
        {"sine_storm", sine_storm, Borders::meet, none},
        {"orbit_trap", orbit_trap, Borders::jump, "an orbit may be as near as 0 to an axis where it leaves"},
        {"concentric_waves", concentric_waves, Borders::meet, "0 at the sides of tiles"},
        {"moire_rings", moire_rings, Borders::meet, none},
        {"spiral_groove", spiral_groove, Borders::meet, "a whole wind more is the same place, and the middle is flat"},
        {"quasi_crystal", quasi_crystal, Borders::meet, "a fold, whose halves meet"},
        {"while_folds", while_folds, Borders::meet, "mirrors: both sides are alike"},
    };
    return twins;
}

} // namespace haptel::ports
