#include "bench/accuracy_points.h"

#include "lang/abi/outputs.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace haptel::bench {

Points::Points(size_t count, double half_side_m, uint32_t seed)
    : coordinates(3, std::vector<double>(count)), numbers(4, std::vector<double>(count)), faults(count)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-half_side_m, half_side_m);
    for (auto& axis : coordinates)
        for (double& coordinate : axis) coordinate = place(random);
}

haptel_point Points::at(size_t i) const
{
    haptel_point point{};
    for (size_t axis = 0; axis < 3; ++axis) point.p[axis] = coordinates[axis][i];
    return point;
}

void Points::evaluate(haptel_batch_entry* entry, const void* block, size_t first, size_t count)
{
    haptel_points in{};
    haptel_samples out{};
    for (size_t axis = 0; axis < 3; ++axis) {
        in.p[axis] = coordinates[axis].data() + first;
        out.gradient[axis] = numbers[1 + axis].data() + first;
    }
    out.height_m = numbers[0].data() + first;
    out.faults = faults.data() + first;
    entry(&in, count, block, &out);
}

haptel_sample Points::sample(size_t i) const
{
    haptel_sample one = blank_sample;
    one.height_m = numbers[0][i];
    for (size_t axis = 0; axis < 3; ++axis) one.gradient[axis] = numbers[1 + axis][i];
    one.faults = faults[i];
    return one;
}

Truth::Truth(const jit::CompiledTextures& exact, const TextureBinding& binding, const Points& points)
{
    jit::Oracle oracle(exact.program, binding);
    for (size_t i = 0; i < points.size(); ++i) {
        samples.push_back(oracle.sample(points.at(i)));
        const jit::OracleSample& sample = samples.back();
        height = std::max(height, std::fabs(sample.height_m));
        gradient = std::max(gradient, std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]));
    }
}

Accuracy Truth::of(const std::vector<haptel_sample>& found, double wavelengths) const
{
    Accuracy result;
    result.wavelengths = wavelengths;
    for (size_t i = 0; i < samples.size(); ++i) {
        double off[3];
        for (size_t axis = 0; axis < 3; ++axis) off[axis] = found[i].gradient[axis] - samples[i].gradient[axis];
        const double gradient_error = std::hypot(off[0], off[1], off[2]) / gradient;
        const double height_error = std::fabs(found[i].height_m - samples[i].height_m) / height;
        result.height_max = std::max(result.height_max, height_error);
        result.gradient_max = std::max(result.gradient_max, gradient_error);
        result.height_rms += height_error * height_error / static_cast<double>(samples.size());
        result.gradient_rms += gradient_error * gradient_error / static_cast<double>(samples.size());
    }
    result.height_rms = std::sqrt(result.height_rms);
    result.gradient_rms = std::sqrt(result.gradient_rms);
    return result;
}

} // namespace haptel::bench
