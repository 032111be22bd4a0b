#include "jit/check/check_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptel::jit {

namespace {

// Steele, Lea, Flood: SplitMix64.
uint64_t mixed(uint64_t x)
{
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// Per side of the box. No zeros and no pattern: a transposed or dropped entry shows.
constexpr double uv_slope[2][3] = {{1.3, 0.2, -0.4}, {-0.3, 0.9, 0.6}};
constexpr double n_slope[3][3] = {{0.21, -0.05, 0.11}, {0.07, 0.17, -0.13}, {-0.03, 0.05, 0.02}};
constexpr double n_middle[3] = {0.1, -0.2, 0.95};

} // namespace

CheckPoints::CheckPoints(const CheckBox& within, uint64_t with_seed) : box(within), seed(with_seed), side(0)
{
    for (size_t i = 0; i < 3; ++i) side = std::max(side, box.maximum_m[i] - box.minimum_m[i]);
}

double CheckPoints::uniform(uint64_t index, uint64_t which) const
{
    return static_cast<double>(mixed(mixed(mixed(seed) ^ index) + which) >> 11) * 0x1p-53;
}

haptel_point CheckPoints::at(const double (&p_m)[3]) const
{
    haptel_point point{};
    point.time_s = 1.25;
    point.velocity[0] = 0.03, point.velocity[1] = -0.02; // a hand that explores, with a stylus
    point.normal_force_n = 1.5;
    point.tool_radius_m = 0.5e-3;
    point.tangent[0] = point.bitangent[1] = 1;
    point.curvature_per_m = 5;
    std::copy(p_m, p_m + 3, point.p);
    for (size_t i = 0; i < 3; ++i) {
        point.n[i] = n_middle[i];
        for (size_t j = 0; j < 3; ++j) {
            point.n_dp[i][j] = n_slope[i][j] / side;
            point.n[i] += point.n_dp[i][j] * p_m[j];
        }
    }
    for (size_t i = 0; i < 2; ++i)
        for (size_t j = 0; j < 3; ++j) {
            point.uv_dp[i][j] = uv_slope[i][j] / side;
            point.uv[i] += point.uv_dp[i][j] * p_m[j];
        }
    return point;
}

haptel_point CheckPoints::random(uint64_t index) const
{
    double p_m[3];
    for (size_t i = 0; i < 3; ++i)
        p_m[i] = box.minimum_m[i] + uniform(index, i) * (box.maximum_m[i] - box.minimum_m[i]);
    return at(p_m);
}

std::vector<haptel_point> CheckPoints::edges() const
{
    std::vector<double> values = {0.0, -0.0, 5e-324, -1e-310};
    for (double size : {1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e15, 1e18}) values.insert(values.end(), {size, -size});
    std::vector<haptel_point> points;
    const auto add = [&](double x, double y, double z) {
        points.push_back({.p = {x, y, z},
                          .n = {0, 0, 1},
                          .uv = {x, y},
                          .time_s = 0,
                          .n_dp = {},
                          .uv_dp = {},
                          .velocity = {},
                          .normal_force_n = 0,
                          .tool_radius_m = 0,
                          .tangent = {},
                          .bitangent = {},
                          .curvature_per_m = 0});
    };
    for (double x : values)
        for (double y : values)
            for (double z : values) add(x, y, z);
    for (double x : {box.minimum_m[0], box.maximum_m[0]})
        for (double y : {box.minimum_m[1], box.maximum_m[1]})
            for (double z : {box.minimum_m[2], box.maximum_m[2]}) add(x, y, z);
    return points;
}

CheckPoints::CirclePoint CheckPoints::circle(uint64_t index, double share) const
{
    double radius_m = side, center[3], a[3], b[3];
    for (size_t i = 0; i < 3; ++i) radius_m = std::min(radius_m, (box.maximum_m[i] - box.minimum_m[i]) / 16);
    for (size_t i = 0; i < 3; ++i) {
        center[i] = box.minimum_m[i] + uniform(index, 10 + i) * (box.maximum_m[i] - box.minimum_m[i]);
        a[i] = uniform(index, 20 + i) - 0.5;
        b[i] = uniform(index, 30 + i) - 0.5;
    }
    // b made square to a, both of length 1.
    const auto dot = [](const double* u, const double* v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
    const double along = dot(a, b) / dot(a, a);
    for (size_t i = 0; i < 3; ++i) b[i] -= along * a[i];
    const double angle = 2 * std::numbers::pi * share, a_size = std::sqrt(dot(a, a)), b_size = std::sqrt(dot(b, b));
    CirclePoint result;
    double p_m[3];
    for (size_t i = 0; i < 3; ++i) {
        const double u = radius_m * a[i] / a_size, v = radius_m * b[i] / b_size;
        p_m[i] = center[i] + std::cos(angle) * u + std::sin(angle) * v;
        result.tangent_m[i] = 2 * std::numbers::pi * (std::cos(angle) * v - std::sin(angle) * u);
    }
    result.point = at(p_m);
    return result;
}

} // namespace haptel::jit
