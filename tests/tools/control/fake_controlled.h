// An exploration of two objects that keeps what it was told to do.
#pragma once

#include "tools/control/controlled.h"

#include <string>
#include <vector>

namespace haptel::test {

struct FakeControlled final : tools::Controlled {
    std::vector<std::string> done;
    bool withheld = false;
    uint64_t version = 1;
    double depth_m = 60e-6;

    tools::ControlAnswer set(uint32_t object, const std::string& parameter, const std::string& value) override
    {
        if (parameter == "wrong") return {"no such parameter", {}};
        done.push_back("set " + std::to_string(object) + " " + parameter + " " + value);
        return {{}, parameter == "deep" ? "outside of its range" : ""};
    }
    tools::ControlAnswer choose_preset(uint32_t object, const std::string& name) override
    {
        done.push_back("preset " + std::to_string(object) + " " + name);
        return {};
    }
    tools::ControlAnswer load_scene(const std::string& file) override
    {
        done.push_back("scene " + file);
        return {};
    }
    tools::ControlAnswer start_recording() override
    {
        done.push_back("record");
        return {};
    }
    tools::ControlAnswer stop_recording() override { return {"nothing is recorded", {}}; }
    void withhold_force(bool is_withheld) override { withheld = is_withheld; }
    bool is_force_withheld() const override { return withheld; }
    std::vector<tools::ControlledHand> hands() const override
    {
        return {{{0.001, 0.002, 0.003}, {0, 0, 1.5}, 1, 2, 4, 7}};
    }
    std::vector<tools::ControlledObject> objects() const override
    {
        return {{1, "plane", "", {}, {}},
                {2, "ball.obj", "rock", {{"depth", depth_m}, {"octaves", 5}}, {"rock", "flint"}}};
    }
    uint64_t objects_version() const override { return version; }
};

} // namespace haptel::test
