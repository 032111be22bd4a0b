// Recorded runs, read back: the one entry for both kinds of file, the binary recording of `haptel record`
// (trace_log.h) and the trace.csv of `haptel explore --out` (trace_csv.h). Their numbers come back to the bit, so a
// replay gives the same forces.
#pragma once

#include "runtime/servo/telemetry.h"
#include "runtime/servo/trace_origin.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptel::runtime {

struct TraceResult {
    std::vector<TickRecord> records;        // in the order of the file
    std::optional<TraceOrigin> origin = {}; // of a binary recording
    std::string error = {};                 // "FILE:LINE: what is wrong"; then the records are those before it
    std::string note = {};                  // the file ends within a tick, as after a crash: those before it are read
};

// Either kind, told apart by how it begins.
TraceResult read_trace(const std::filesystem::path& file);

// Some days of ticks.
inline constexpr std::uintmax_t trace_bytes_max = std::uintmax_t{64} << 30;

} // namespace haptel::runtime
