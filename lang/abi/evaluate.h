// Many samples of one texture at once, from and to the structs of one point.
//
// Header-only and part of haptel_abi. Who has arrays of numbers already calls height_gradient_batch itself and is
// spared the sorting.
#pragma once

#include "lang/abi/outputs.h"
#include "lang/abi/texture_binding.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

namespace haptel {

// At most `most` points and their samples, as the arrays of a batch entry.
template <std::size_t most>
class SampleArrays {
public:
    // Only the numbers that `reads` (HAPTEL_READS_*) names.
    void set(std::span<const haptel_point> points, uint32_t reads)
    {
        const auto kind_of = [](std::size_t real) { // of the doubles of haptel_point, as the bits of `reads` count them
            constexpr struct {
                std::size_t end;
                int bit;
            } kinds[] = {{3, 0},  {6, 1},  {8, 2},  {9, 3},   {18, 1}, {24, 2},
                         {27, 7}, {28, 8}, {29, 9}, {35, 10}, {36, 11}};
            return std::ranges::upper_bound(kinds, real, {}, [](const auto& kind) { return kind.end; })->bit;
        };
        static_assert(HAPTEL_READS_NORMAL == 1 << 1 && HAPTEL_READS_UV == 1 << 2 && HAPTEL_READS_TIME == 1 << 3 &&
                      HAPTEL_READS_VELOCITY == 1 << 7 && HAPTEL_READS_NORMAL_FORCE == 1 << 8 &&
                      HAPTEL_READS_TOOL_RADIUS == 1 << 9 && HAPTEL_READS_TANGENT == 1 << 10 &&
                      HAPTEL_READS_CURVATURE == 1 << 11 && reals == 36);
        for (std::size_t real = 0; real < reals; ++real) {
            if (!(reads >> kind_of(real) & 1)) continue;
            const char* place = reinterpret_cast<const char*>(points.data()) + real * sizeof(double);
            for (std::size_t i = 0; i < points.size(); ++i, place += sizeof(haptel_point))
                std::memcpy(&inputs[real][i], place, sizeof(double));
        }
    }
    // `writes`: HAPTEL_WRITES_* of the texture.
    void run(haptel_batch_entry* entry, std::size_t count, const void* block, uint32_t writes)
    {
        written = writes | outputs_always_written;
        const double* arrays[reals];
        for (std::size_t i = 0; i < reals; ++i) arrays[i] = inputs[i];
        haptel_points from;
        static_assert(sizeof from == sizeof arrays);
        std::memcpy(&from, arrays, sizeof from);
        haptel_samples to{};
        to.height_m = outputs[0];
        for (std::size_t i = 0; i < 3; ++i) to.gradient[i] = outputs[1 + i];
        to.faults = faults;
        for_each_output(written, [&](const OutputInfo& output, std::size_t first) {
            char* const place = reinterpret_cast<char*>(&to) + output.array_offset;
            for (std::size_t i = 0; i < output.components; ++i) {
                double* const array = outputs[4 + first + i];
                std::memcpy(place + i * sizeof array, &array, sizeof array);
            }
        });
        entry(&from, count, block, &to);
    }
    haptel_sample sample(std::size_t i) const
    {
        haptel_sample one = blank_sample;
        one.height_m = outputs[0][i];
        for (std::size_t axis = 0; axis < 3; ++axis) one.gradient[axis] = outputs[1 + axis][i];
        one.faults = faults[i];
        for_each_output(written, [&](const OutputInfo& output, std::size_t first) {
            for (std::size_t k = 0; k < output.components; ++k)
                components_of(one, output)[k] = outputs[4 + first + k][i];
        });
        return one;
    }

private:
    static constexpr std::size_t reals = sizeof(haptel_point) / sizeof(double);
    double inputs[reals][most], outputs[4 + output_components_max][most];
    uint32_t faults[most], written = 0;
};

// samples[i] becomes what height_gradient says of points[i], bit for bit; as many samples as points. Several threads
// may evaluate one binding. A texture without batches is asked point by point.
inline void evaluate(const TextureBinding& binding, std::span<const haptel_point> points,
                     std::span<haptel_sample> samples)
{
    const haptel_texture& texture = *binding.texture;
    if (texture.size < offsetof(haptel_texture, choices) || !texture.height_gradient_batch) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            samples[i] = blank_sample;
            texture.height_gradient(&points[i], binding.block, &samples[i]);
        }
        return;
    }
    constexpr std::size_t group = 256; // fits the nearest cache
    SampleArrays<group> arrays;
    for (std::size_t first = 0; first < points.size(); first += group) {
        const std::span<const haptel_point> some = points.subspan(first, std::min(group, points.size() - first));
        arrays.set(some, texture.reads);
        arrays.run(texture.height_gradient_batch, some.size(), binding.block, texture.writes);
        for (std::size_t i = 0; i < some.size(); ++i) samples[first + i] = arrays.sample(i);
    }
}

} // namespace haptel
