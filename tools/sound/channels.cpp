#include "tools/sound/channels.h"

#include "device/sound_file.h"
#include "lang/text/near_name.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <numbers>
#include <utility>

namespace haptel::tools::sound {

namespace {

constexpr std::array<std::string_view, 6> names = {"along", "normal", "x", "y", "z", "none"};

// A hand means to move no faster than this; what the texture shakes it with is no direction.
constexpr double motion_bandwidth_hz = 20;
// A hand that hardly moves has no direction: where it turns back, `along` goes through 0 instead of changing its sign.
constexpr double slow_m_per_s = 1e-3;

} // namespace

std::string_view name_of(Component component)
{
    return names[static_cast<std::size_t>(component)];
}

Channels parse_channels(std::string_view text)
{
    Channels channels;
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view word = text.substr(0, comma);
        std::size_t found = 0;
        while (found < names.size() && names[found] != word) ++found;
        if (found == names.size()) {
            const std::string_view meant =
                near_name(word, std::vector<std::string_view>(names.begin(), names.end())).name;
            channels.error = fmt::format("'{}' is no part of a force: {}", word.substr(0, 64),
                                         meant.empty() ? fmt::format("expected {}", component_names)
                                                       : fmt::format("did you mean '{}'?", meant));
            return channels;
        }
        channels.components.push_back(static_cast<Component>(found));
        if (channels.components.size() > device::sound_channels_max) {
            channels.error = fmt::format("a sound has 1 to {} channels here, found more", device::sound_channels_max);
            return channels;
        }
        if (comma == text.npos) break;
        text.remove_prefix(comma + 1);
    }
    for (const Component component : channels.components)
        if (component != Component::none) return channels;
    channels.error = fmt::format("all channels are silent: one of them needs {}", "along, normal, x, y or z");
    return channels;
}

Mixer::Mixer(std::vector<Component> components, double high_pass_hz, double rate_hz)
    : components_(std::move(components))
    , high_passes_(components_.size(), HighPass(high_pass_hz, rate_hz))
    , direction_step_(1 - std::exp(-2 * std::numbers::pi * motion_bandwidth_hz / rate_hz))
{
}

// Of the motion over the surface, or through the air; shorter than 1 where the hand is slow.
glm::dvec3 Mixer::direction(const Stroked& stroked)
{
    motion_m_per_s_ += direction_step_ * (stroked.velocity_m_per_s - motion_m_per_s_);
    const glm::dvec3 over = motion_m_per_s_ - glm::dot(motion_m_per_s_, stroked.normal) * stroked.normal;
    return over / std::sqrt(glm::dot(over, over) + slow_m_per_s * slow_m_per_s);
}

void Mixer::frame(const Stroked& stroked, std::span<float> channels_n)
{
    const glm::dvec3 along = direction(stroked);
    for (std::size_t i = 0; i < components_.size(); ++i) {
        double force_n = 0;
        switch (components_[i]) {
        case Component::along: force_n = glm::dot(stroked.force_n, along); break;
        case Component::normal: force_n = glm::dot(stroked.force_n, stroked.normal); break;
        case Component::x: force_n = stroked.force_n.x; break;
        case Component::y: force_n = stroked.force_n.y; break;
        case Component::z: force_n = stroked.force_n.z; break;
        case Component::none: break;
        }
        channels_n[i] = static_cast<float>(high_passes_[i](force_n));
    }
}

} // namespace haptel::tools::sound
