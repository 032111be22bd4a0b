// What an exploration was like, for scripts and for people.
#pragma once

#include "runtime/servo_report.h"
#include "tools/json.h"

#include <cstdint>
#include <string>

namespace haptel::tools {

struct ExploreOutcome {
    std::string scene, device; // as given on the command line or in the scene
    std::string clock;         // "wall" | "virtual"
    runtime::ServoReport servo;
    uint64_t textures_compiled = 0; // at the start and on reloads
};

// The fields that the command promises to scripts, and a few more.
Json to_json(const ExploreOutcome& outcome);

// A dozen lines for a person, the important first.
std::string to_lines(const ExploreOutcome& outcome);

} // namespace haptel::tools
