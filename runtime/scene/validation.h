// Which scenes may be rendered. A scene that a program builds is held to the same rules as one that is read from a
// file: ranges in scene_fields.h, and what connects several figures here. The reader of files asks for each rule where
// it reads, and adds the place in the file; a renderer asks for all of them, and renders nothing that breaks one.
#pragma once

#include "runtime/scene/scene_fields.h"

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace haptel::runtime {

// The key of a figure and what is wrong with it, in words.
using Broken = std::function<void(std::string_view key, const std::string& why)>;

// A visitor of the fields in scene_fields.h: tells each that is out of its range.
class RangeCheck {
public:
    explicit RangeCheck(Broken broken) : broken_(std::move(broken)) {}
    void operator()(std::string_view key, const auto& value, Quantity, const Range& range) const
    {
        check(key, glm::dvec3(value), range); // of one number three times the same
    }

private:
    void check(std::string_view key, const glm::dvec3& values, const Range& range) const;

    Broken broken_;
};

// What connects the figures of one part, each of which is within its range.
void check_probe(const ProbeSettings& probe, const Broken& broken);
void check_material(const Material& material, const Broken& broken);
void check_edge(const Region& region, const Broken& broken);
// What no scene says by itself: the surface and what is felt around it.
void check_probe_size(const ProbeSettings& probe, const SceneObject& object, const Broken& broken);
void check_effects_reach(const SceneObject& object, const Broken& broken);

// Half as often as the servo ticks, and beyond, what comes round is felt as something slower, or as running backwards.
// Of turns the value is in degrees per second.
enum class Rounds : uint8_t { swings, turns };
void check_rounds(std::string_view key, double value, Rounds rounds, double rate_hz, const Broken& broken);

// Why this scene cannot be felt by this hand, a line for each reason; empty: it can. Reads what the scene points to,
// and asks each motion where its object begins. Not for a servo thread.
std::string validate(const Scene* scene, const HandSettings& hand = {});

} // namespace haptel::runtime
