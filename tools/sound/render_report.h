// What haptel render tells of a sound.
#pragma once

#include "tools/output/json.h"
#include "tools/sound/level.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

struct RenderOutcome {
    std::string to;                      // the file, or the sound card
    std::string format;                  // "16", "24", "float"; empty: played
    std::vector<std::string> components; // one per channel
    double rate_hz = 0, high_pass_hz = 0, full_scale_n = 1;
    uint64_t frames = 0, clipped = 0, contact_ticks = 0, faults = 0;
    std::optional<uint64_t> underruns; // of a card
    sound::Level level;                // before it was clipped
};

Json to_json(const RenderOutcome& outcome);
std::string to_lines(const RenderOutcome& outcome);

} // namespace haptel::tools
