#include "jit/check/check_code.h"

#include "jit/check/short_paths.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace haptel::jit {

namespace {

haptel_sample sample_at(const TextureBinding& binding, const haptel_point& point)
{
    haptel_sample sample{};
    binding.texture->height_gradient(&point, binding.block, &sample);
    return sample;
}

bool is_sound(const haptel_sample& sample)
{
    return sample.faults == 0 && std::isfinite(sample.height_m) && std::isfinite(sample.gradient[0]) &&
           std::isfinite(sample.gradient[1]) && std::isfinite(sample.gradient[2]);
}

// By the trapezoid rule, which for a closed curve converges as fast as the integrand is smooth.
double loop_integral_m(const TextureBinding& binding, const CheckPoints& points, uint64_t index)
{
    constexpr int steps = 8192;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const CheckPoints::CirclePoint at = points.circle(index, i / static_cast<double>(steps));
        const haptel_sample sample = sample_at(binding, at.point);
        for (size_t axis = 0; axis < 3; ++axis) sum += sample.gradient[axis] * at.tangent_m[axis];
    }
    return sum / steps;
}

constexpr int paths = 400;

const char* name_of(uint32_t continuity)
{
    return continuity == HAPTEL_CONTINUITY_JUMP ? "jump" : continuity == HAPTEL_CONTINUITY_C0 ? "C0" : "C1";
}

} // namespace

void expect_at_most(GradientCheck& check, std::string_view what, double found, double allowed,
                    const std::function<std::string()>& where)
{
    if (found <= allowed) return;
    const bool is_count = found == std::floor(found);
    char numbers[96];
    std::snprintf(numbers, sizeof numbers,
                  is_count ? ": %.6g, at most %.3g is allowed" : ": %.3g, at most %.3g is allowed", found, allowed);
    check.failures.push_back(std::string(what) + numbers + (where ? "; " + where() : ""));
}

std::string shortest(double value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string listed(const double (&numbers)[3])
{
    return shortest(numbers[0]) + "," + shortest(numbers[1]) + "," + shortest(numbers[2]);
}

double greater(double a, double b)
{
    return std::isnan(a) || std::isnan(b) ? HUGE_VAL : std::max(a, b);
}

double relative(double error, double largest)
{
    return largest > 0 ? error / largest : error;
}

void check_code(GradientCheck& check, const TextureBinding& binding, const CheckPoints& points)
{
    std::optional<std::pair<haptel_point, haptel_sample>> unsound; // the first
    const auto look_at = [&](const haptel_point& point) {
        const haptel_sample sample = sample_at(binding, point);
        if (is_sound(sample)) return sample;
        ++check.not_finite;
        if (!unsound) unsound.emplace(point, sample);
        return sample;
    };
    double farthest_m = 0, beyond_p_m[3] = {}, beyond_m = 0;
    const double least_m = binding.facts.height_min_m, most_m = binding.facts.height_max_m;
    for (uint32_t i = 0; i < check.points; ++i) {
        const haptel_point point = points.random(i);
        const double height_m = look_at(point).height_m;
        if (height_m >= least_m && height_m <= most_m) continue;
        ++check.bounds_exceeded;
        const double off_m = std::fmax(least_m - height_m, height_m - most_m);
        if (off_m < farthest_m) continue;
        farthest_m = off_m, beyond_m = height_m;
        std::copy(point.p, point.p + 3, beyond_p_m);
    }
    for (const haptel_point& point : points.edges()) look_at(point);
    for (uint64_t circle = 0; circle < 4; ++circle)
        check.loop_integral_m = std::max(check.loop_integral_m, std::fabs(loop_integral_m(binding, points, circle)));
    expect_at_most(check, "points where height or gradient is not finite (edges and huge coordinates included)",
                   static_cast<double>(check.not_finite), 0, [&] {
                       const bool of_height = unsound->second.faults & HAPTEL_FAULT_HEIGHT_NOT_FINITE;
                       return "the first at --at " + listed(unsound->first.p) + ", of the " +
                              (of_height ? "height" : "gradient");
                   });
    expect_at_most(check, "points where the height leaves its bounds", static_cast<double>(check.bounds_exceeded), 0,
                   [&] {
                       return "worst at --at " + listed(beyond_p_m) + ": found " + shortest(beyond_m) + ", expected " +
                              shortest(least_m) + " .. " + shortest(most_m);
                   });

    ShortPaths all(binding, points);
    for (uint64_t i = 0; i < paths; ++i) all.follow(i, 1.0 / 32);
    check.continuity_measured = all.roughest;
    check.bounds_exceeded += all.too_steep + all.too_curved;
    const auto worst = [](const ShortPaths::Worst& most, double allowed) {
        return "worst at --at " + listed(most.p_m) + ": found " + shortest(most.size) + ", expected at most " +
               shortest(allowed);
    };
    expect_at_most(check, "places along paths where the slope leaves its bound", static_cast<double>(all.too_steep), 0,
                   [&] { return worst(all.steepest, binding.facts.slope_max); });
    expect_at_most(check, "paths along which the gradient changes faster than its bound",
                   static_cast<double>(all.too_curved), 0,
                   [&] { return worst(all.most_curved, binding.facts.curvature_max_per_m); });
    if (all.roughest < binding.facts.continuity)
        check.failures.push_back(std::string("the class is said to be ") + name_of(binding.facts.continuity) +
                                 ", measured is " + name_of(all.roughest) + "; found at --at " +
                                 listed(all.roughest_p_m));
}

} // namespace haptel::jit
