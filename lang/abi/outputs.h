// The outputs that a texture may write besides its height: all that any stage has to know of one, in one table.
//
// Header-only and part of haptel_abi. It says nothing of what the runtime does with an output but its meaning in words.
#pragma once

#include "lang/abi/abi.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

namespace haptel {

struct OutputInfo {
    std::string_view name;
    uint32_t writes;     // its bit, HAPTEL_WRITES_*
    uint32_t components; // 1: a float, 3: a vec3
    double value;        // of each component, where no texture assigns it, or what it assigns is not allowed
    bool is_never_negative;
    std::size_t offset, array_offset; // in haptel_sample; of the array, or the first of them, in haptel_samples
    std::string_view unit; // SI; empty: a plain number, or newtons, which the language does not tell from them
    std::string_view meaning;
};

// By bit.
inline constexpr OutputInfo output_table[] = {
    {"stiffness_scale", HAPTEL_WRITES_STIFFNESS_SCALE, 1, 1, true, offsetof(haptel_sample, stiffness_scale),
     offsetof(haptel_samples, stiffness_scale), "", "times the object's stiffness"},
    {"friction_scale", HAPTEL_WRITES_FRICTION_SCALE, 1, 1, true, offsetof(haptel_sample, friction_scale),
     offsetof(haptel_samples, friction_scale), "", "times both friction coefficients of the object"},
    {"static_friction_scale", HAPTEL_WRITES_STATIC_FRICTION_SCALE, 1, 1, true,
     offsetof(haptel_sample, static_friction_scale), offsetof(haptel_samples, static_friction_scale), "",
     "times the object's static friction, beside friction_scale"},
    {"dynamic_friction_scale", HAPTEL_WRITES_DYNAMIC_FRICTION_SCALE, 1, 1, true,
     offsetof(haptel_sample, dynamic_friction_scale), offsetof(haptel_samples, dynamic_friction_scale), "",
     "times the object's dynamic friction, beside friction_scale"},
    {"damping_scale", HAPTEL_WRITES_DAMPING_SCALE, 1, 1, true, offsetof(haptel_sample, damping_scale),
     offsetof(haptel_samples, damping_scale), "", "times the object's damping"},
    {"friction_direction", HAPTEL_WRITES_FRICTION_DIRECTION, 3, 0, false, offsetof(haptel_sample, friction_direction),
     offsetof(haptel_samples, friction_direction), "", "where friction is friction_along_scale times that across it"},
    {"friction_along_scale", HAPTEL_WRITES_FRICTION_ALONG_SCALE, 1, 1, true,
     offsetof(haptel_sample, friction_along_scale), offsetof(haptel_samples, friction_along_scale), "",
     "friction along friction_direction over that across it"},
    {"vibration_n", HAPTEL_WRITES_VIBRATION, 1, 0, true, offsetof(haptel_sample, vibration_n),
     offsetof(haptel_samples, vibration_n), "", "amplitude of a vibration along the normal, newtons"},
    {"vibration_hz", HAPTEL_WRITES_VIBRATION_HZ, 1, 0, true, offsetof(haptel_sample, vibration_hz),
     offsetof(haptel_samples, vibration_hz), "Hz", "its frequency"},
};

inline constexpr uint32_t all_outputs = (1u << std::size(output_table)) - 1;
// Those that every entry writes, whether its texture does or not.
inline constexpr uint32_t outputs_always_written = HAPTEL_WRITES_STIFFNESS_SCALE | HAPTEL_WRITES_FRICTION_SCALE;
inline constexpr std::size_t output_components_max = [] {
    std::size_t count = 0;
    for (const OutputInfo& output : output_table) count += output.components;
    return count;
}();

// Nothing of that name: null.
constexpr const OutputInfo* find_output(std::string_view name)
{
    const auto* const found = std::ranges::find(output_table, name, &OutputInfo::name);
    return found == std::end(output_table) ? nullptr : found;
}

// Those that `writes` names, in the order of results: visit(output, number of its first component).
template <typename Visit>
constexpr void for_each_output(uint32_t writes, Visit&& visit)
{
    std::size_t component = 0;
    for (const OutputInfo& output : output_table) {
        if (!(output.writes & writes)) continue;
        visit(output, component);
        component += output.components;
    }
}

// How many numbers these outputs are.
constexpr std::size_t output_components(uint32_t writes)
{
    std::size_t count = 0;
    for_each_output(writes, [&](const OutputInfo& output, std::size_t) { count += output.components; });
    return count;
}

// "friction_scale"; of a vec3 that and ".x", ".y" or ".z".
inline std::string component_name(const OutputInfo& output, std::size_t component)
{
    std::string name(output.name);
    return output.components == 1 ? name : name + '.' + "xyz"[component];
}

// The first of its components.
inline double* components_of(haptel_sample& sample, const OutputInfo& output)
{
    return reinterpret_cast<double*>(reinterpret_cast<char*>(&sample) + output.offset);
}
inline const double* components_of(const haptel_sample& sample, const OutputInfo& output)
{
    return reinterpret_cast<const double*>(reinterpret_cast<const char*>(&sample) + output.offset);
}

// What a sample is before a texture writes to it.
inline constexpr haptel_sample blank_sample = {0, {0, 0, 0}, 1, 1, 0, 1, 1, 1, 1, {0, 0, 0}, 0, 0};

} // namespace haptel
