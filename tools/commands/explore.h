// What `haptel explore` and `haptel record` share: all but where the run is kept.
#pragma once

#include "tools/commands/command.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

struct ExploreOptions {
    std::string scene;
    std::string out;                  // folder; empty: nothing is written there
    std::string recording;            // file; empty: none
    std::vector<std::string> devices; // in place of the scene's, from the first on
    std::string clock = "wall";
    std::optional<unsigned> core;     // that the servo stays on
    std::optional<uint16_t> osc_port; // where it is controlled; empty: nowhere
    std::optional<double> seconds;    // until Ctrl-C, where it is not given
    bool json = false;
};

// The scene and how it is felt; not what is kept of it.
void add_exploring(CLI::App& command, ExploreOptions& options);

ExitCode explore(const ExploreOptions& options);

} // namespace haptel::tools
