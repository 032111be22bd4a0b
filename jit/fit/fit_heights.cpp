#include "jit/fit/fit.h"
#include "jit/fit/height_misfit.h"
#include "jit/fit/texture_to_fit.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace haptel::jit {

namespace {

// Of a map, as many as each level looks at: enough for any texture's parameters, drawn at random, so that no grid of
// theirs hides a texture's own.
constexpr std::size_t points_at_first = 256, points_max = 4096;
// Circles round the origin of an eighth, a quarter, a half and all of the map's half diagonal.
constexpr int levels_max = 4;
constexpr std::size_t points_min = 16; // fewer tell nothing
constexpr FitEffort of_heights{96, 200, 16};

// Up to `most` of the map's pixels within so far of the origin, drawn at random.
std::unique_ptr<Misfit> part_of(const HeightMap& map, const ParameterGradient& texture, double within_m,
                                std::size_t most, std::mt19937_64& random)
{
    std::vector<haptel_point> points;
    std::vector<double> heights_m;
    for (std::size_t row = 0; row < map.rows; ++row)
        for (std::size_t column = 0; column < map.columns; ++column) {
            const haptel_point point = map.point(column, row);
            if (std::hypot(point.p[0], point.p[1]) > within_m) continue;
            points.push_back(point);
            heights_m.push_back(map.heights_m[row * map.columns + column]);
        }
    const std::size_t count = std::min(most, points.size());
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t other = i + random() % (points.size() - i);
        std::swap(points[i], points[other]);
        std::swap(heights_m[i], heights_m[other]);
    }
    if (count < points_min) return nullptr;
    return std::make_unique<HeightMisfit>(texture, std::span(points).first(count), std::span(heights_m).first(count));
}

} // namespace

haptel_point HeightMap::point(std::size_t column, std::size_t row) const
{
    const auto along = [&](std::size_t at, std::size_t count) {
        return (static_cast<double>(at) + 0.5 - static_cast<double>(count) / 2) * pixel_m;
    };
    haptel_point point{};
    point.p[0] = along(column, columns);
    point.p[1] = along(row, rows);
    point.n[2] = 1;
    const double width_m = static_cast<double>(columns) * pixel_m, height_m = static_cast<double>(rows) * pixel_m;
    point.uv[0] = point.p[0] / width_m + 0.5;
    point.uv[1] = point.p[1] / height_m + 0.5;
    point.uv_dp[0][0] = 1 / width_m;
    point.uv_dp[1][1] = 1 / height_m;
    point.tangent[0] = point.bitangent[1] = 1;
    return point;
}

FitResult fit_heights(const std::shared_ptr<const CompiledProgram>& program, const FitRequest& request,
                      const HeightMap& map)
{
    const double width_m = static_cast<double>(map.columns) * map.pixel_m,
                 height_m = static_cast<double>(map.rows) * map.pixel_m, reach_m = std::hypot(width_m, height_m) / 2;
    TextureToFit fit(program, request, width_m, height_m);
    FitResult refused;
    refused.failure = fit.failure();
    if (!refused.failure.empty()) return refused;

    std::mt19937_64 random(request.seed);
    std::vector<std::unique_ptr<Misfit>> levels;
    for (int level = levels_max; level-- > 0;) {
        const std::size_t most = levels.empty() ? points_at_first : points_max;
        if (auto part = part_of(map, fit.texture(), std::ldexp(reach_m, -level), most, random))
            levels.push_back(std::move(part));
    }
    if (levels.empty())
        refused.failure = "expected a height map of at least 4 by 4 pixels";
    else if (std::ranges::min(map.heights_m) == std::ranges::max(map.heights_m))
        refused.failure = "the height map is flat: there is nothing to fit";
    if (!refused.failure.empty()) return refused;
    const std::unique_ptr<Misfit> overview = part_of(map, fit.texture(), reach_m, points_at_first, random);
    return fit.result(search(fit.unknowns(), levels, *overview, of_heights, request.seed), *levels.back());
}

} // namespace haptel::jit
