// Which part of a force goes to which channel of a sound.
//
// A voice coil has one axis, and a hand feels hardly in which direction something vibrates; so one part of the force
// must stand for it. `along` is what a texture changes most on a hand that strokes it, and what shapes are told by.
#pragma once

#include "tools/sound/high_pass.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::tools::sound {

enum class Component : uint8_t {
    along,  // the direction in which the hand moves over the surface; positive pushes it on
    normal, // out of the surface; 0 where nothing is touched
    x,      // axes of the hand's space
    y,
    z,
    none // silence
};
std::string_view name_of(Component component);
inline constexpr std::string_view component_names = "along, normal, x, y, z or none";

// "none,none,along,along": one per channel.
struct Channels {
    std::vector<Component> components;
    std::string error; // what was expected and what was found; empty: none
};
Channels parse_channels(std::string_view text);

// One tick of a stroke, in the hand's space.
struct Stroked {
    glm::dvec3 force_n{0}, velocity_m_per_s{0};
    glm::dvec3 normal{0}; // 0: nothing is touched
};

// From ticks to frames, in newtons, without what is below the cutoff.
class Mixer {
public:
    Mixer(std::vector<Component> components, double high_pass_hz, double rate_hz);

    void frame(const Stroked& stroked, std::span<float> channels_n);

private:
    glm::dvec3 direction(const Stroked& stroked);

    std::vector<Component> components_;
    std::vector<HighPass> high_passes_; // one per channel
    double direction_step_;             // of the low-pass of the motion, per tick
    glm::dvec3 motion_m_per_s_{0};
};

} // namespace haptel::tools::sound
