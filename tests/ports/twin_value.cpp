// Twins of value noises and of sums of their octaves: numbers at the corners of a lattice, blended between.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>

namespace haptel::ports {
namespace {

double sine_noise(dvec3 q)
{
    return blend_corners(dvec2(q), [](dvec2 c) { return sine_hash(c.x * 12.9898 + c.y * 78.233, 43758.5453); }, fade3);
}

double pcg_noise_2d(dvec3 q)
{
    const auto corner = [](dvec2 c) {
        constexpr uint32_t factor = 747796405;
        uint32_t a = whole(c.x) * factor + 2891336453u, b = whole(c.y) * factor + 2891336453u;
        for (int round = 0; round < 2; ++round) {
            const uint32_t old = a;
            a += b * factor;
            b += old * factor;
            a ^= a >> 16;
            b ^= b >> 15;
        }
        return b / 4294967295.0;
    };
    return 2 * blend_corners(2.0 * dvec2(q), corner, fade5) - 1;
}

double pcg_noise_3d(dvec3 q)
{
    const auto corner = [](dvec3 c) {
        uint32_t v[3];
        for (int i = 0; i < 3; ++i) v[i] = whole(c[i]) * 22695477u + 1;
        for (int turn = 0; turn < 2; ++turn) {
            v[2] ^= v[2] >> 17;
            v[0] += v[1] * v[2];
            v[1] += v[2] * v[0];
            std::rotate(v, v + 2, v + 3); // the last one first
        }
        return ((v[2] ^ v[2] >> 16) % 65536) / 65535.0;
    };
    return blend_corners(q, corner, fade3);
}

// n (34 n + 10) mod 289, of whole numbers.
int64_t permuted(int64_t n)
{
    return n * (34 * n + 10) % 289;
}

double permute_noise(dvec3 q)
{
    const auto corner = [](dvec2 c) {
        const auto below_289 = [](double x) { return (static_cast<int64_t>(x) % 289 + 289) % 289; };
        return static_cast<double>(permuted(permuted(below_289(c.x)) + below_289(c.y))) / 289;
    };
    return blend_corners(dvec2(q) + dvec2(3.7, 91.3), corner, fade3);
}

double fbm_define(dvec3 q)
{
    const auto corner = [](dvec2 c) { return sine_hash(c.x * 91.7 + c.y * 271.3, 4375.85); };
    double sum = 0;
    dvec2 at(q);
    for (int octave = 1; octave <= 5; ++octave) {
        sum += std::ldexp(blend_corners(at, corner, fade3), -octave);
        at = 2.03 * turned(at, -0.5) + 100.0;
    }
    return sum;
}

double fbm_param(dvec3 q)
{
    const auto corner = [](dvec2 c) {
        uint32_t n = whole(c.x + 1301 * c.y);
        n ^= n << 9;
        n *= n * 60493 + 19990303;
        return ((n ^ n >> 14) % 0x80000000u) / 2147483647.0;
    };
    double sum = 0;
    for (int octave = 0; octave < 4; ++octave) { // of the default
        const dvec2 at = std::pow(2.02, octave) * turned(dvec2(q), octave * std::acos(0.6));
        sum += std::ldexp(blend_corners(at, corner, fade3), -octave);
    }
    return sum * 8 / 15;
}

double ridged(dvec3 q)
{
    const auto corner = [](dvec3 c) { return sine_hash(c.x + 59 * c.y + 131 * c.z, 753.5453123); };
    double sum = 0, before = 1;
    for (int octave = 0; octave < 6; ++octave) {
        const double noise = 2 * blend_corners(std::ldexp(1, octave) * 0.7 * q, corner, fade3) - 1;
        const double height = std::pow(0.9 - std::fabs(noise), 2);
        sum += std::ldexp(height * (1 + before), -octave - 1);
        before = height;
    }
    return sum;
}

double turbulence_abs(dvec3 q)
{
    const dmat3 turn(2, 2, 1, -2, 1, 2, 1, -2, 2); // three times a rotation
    double sum = 0;
    for (int octave = 0; octave < 6; ++octave) { // 0.55 to the 6th is less than 0.05
        double wave = 0;
        for (int i = 0; i < 3; ++i) wave += std::sin(q[i]) * std::cos(q[(i + 2) % 3] * 1.3 + 0.7);
        sum += std::pow(0.55, octave) * std::fabs(wave / 3);
        q = 2.0 * (turn * q) / 3.0 + 1.7;
    }
    return sum;
}

double domain_warp(dvec3 q)
{
    const auto corner = [](dvec2 c) { return sine_hash(c.x * 41.7 + c.y * 289.3, 1543.123); };
    const auto fractal = [&](dvec2 at) {
        const dvec2 shift(3.9, 7.1);
        return blend_corners(at, corner, fade3) / 2 + blend_corners(2.0 * at + shift, corner, fade3) / 4 +
               blend_corners(4.0 * at + 3.0 * shift, corner, fade3) / 8;
    };
    const dvec2 at(q);
    const dvec2 a(fractal(at), fractal(at + dvec2(4.4, 2.6)));
    const dvec2 b(fractal(at + 1.5 * a + dvec2(8.1, 0.4)), fractal(at + 1.5 * a + dvec2(2.9, 6.3)));
    const double last = fractal(at + 1.5 * b);
    return last + (a.x - last) * b.y / 4 + 0.2 * (b.x * b.x + b.y * b.y);
}

double marble(dvec3 q)
{
    const auto corner = [](dvec3 c) { return sine_hash(c.x * 7.13 + c.y * 157.31 + c.z * 113.17, 438.545); };
    double sum = 0;
    for (const double k : {1, 2, 4, 8, 16}) sum += std::fabs(blend_corners(k * q, corner, fade3) - 0.5) / k;
    return std::pow((1 + std::sin(pi * q.x + 2 * pi * q.y + 6 * sum)) / 2, 1.5);
}

} // namespace

std::span<const Twin> value_twins()
{
    static constexpr const char* shared = "neighbouring cells share their corners";
    static constexpr Twin twins[] = {
        {"sine_noise", sine_noise, Borders::meet, shared},
        {"pcg_noise_2d", pcg_noise_2d, Borders::meet, shared},
        {"pcg_noise_3d", pcg_noise_3d, Borders::meet, shared},
        {"permute_noise", permute_noise, Borders::meet, shared},
        {"fbm_define", fbm_define, Borders::meet, shared},
        {"fbm_param", fbm_param, Borders::meet, shared},
        {"ridged", ridged, Borders::meet, shared},
        {"turbulence_abs", turbulence_abs, Borders::meet, "no cells"},
        {"domain_warp", domain_warp, Borders::meet, shared},
        {"marble", marble, Borders::meet, shared},
    };
    return twins;
}

} // namespace haptel::ports
