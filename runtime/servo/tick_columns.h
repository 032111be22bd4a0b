// A tick as a row of numbers: the one list of columns that every file of ticks is written and read by.
#pragma once

#include "runtime/servo/telemetry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

namespace haptel::runtime {

inline constexpr std::size_t tick_column_count = 28;

// In the order in which they are written. Readers go by name: columns may be reordered, and others added. Units are in
// the names.
inline constexpr std::array<std::string_view, tick_column_count> tick_columns = {
    "tick",     "time_s",   "x_m",        "y_m",         "z_m",          "tail_x_m",
    "tail_y_m", "tail_z_m", "fx_n",       "fy_n",        "fz_n",         "contact",
    "depth_m",  "height_m", "compute_ns", "binding",     "interrupted",  "device_force_max_n",
    "waiting",  "tqx_n_m",  "tqy_n_m",    "tqz_n_m",     "grip_force_n", "degraded",
    "object",   "faults",   "woken_ns",   "wake_late_ns"};

using TickField = std::variant<uint64_t*, uint32_t*, double*>;

// Where the columns live in a record.
std::array<TickField, tick_column_count> tick_fields(TickRecord& record);

// Of the column of that name; none: there is no such column.
std::optional<std::size_t> tick_column(std::string_view name);

} // namespace haptel::runtime
