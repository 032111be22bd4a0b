// A recording, felt again: the scene as its files are now under the hand that was recorded.
#pragma once

#include "runtime/servo/recording.h"

#include <filesystem>
#include <string>
#include <vector>

namespace haptel::tools {

struct Replayed {
    std::vector<runtime::TickRecord> ticks;
    std::vector<std::string> objects;       // their names, in the order of the scene
    std::vector<runtime::TracedFile> files; // that the forces depend on
    std::string diagnostics;                // of the scene, ready to print
    std::string fault;                      // why nothing, or not all of it, was felt; empty: all is well
};

// The scene that the recording names, seen from where the recording lies; empty: it names none.
std::filesystem::path scene_of(const std::filesystem::path& recording, const runtime::TraceResult& recorded);

// As fast as it can. Other devices of the scene stay where they are.
Replayed replay_run(const std::filesystem::path& scene, const std::filesystem::path& recording,
                    const runtime::TraceResult& recorded);

} // namespace haptel::tools
