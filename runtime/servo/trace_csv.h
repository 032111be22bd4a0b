// A run as text: trace.csv, one row per tick, for whoever plots it. Numbers round-trip exactly.
#pragma once

#include "runtime/servo/recording.h"

#include <filesystem>
#include <iosfwd>

namespace haptel::runtime {

void write_trace_header(std::ostream& out);
void write_trace_row(std::ostream& out, const TickRecord& record);

// The columns from `interrupted` on may be absent: no interruption, a device of which the limit is not known, no
// torque, no gripper.
TraceResult read_trace_csv(const std::filesystem::path& file);

} // namespace haptel::runtime
