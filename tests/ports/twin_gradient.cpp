// Twins of gradient and simplex noises, and of other sums over a lattice whose corners have more than a number.
#include "tests/ports/twin.h"

#include <bit>
#include <cmath>

namespace haptel::ports {
namespace {

template <int N>
using Point = glm::vec<N, double>;

template <int N>
struct Plane { // what a corner adds to: a value at the corner itself, and a slope
    double value;
    Point<N> slope;
};

// Planes at the corners of the cell of q, blended by a fade: the sum with its slope, by the rule of products.
template <int N, typename Corner>
Plane<N> blend_planes(const Point<N>& q, Corner corner, double fade(double), double fade_slope(double))
{
    const Point<N> low = glm::floor(q);
    Plane<N> sum{};
    for (int bits = 0; bits < 1 << N; ++bits) {
        Point<N> at = low;
        for (int i = 0; i < N; ++i) at[i] += bits >> i & 1;
        const Point<N> away = q - at;
        const Plane<N> plane = corner(at);
        const double value = plane.value + glm::dot(plane.slope, away);
        double weight = 1;
        for (int i = 0; i < N; ++i) weight *= fade(1 - std::fabs(away[i]));
        sum.value += weight * value;
        sum.slope += weight * plane.slope;
        for (int i = 0; i < N; ++i) {
            double slope = away[i] > 0 ? -fade_slope(1 - away[i]) : fade_slope(1 + away[i]);
            for (int j = 0; j < N; ++j)
                if (j != i) slope *= fade(1 - std::fabs(away[j]));
            sum.slope[i] += slope * value;
        }
    }
    return sum;
}

double fade3_slope(double t)
{
    return 6 * t * (1 - t);
}
double fade5_slope(double t)
{
    return 30 * t * t * (1 - t) * (1 - t);
}

double gradient_2d(dvec3 q)
{
    const auto corner = [](dvec2 c) {
        uint32_t n = 30011 * whole(c.x) + 7919 * whole(c.y);
        n ^= n << 11;
        n *= n * 12347 + 65437;
        const double angle = (n >> 17) % 8 * pi / 4;
        return Plane<2>{0, {std::cos(angle), std::sin(angle)}};
    };
    const Plane<2> noise = blend_planes<2>(1.5 * dvec2(q), corner, fade5, fade5_slope);
    return noise.value + 0.06 * noise.slope.x + 0.08 * noise.slope.y;
}

double gradient_3d(dvec3 q)
{
    const auto corner = [](dvec3 c) {
        static constexpr double rows[3][3] = {{91.3, 233.7, 57.1}, {187.9, 71.3, 143.3}, {61.9, 157.3, 211.7}};
        Plane<3> plane{};
        for (int i = 0; i < 3; ++i) {
            const double angle = c.x * rows[i][0] + c.y * rows[i][1] + c.z * rows[i][2]; // in GLSL's order
            plane.slope[i] = 2 * fraction(std::sin(angle) * 437.75) - 1;
        }
        return plane;
    };
    const Plane<3> noise = blend_planes<3>(q, corner, fade5, fade5_slope);
    return 0.8 * noise.value + 0.05 * 0.577350269 * (noise.slope.x + noise.slope.y + noise.slope.z);
}

double eroded(dvec3 q)
{
    // Its products amplify rounding, so operations have GLSL's order here.
    const auto corner = [](dvec2 c) {
        const double a = 37 * fraction(c.x * 0.2763932 + 0.31), b = 37 * fraction(c.y * 0.2763932 + 0.57);
        return Plane<2>{2 * fraction(a * (a + 1.7) * (b + 3.1)) - 1, {}};
    };
    double sum = 0;
    dvec2 slopes(0);
    for (int octave = 0; octave < 5; ++octave) {
        const dvec2 at = std::ldexp(0.5, octave) * turned(dvec2(q), -octave * std::acos(0.8));
        const Plane<2> noise = blend_planes<2>(at, corner, fade3, fade3_slope);
        slopes += noise.slope;
        sum += (1 - octave / 5.0) * noise.value / (1 + slopes.x * slopes.x + slopes.y * slopes.y);
    }
    return sum;
}

// n (34 n + k) mod 289, of any whole number.
int64_t permuted(int64_t n, int64_t k)
{
    n = (n % 289 + 289) % 289;
    return n * (34 * n + k) % 289;
}

// Sum over the simplex lattice of `corner` at all its points that are nearer than sqrt(1/2), which is the height of a
// triangle and less than that of a tetrahedron: no choice of a simplex is needed.
template <int N, typename Corner>
double sum_of_near(const Point<N>& q, Corner corner)
{
    const double unskew = (1 - 1 / std::sqrt(N + 1.0)) / N;
    double along = 0;
    for (int i = 0; i < N; ++i) along += q[i];
    const Point<N> middle = glm::floor(q + along * (std::sqrt(N + 1.0) - 1) / N);
    double sum = 0;
    for (int index = 0; index < std::pow(5, N); ++index) {
        Point<N> c = middle;
        for (int i = 0, rest = index; i < N; ++i, rest /= 5) c[i] += rest % 5 - 2;
        double of_c = 0;
        for (int i = 0; i < N; ++i) of_c += c[i];
        const Point<N> away = q - (c - of_c * unskew);
        const double left = 0.5 - glm::dot(away, away);
        if (left > 0) sum += corner(c, away, left);
    }
    return sum;
}

int64_t of(double x)
{
    return static_cast<int64_t>(x);
}

double simplex_2d(dvec3 q)
{
    return 130 * sum_of_near<2>(dvec2(q), [](dvec2 c, dvec2 away, double left) {
               const auto hash = static_cast<double>(permuted(permuted(of(c.y), 1) + of(c.x), 1) % 41);
               // On the diamond: from (-1, 1/2) by (0, -1/2) to (1, 1/2), whose ends are moved by one to the middle.
               const double x = 2 * hash / 41 - 1;
               const dvec2 gradient(x < -0.5 ? x + 1 : x >= 0.5 ? x - 1 : x, std::fabs(x) - 0.5);
               return std::pow(left, 4) * glm::dot(gradient, away) / glm::length(gradient);
           });
}

double simplex_3d(dvec3 q)
{
    return 72 * sum_of_near<3>(q, [](dvec3 c, dvec3 away, double left) {
               const auto hash =
                   static_cast<double>(permuted(permuted(permuted(of(c.z), 1) + of(c.y), 1) + of(c.x), 1));
               const double z = 1 - (2 * hash + 1) / 289, angle = hash * pi * (3 - std::sqrt(5.0));
               const dvec2 around = std::sqrt(1 - z * z) * dvec2(std::cos(angle), std::sin(angle));
               return std::pow(left, 4) * glm::dot(dvec3(around, z), away);
           });
}

double simplex_flow(dvec3 q)
{
    double sum = 0;
    for (const double f : {1, 4})
        sum += 40 / f * sum_of_near<2>(f * dvec2(q), [f](dvec2 c, dvec2 away, double left) {
                   const auto hash = static_cast<double>(permuted(permuted(of(c.x), 6) + of(c.y), 6));
                   const double angle = hash / 10 + f;
                   return std::pow(left, 3) * (away.x * std::cos(angle) + away.y * std::sin(angle));
               });
    return sum;
}

double hash_lattice(dvec3 q)
{
    const auto knot = [](int x, int y) {
        const auto gray = [](int n) { return static_cast<uint32_t>(n ^ (n >> 1)); };
        const uint32_t h = std::rotl(gray(x) * 0x27d4eb2du, 7) ^ std::rotl(gray(y) * 0x165667b1u, 19);
        const uint32_t nibbles[] = {h >> 4 & 15, h & 15, h >> 12 & 15}; // each pair of the last three changes places
        const double value = (nibbles[0] + 16 * nibbles[1] + 256 * nibbles[2]) / 4095.0;
        const bool flips = (std::popcount(x & 255u) + std::popcount(y & 255u)) % 2 != 0;
        return flips ? -value : value;
    };
    const auto spline = [](double x) { // the quadratic B-spline
        x = std::fabs(x);
        return x < 0.5 ? 0.75 - x * x : x < 1.5 ? (1.5 - x) * (1.5 - x) / 2 : 0;
    };
    double sum = 0;
    const ivec2 low(glm::floor(dvec2(q)));
    for (int j = -2; j <= 3; ++j)
        for (int i = -2; i <= 3; ++i)
            sum += spline(q.x - low.x - i) * spline(q.y - low.y - j) * knot(low.x + i, low.y + j);
    return sum;
}

} // namespace

std::span<const Twin> gradient_twins()
{
    static constexpr const char* shared = "neighbouring cells share their corners";
    static constexpr const char* apart = "corners end within the simplices that share them";
    static constexpr Twin twins[] = {
        {"gradient_2d", gradient_2d, Borders::meet, shared},
        {"gradient_3d", gradient_3d, Borders::meet, shared},
        {"eroded", eroded, Borders::meet, shared},
        {"simplex_2d", simplex_2d, Borders::meet, apart},
        {"simplex_3d", simplex_3d, Borders::meet, apart},
        {"simplex_flow", simplex_flow, Borders::meet, apart},
        {"hash_lattice", hash_lattice, Borders::meet, "knots of a spline end where it does"},
    };
    return twins;
}

} // namespace haptel::ports
