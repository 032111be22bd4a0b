#include "jit/texture/call_time.h"

#include "jit/texture/texture.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <vector>

namespace haptel::jit {

namespace {

std::string microseconds(double seconds)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g us", seconds * 1e6);
    return text;
}

} // namespace

double median_call_s(const TextureBinding& binding, const double (&box_minimum_m)[3], const double (&box_maximum_m)[3])
{
    constexpr size_t calls_max = 1000, calls_min = 11;
    constexpr double patience_s = 0.1;
    using Clock = std::chrono::steady_clock;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    haptel_point point{};
    point.n[2] = 1;
    std::vector<double> times_s;
    times_s.reserve(calls_max);
    for (double spent_s = 0; times_s.size() < calls_max && (spent_s < patience_s || times_s.size() < calls_min);) {
        for (size_t i = 0; i < 3; ++i)
            point.p[i] = box_minimum_m[i] + share(random) * (box_maximum_m[i] - box_minimum_m[i]);
        haptel_sample sample;
        const auto start = Clock::now();
        binding.texture->height_gradient(&point, binding.block, &sample);
        times_s.push_back(std::chrono::duration<double>(Clock::now() - start).count());
        spent_s += times_s.back();
    }
    const auto middle = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() / 2);
    std::nth_element(times_s.begin(), middle, times_s.end());
    return *middle;
}

std::string too_slow(const TextureBinding& binding, const TextureRequest& request)
{
    if (request.servo_period_s <= 0) return {};
    const double most_s = share_of_period_max * request.servo_period_s;
    const double call_s = median_call_s(binding, request.box_minimum_m, request.box_maximum_m);
    if (call_s <= most_s) return {};
    return std::string("texture '") + binding.texture->name + "' takes " + microseconds(call_s) +
           " per call (median), more than the " + microseconds(most_s) + " that a servo period of " +
           microseconds(request.servo_period_s) + " leaves for it";
}

std::string too_slow(const CompiledProgram& program, const TextureBinding& binding, const TextureRequest& request)
{
    std::string slow = too_slow(binding, request);
    if (slow.empty() || program.is_optimised()) return slow;
    program.optimise();
    return too_slow(binding, request);
}

} // namespace haptel::jit
