#include "jit/texture/facts.h"

#include "jit/texture/object_points.h"
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
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
// Of intervals, where a hand waits to feel an edit: 15 ms for the proof, and 8 to find where its ends may be. What is
// felt of 118 public shaders is, but for 6, what a proof of 20 times that gives.
constexpr uint64_t operations_for_hand = 150'000;
// Where a hand turns a knob: a fiftieth of a tick at 1 kHz, or one evaluation, which takes up to a tick and a half.
// With ten times as many 29 of 178 textures take more than 0.3 ms, with these 13; of one of them they say less.
constexpr uint64_t operations_at_once = 100;

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
    ir::set_contact(box);
    return box;
}

uint32_t operations_max(const ir::Module& module, const ir::Texture& texture)
{
    const uint32_t entry = texture.height_gradient != UINT32_MAX ? texture.height_gradient : texture.height;
    return static_cast<uint32_t>(std::min<uint64_t>(ir::operations_max(module, entry), UINT32_MAX));
}

haptel_facts all_facts(const ir::Module& module, const ir::Texture& texture, const ir::BoundsBox& box,
                       uint32_t evaluations)
{
    const ir::TextureBounds bounds = ir::texture_bounds(module, texture, box, evaluations);
    constexpr auto number = [](ir::Continuity of) { return static_cast<uint32_t>(of); };
    static_assert(number(ir::Continuity::jump) == HAPTEL_CONTINUITY_JUMP &&
                  number(ir::Continuity::c0) == HAPTEL_CONTINUITY_C0 &&
                  number(ir::Continuity::c1) == HAPTEL_CONTINUITY_C1);
    const uint32_t continuity = std::min<uint32_t>(number(bounds.continuity), HAPTEL_CONTINUITY_C1);
    return {bounds.height.minimum,
            bounds.height.maximum,
            bounds.slope_max,
            continuity == HAPTEL_CONTINUITY_C1 ? bounds.curvature_max_per_m : infinity,
            continuity,
            operations_max(module, texture)};
}

haptel_point point_of(const double (&inputs)[ir::input_count])
{
    const auto at = [&](Input first, size_t i) { return inputs[static_cast<size_t>(first) + i]; };
    haptel_point point{};
    for (size_t i = 0; i < 3; ++i) point.p[i] = at(Input::p_x, i), point.n[i] = at(Input::n_x, i);
    for (size_t i = 0; i < 2; ++i) point.uv[i] = at(Input::uv_x, i);
    point.time_s = at(Input::time, 0);
    return point;
}

haptel_facts heights_alone(const ir::Module& module, const ir::Texture& texture, const Interval& height)
{
    return {
        height.minimum, height.maximum, infinity, infinity, HAPTEL_CONTINUITY_UNKNOWN, operations_max(module, texture)};
}

} // namespace

haptel_facts facts_over_ranges(const ir::Module& module, const ir::Texture& texture, bool are_wanted)
{
    if (!are_wanted) return heights_alone(module, texture, {-infinity, infinity});
    ir::BoundsBox box = anywhere();
    for (const ir::Parameter& parameter : texture.parameters)
        box.parameters.push_back(parameter.type == ir::Type::boolean ? Interval{0, 1}
                                                                     : Interval{parameter.minimum, parameter.maximum});
    return all_facts(module, texture, box, evaluations_over_ranges);
}

haptel_facts facts_over_box(const ir::Module& module, const ir::Texture& texture, std::span<const double> values,
                            std::span<const ir::SplineImage* const> images, const haptel_block_head& head,
                            const TextureRequest& request, Bounded what, FindPlaces* places)
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
    if (what != Bounded::all) {
        std::function<ir::HeightPlaces()> found;
        const Interval height =
            ir::height_bounds(module, texture, box, evaluations_over_box,
                              what == Bounded::heights ? operations_for_hand : operations_at_once, &found);
        if (places)
            *places = [found = std::move(found)] {
                const ir::HeightPlaces at = found();
                return LikelyPlaces{point_of(at.lowest), point_of(at.highest)};
            };
        return heights_alone(module, texture, height);
    }
    return all_facts(module, texture, box, evaluations_over_box);
}

namespace {

// Share of a servo's period that one texture's call may take; the rest is contact, force, device, and reserve.
constexpr double share_of_period_max = 0.2;

std::string microseconds(double seconds)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g us", seconds * 1e6);
    return text;
}

} // namespace

bool is_band_limited(const TextureBinding& binding, const TextureRequest& request)
{
    if (!(binding.texture->reads & HAPTEL_READS_FOOTPRINT) || request.footprint_m == 0 ||
        !binding.texture->height_gradient)
        return false;
    std::vector<uint64_t> block((binding.texture->block_size + 7) / 8);
    std::memcpy(block.data(), binding.block, binding.texture->block_size);
    constexpr double none_m = 0;
    std::memcpy(reinterpret_cast<char*>(block.data()) + offsetof(haptel_block_head, footprint_m), &none_m,
                sizeof none_m);
    // Textures that are too slow for a servo shall not be slow to refuse.
    const uint64_t operations = std::max<uint64_t>(binding.facts.operations_max, 1);
    const uint64_t places = std::clamp<uint64_t>(20'000'000 / operations, 1, 32);
    ObjectPoints points(request);
    for (uint64_t i = 0; i < places; ++i) {
        const haptel_point point = points.next();
        haptel_sample with = {}, without = {};
        binding.texture->height_gradient(&point, binding.block, &with);
        binding.texture->height_gradient(&point, block.data(), &without);
        if (with.height_m != without.height_m) return true;
    }
    return false;
}

double median_call_s(const TextureBinding& binding, const TextureRequest& request, double patience_s)
{
    // Of short calls ten at a time, or the clock is what is measured.
    constexpr size_t calls_max = 10, rounds_max = 1000, rounds_min = 11;
    constexpr double is_long_s = 30e-6;
    using Clock = std::chrono::steady_clock;
    ObjectPoints places(request);
    size_t calls = 1; // the first alone tells
    std::vector<double> times_s;
    times_s.reserve(rounds_max);
    for (double spent_s = 0; times_s.size() < rounds_max && (spent_s < patience_s || times_s.size() < rounds_min);) {
        haptel_point points[calls_max];
        for (size_t i = 0; i < calls; ++i) points[i] = places.next();
        haptel_sample sample;
        const auto start = Clock::now();
        for (size_t i = 0; i < calls; ++i) binding.texture->height_gradient(&points[i], binding.block, &sample);
        const double taken_s = std::chrono::duration<double>(Clock::now() - start).count();
        times_s.push_back(taken_s / static_cast<double>(calls));
        spent_s += taken_s;
        if (taken_s < is_long_s) calls = calls_max;
    }
    const auto middle = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() / 2);
    std::nth_element(times_s.begin(), middle, times_s.end());
    return *middle;
}

std::string too_slow(const CompiledProgram& program, const TextureBinding& binding, const TextureRequest& request)
{
    if (request.servo_period_s <= 0 || !binding.texture->height_gradient) return {};
    const double most_s = share_of_period_max * request.servo_period_s;
    // A few calls tell where there is a wide margin.
    if (median_call_s(binding, request, 0) < most_s / 4) return {};
    double call_s = median_call_s(binding, request);
    if (call_s > most_s && !program.is_optimised()) {
        program.optimise();
        call_s = median_call_s(binding, request);
    }
    if (call_s <= most_s) return {};
    return std::string("texture '") + binding.texture->name + "' takes " + microseconds(call_s) +
           " per call (median), more than the " + microseconds(most_s) + " that a servo period of " +
           microseconds(request.servo_period_s) + " leaves for it";
}

} // namespace haptel::jit
