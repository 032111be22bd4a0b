// Many samples of one texture at once, from and to the structs of one point.
//
// Header-only and part of haptel_abi. Who has arrays of numbers already calls height_gradient_batch itself and is
// spared the sorting.
#pragma once

#include "lang/abi/texture_binding.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace haptel {

// samples[i] becomes what height_gradient says of points[i], bit for bit; as many samples as points. Several threads
// may evaluate one binding. A texture without batches is asked point by point.
inline void evaluate(const TextureBinding& binding, std::span<const haptel_point> points,
                     std::span<haptel_sample> samples)
{
    const haptel_texture& texture = *binding.texture;
    if (texture.size < sizeof(haptel_texture) || !texture.height_gradient_batch) {
        for (std::size_t i = 0; i < points.size(); ++i) texture.height_gradient(&points[i], binding.block, &samples[i]);
        return;
    }
    constexpr std::size_t group = 256, reals = sizeof(haptel_point) / sizeof(double); // fits the nearest cache
    static_assert(sizeof(haptel_points) == reals * sizeof(double*));
    double inputs[reals][group], outputs[6][group];
    uint32_t faults[group];
    const double* arrays[reals];
    for (std::size_t i = 0; i < reals; ++i) arrays[i] = inputs[i];
    haptel_points from;
    std::memcpy(&from, arrays, sizeof from);
    const haptel_samples to{outputs[0], {outputs[1], outputs[2], outputs[3]}, outputs[4], outputs[5], faults};

    const bool is_read[] = {(texture.reads & HAPTEL_READS_POINT) != 0, (texture.reads & HAPTEL_READS_NORMAL) != 0,
                            (texture.reads & HAPTEL_READS_UV) != 0, (texture.reads & HAPTEL_READS_TIME) != 0};
    const auto kind_of = [](std::size_t real) { // of the doubles of haptel_point: p, n, uv, time, n_dp, uv_dp
        return real < 3 ? 0 : real < 6 ? 1 : real < 8 ? 2 : real < 9 ? 3 : real < 18 ? 1 : 2;
    };
    for (std::size_t first = 0; first < points.size(); first += group) {
        const std::size_t count = std::min(group, points.size() - first);
        for (std::size_t real = 0; real < reals; ++real) {
            if (!is_read[kind_of(real)]) continue;
            const char* place = reinterpret_cast<const char*>(&points[first]) + real * sizeof(double);
            for (std::size_t i = 0; i < count; ++i, place += sizeof(haptel_point))
                std::memcpy(&inputs[real][i], place, sizeof(double));
        }
        texture.height_gradient_batch(&from, count, binding.block, &to);
        for (std::size_t i = 0; i < count; ++i)
            samples[first + i] = {
                outputs[0][i], {outputs[1][i], outputs[2][i], outputs[3][i]}, outputs[4][i], outputs[5][i], faults[i]};
    }
}

} // namespace haptel
