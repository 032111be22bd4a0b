#include "runtime/servo/tick_columns.h"

#include <algorithm>

namespace haptel::runtime {

std::array<TickField, tick_column_count> tick_fields(TickRecord& r)
{
    return {&r.tick,     &r.time_s,       &r.tip_m.x,      &r.tip_m.y,      &r.tip_m.z,      &r.tail_m.x,
            &r.tail_m.y, &r.tail_m.z,     &r.force_n.x,    &r.force_n.y,    &r.force_n.z,    &r.contact,
            &r.depth_m,  &r.height_m,     &r.compute_ns,   &r.binding,      &r.interrupted,  &r.device_force_max_n,
            &r.waiting,  &r.torque_n_m.x, &r.torque_n_m.y, &r.torque_n_m.z, &r.grip_force_n, &r.degradation,
            &r.object,   &r.faults,       &r.woken_ns,     &r.wake_late_ns};
}

std::optional<std::size_t> tick_column(std::string_view name)
{
    const auto found = std::find(tick_columns.begin(), tick_columns.end(), name);
    if (found == tick_columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - tick_columns.begin());
}

} // namespace haptel::runtime
