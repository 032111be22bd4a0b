// What another program may do to an exploration, and see of it, whatever the protocol.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace haptel::tools {

struct ControlAnswer {
    std::string refused = {}; // why nothing was done, and how to mend it; empty: it is done, or under way
    std::string remark = {};  // beside what is done: a warning, or what it was; empty: nothing
};

struct ControlledObject {
    uint32_t number = 0;                                    // in the scene, from 1
    std::string name, texture;                              // mesh or shape; "" where it has no texture
    std::vector<std::pair<std::string, double>> parameters; // SI, as set last; no pictures
    std::vector<std::string> presets;                       // that choose_preset takes
};

struct ControlledHand {
    glm::dvec3 position_m{0}, force_n{0};
    uint32_t contact = 0; // number of objects touched
    uint32_t object = 0;  // the one that is touched deepest; 0: none
    uint32_t faults = 0;  // bits of TickResult::faults, of the newest tick
    uint64_t missed_deadlines = 0;
};

// Called on one thread, which is not a servo's.
class Controlled {
public:
    virtual ~Controlled() = default;

    // `value` as in a scene file. Felt at once, without compiling.
    virtual ControlAnswer set(uint32_t object, const std::string& parameter, const std::string& value) = 0;
    virtual ControlAnswer choose_preset(uint32_t object, const std::string& name) = 0;
    virtual ControlAnswer load_scene(const std::string& file) = 0;
    virtual ControlAnswer start_recording() = 0;
    virtual ControlAnswer stop_recording() = 0;
    virtual void withhold_force(bool is_withheld) = 0;

    virtual bool is_force_withheld() const = 0;
    virtual std::vector<ControlledHand> hands() const = 0;
    virtual std::vector<ControlledObject> objects() const = 0;
    // Another number whenever objects() may tell something else.
    virtual uint64_t objects_version() const = 0;
};

} // namespace haptel::tools
