// What an exploration was like, for scripts and for people.
#pragma once

#include "runtime/servo/servo_report.h"
#include "tools/output/json.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haptel::tools {

// One hand of the exploration.
struct HandOutcome {
    std::string device; // as given on the command line or in the scene
    runtime::ServoReport servo;
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
