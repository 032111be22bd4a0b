// Points side by side, as a batch entry takes them.
#pragma once

#include "lang/abi/outputs.h"
#include "tests/jit/codegen/engines.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace haptel::test {

// Numbers of a batch, an array each, as haptel_points and haptel_samples want them.
struct Batch {
    static constexpr size_t reals = sizeof(haptel_point) / sizeof(double);

    explicit Batch(const std::vector<haptel_point>& of) : count(of.size()), inputs(reals, std::vector<double>(count))
    {
        for (size_t i = 0; i < count; ++i)
            for (size_t j = 0; j < inputs.size(); ++j)
                std::memcpy(&inputs[j][i], reinterpret_cast<const char*>(&of[i]) + j * sizeof(double), sizeof(double));
        const double* arrays[reals];
        for (size_t j = 0; j < inputs.size(); ++j) arrays[j] = inputs[j].data();
        static_assert(sizeof points == sizeof arrays);
        std::memcpy(&points, arrays, sizeof points);
        samples.height_m = outputs[0].data();
        for (size_t i = 0; i < 3; ++i) samples.gradient[i] = outputs[1 + i].data();
        samples.faults = faults.data();
        for_each_output(all_outputs, [&](const OutputInfo& output, size_t first) {
            for (size_t i = 0; i < output.components; ++i) {
                std::vector<double>& array = outputs[4 + first + i];
                std::fill(array.begin(), array.end(), output.value);
                double* const start = array.data();
                std::memcpy(reinterpret_cast<char*>(&samples) + output.array_offset + i * sizeof start, &start,
                            sizeof start);
            }
        });
    }
    haptel_sample sample(size_t i) const
    {
        haptel_sample one = blank_sample;
        one.height_m = outputs[0][i];
        for (size_t axis = 0; axis < 3; ++axis) one.gradient[axis] = outputs[1 + axis][i];
        one.faults = faults[i];
        for_each_output(all_outputs, [&](const OutputInfo& output, size_t first) {
            for (size_t k = 0; k < output.components; ++k) components_of(one, output)[k] = outputs[4 + first + k][i];
        });
        return one;
    }

    size_t count;
    std::vector<std::vector<double>> inputs,
        outputs = std::vector(4 + output_components_max, std::vector<double>(count));
    std::vector<uint32_t> faults = std::vector<uint32_t>(count);
    haptel_points points{};
    haptel_samples samples{};
};

inline bool same(const haptel_sample& a, const haptel_sample& b)
{
    bool equal = a.faults == b.faults && same(a.height_m, b.height_m);
    for (const OutputInfo& output : output_table)
        for (size_t i = 0; i < output.components; ++i)
            equal = equal && same(components_of(a, output)[i], components_of(b, output)[i]);
    for (size_t i = 0; i < 3; ++i) equal = equal && same(a.gradient[i], b.gradient[i]);
    return equal;
}

} // namespace haptel::test
