// What an exploration was like, for scripts and for people.
#pragma once

#include "runtime/servo/servo_report.h"
#include "runtime/servo/telemetry.h"
#include "tools/output/json.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace haptel::tools {

// Least and greatest height of textures below a hand while it touched, metres of the hand's own space.
struct HeightRange {
    double minimum_m = std::numeric_limits<double>::infinity(), maximum_m = -minimum_m;

    void add(const runtime::TickRecord& tick, double scale); // of its workspace
    double width_m() const { return maximum_m > minimum_m ? maximum_m - minimum_m : 0; }
};

// One hand of the exploration.
struct HandOutcome {
    std::string device; // as given on the command line or in the scene
    runtime::ServoReport servo;
    HeightRange heights;
    double position_resolution_m = 0; // of the device; 0: not known

    // The texture is less than two of the device's position steps high: the force jumps by a step as much as by the
    // texture.
    bool hides_texture() const;
};

struct ExploreOutcome {
    std::string scene;
    std::string clock;              // "wall" | "virtual"
    std::vector<HandOutcome> hands; // at least one, in the order of the scene
    uint64_t textures_compiled = 0; // at the start and on reloads
};

// The fields that the command promises to scripts, those of the first device, and a few more; `devices` has all.
Json to_json(const ExploreOutcome& outcome);

// A dozen lines for a person, the important first.
std::string to_lines(const ExploreOutcome& outcome);

} // namespace haptel::tools
