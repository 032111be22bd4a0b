// Points side by side, as a batch entry takes them.
#pragma once

#include "lang/abi/abi.h"
#include "tests/jit/codegen/engines.h"

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
        samples = {outputs[0].data(),
                   {outputs[1].data(), outputs[2].data(), outputs[3].data()},
                   outputs[4].data(),
                   outputs[5].data(),
                   faults.data()};
    }
    haptel_sample sample(size_t i) const
    {
        return {outputs[0][i], {outputs[1][i], outputs[2][i], outputs[3][i]}, outputs[4][i], outputs[5][i], faults[i]};
    }

    size_t count;
    std::vector<std::vector<double>> inputs, outputs = std::vector(6, std::vector<double>(count));
    std::vector<uint32_t> faults = std::vector<uint32_t>(count);
    haptel_points points{};
    haptel_samples samples{};
};

inline bool same(const haptel_sample& a, const haptel_sample& b)
{
    bool equal = a.faults == b.faults && same(a.height_m, b.height_m) && same(a.stiffness_scale, b.stiffness_scale) &&
                 same(a.friction_scale, b.friction_scale);
    for (size_t i = 0; i < 3; ++i) equal = equal && same(a.gradient[i], b.gradient[i]);
    return equal;
}

} // namespace haptel::test
