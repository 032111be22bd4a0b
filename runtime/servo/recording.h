// A run as text: trace.csv, one row per tick. Numbers round-trip exactly, so a replay gives the same forces bit for
// bit.
#pragma once

#include "runtime/servo/telemetry.h"

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::runtime {

// The columns, in the order that is written. Readers go by name: columns may be reordered, and others added.
inline constexpr std::string_view trace_columns =
    "tick,time_s,x_m,y_m,z_m,tail_x_m,tail_y_m,tail_z_m,fx_n,fy_n,fz_n,"
    "contact,depth_m,height_m,compute_ns,binding,interrupted,device_force_max_n,waiting,tqx_n_m,tqy_n_m,tqz_n_m,"
    "grip_force_n,degraded";

void write_trace_header(std::ostream& out);
void write_trace_row(std::ostream& out, const TickRecord& record);

struct TraceResult {
    std::vector<TickRecord> records; // in the order of the file
    std::string error;               // "FILE:LINE: what is wrong"; empty: all rows were read
};

// The columns from `interrupted` on may be absent: no interruption, a device of which the limit is not known, no
// torque, no gripper.
TraceResult read_trace(const std::filesystem::path& file);

} // namespace haptel::runtime
