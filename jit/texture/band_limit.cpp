#include "jit/texture/band_limit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace haptel::jit {

namespace {

// Somewhere between two figures; between others where they are not known.
double between(double minimum, double maximum, double share, double otherwise)
{
    if (!std::isfinite(minimum) || !std::isfinite(maximum)) return share * otherwise;
    return minimum + share * (maximum - minimum);
}

} // namespace

bool is_band_limited(const TextureBinding& binding, const TextureRequest& request)
{
    // Textures that are too slow for a servo shall not be slow to refuse.
    const uint64_t operations = std::max<uint64_t>(binding.facts.operations_max, 1);
    const uint64_t places = std::clamp<uint64_t>(20'000'000 / operations, 1, 32);
    if (!(binding.texture->reads & HAPTEL_READS_FOOTPRINT) || request.footprint_m == 0 ||
        !binding.texture->height_gradient)
        return false;
    std::vector<uint64_t> block((binding.texture->block_size + 7) / 8);
    std::memcpy(block.data(), binding.block, binding.texture->block_size);
    haptel_block_head head;
    std::memcpy(&head, block.data(), sizeof head);
    head.footprint_m = 0;
    std::memcpy(block.data(), &head, sizeof head);

    std::mt19937_64 random(1);
    const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (uint64_t i = 0; i < places; ++i) {
        haptel_point point{};
        double length = 0;
        for (size_t k = 0; k < 3; ++k) {
            point.p[k] = between(request.box_minimum_m[k], request.box_maximum_m[k], share(), 1);
            point.n[k] = share() - 0.5;
            length += point.n[k] * point.n[k];
        }
        for (double& n : point.n) n /= std::sqrt(length);
        for (size_t k = 0; k < 2; ++k) {
            point.uv[k] = between(request.uv.minimum[k], request.uv.maximum[k], share(), 1);
            for (size_t j = 0; j < 3; ++j)
                point.uv_dp[k][j] = between(request.uv.dp_minimum[k][j], request.uv.dp_maximum[k][j], share(), 100);
        }
        haptel_sample with = {}, without = {};
        binding.texture->height_gradient(&point, binding.block, &with);
        binding.texture->height_gradient(&point, block.data(), &without);
        if (with.height_m != without.height_m) return true;
    }
    return false;
}

} // namespace haptel::jit
