#include "jit/texture/facts.h"

#include "lang/ir/bounds/bounds.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::jit {

namespace {

using ir::infinity;
using ir::Input;
using ir::Interval;

// Evaluations of the interval machine: bounds over a box decide what a hand feels, bounds over ranges are for
// information.
constexpr uint32_t evaluations_over_ranges = 16;
constexpr uint32_t evaluations_over_box = 512;

// Three neighbouring inputs (a vector) from `first` on.
void set(ir::BoundsBox& box, Input first, const double (&minimum)[3], const double (&maximum)[3])
{
    for (size_t i = 0; i < 3; ++i) box.input[static_cast<size_t>(first) + i] = {minimum[i], maximum[i]};
}

// Anything, but what a normal and a time cannot be.
ir::BoundsBox anywhere()
{
    ir::BoundsBox box;
    std::fill(std::begin(box.input), std::end(box.input), Interval{-infinity, infinity});
    set(box, Input::n_x, {-1, -1, -1}, {1, 1, 1});
    set(box, Input::extent_x, {0, 0, 0}, {infinity, infinity, infinity});
    box.input[static_cast<size_t>(Input::time)] = {0, infinity};
    box.input[static_cast<size_t>(Input::footprint)] = {0, std::numeric_limits<double>::max()};
    return box;
}

uint32_t abi_continuity(ir::Continuity continuity)
{
    switch (continuity) {
    case ir::Continuity::unknown: return HAPTEL_CONTINUITY_UNKNOWN;
    case ir::Continuity::jump: return HAPTEL_CONTINUITY_JUMP;
    case ir::Continuity::c0: return HAPTEL_CONTINUITY_C0;
    case ir::Continuity::c1:
    case ir::Continuity::c2:
    case ir::Continuity::smooth: return HAPTEL_CONTINUITY_C1;
    }
    return HAPTEL_CONTINUITY_UNKNOWN;
}

uint32_t operations_max(const ir::Module& module, const ir::Texture& texture)
{
    const uint32_t entry = texture.height_gradient != UINT32_MAX ? texture.height_gradient : texture.height;
    return static_cast<uint32_t>(std::min<uint64_t>(ir::operations_max(module, entry), UINT32_MAX));
}

haptel_facts facts(const ir::Module& module, const ir::Texture& texture, const ir::BoundsBox& box, uint32_t evaluations)
{
    const ir::TextureBounds bounds = ir::texture_bounds(module, texture, box, evaluations);
    const uint32_t continuity = abi_continuity(bounds.continuity);
    return {bounds.height.minimum,
            bounds.height.maximum,
            bounds.slope_max,
            continuity == HAPTEL_CONTINUITY_C1 ? bounds.curvature_max_per_m : infinity,
            continuity,
            operations_max(module, texture)};
}

} // namespace

haptel_facts no_facts(const ir::Module& module, const ir::Texture& texture)
{
    return {-infinity, infinity, infinity, infinity, HAPTEL_CONTINUITY_UNKNOWN, operations_max(module, texture)};
}

haptel_facts facts_over_ranges(const ir::Module& module, const ir::Texture& texture)
{
    ir::BoundsBox box = anywhere();
    for (const ir::Parameter& parameter : texture.parameters)
        box.parameters.push_back(parameter.type == ir::Type::boolean ? Interval{0, 1}
                                                                     : Interval{parameter.minimum, parameter.maximum});
    return facts(module, texture, box, evaluations_over_ranges);
}

haptel_facts facts_over_box(const ir::Module& module, const ir::Texture& texture, std::span<const double> values,
                            std::span<const ir::SplineImage* const> images, const haptel_block_head& head,
                            const TextureRequest& request)
{
    ir::BoundsBox box = anywhere();
    for (size_t i = 0; i < 3; ++i) {
        // A contact lies on the surface but for rounding: a billionth of the box more on each side.
        const double half = head.extent[i] / 2;
        const double margin = 1e-9 * (half + std::fabs(head.center[i]));
        box.input[i] = {head.center[i] - half - margin, head.center[i] + half + margin};
    }
    set(box, Input::center_x, head.center, head.center);
    set(box, Input::extent_x, head.extent, head.extent);
    box.input[static_cast<size_t>(Input::footprint)] = {head.footprint_m, head.footprint_m};
    const double turn = request.normal_turn_max_per_m;
    std::fill_n(box.input + static_cast<size_t>(Input::n_dp_00), 9, Interval{-turn, turn});
    box.normal_turn_max_per_m = turn;
    for (size_t i = 0; i < 2; ++i) {
        box.input[static_cast<size_t>(Input::uv_x) + i] = {request.uv.minimum[i], request.uv.maximum[i]};
        set(box, static_cast<Input>(static_cast<size_t>(Input::uv_dp_00) + 3 * i), request.uv.dp_minimum[i],
            request.uv.dp_maximum[i]);
        box.uv_slope_max_per_m[i] = request.uv.slope_max_per_m[i];
    }
    for (double value : values) box.parameters.push_back({value, value});
    box.images.assign(images.begin(), images.end());
    return facts(module, texture, box, evaluations_over_box);
}

} // namespace haptel::jit
