// What a run was like: the figures of `haptel explore`.
#pragma once

#include "runtime/render/skipped_stages.h"
#include "runtime/servo/histogram.h"

#include <cstdint>
#include <optional>
#include <string>

namespace haptel::runtime {

enum class ServoState : uint8_t {
    ready, // made, not started
    running,
    finished, // its time or its device's stroke is over
    stopped,  // on request
    faulted,  // the device failed, the scene is refused, or deadlines cannot be kept: no force, see stop_reason
};

// Ticks in which that was left out because deadlines were missed (overload.h), those in which it faded included.
struct DegradedTicks {
    uint64_t without_effects = 0, without_textures = 0, without_force = 0;
};

struct ServoReport {
    ServoState state = ServoState::ready;
    std::string stop_reason;    // in words
    bool real_time = false;     // SCHED_FIFO and locked memory were granted
    std::string real_time_note; // why not, or nothing; the same of a processor that it was to stay on
    double processor_share = 0; // of one processor, of the time that the run took; 0 on the virtual clock

    double seconds = 0; // periods that went by, missed ones included, times the period
    double rate_hz = 0;
    uint64_t ticks = 0;
    uint64_t missed_deadlines = 0; // periods in which no force was sent because the tick before was late
    DegradedTicks degraded;
    uint64_t contact_ticks = 0;
    uint64_t waiting_ticks = 0;                        // without a force because the one computed was not small yet
    Histogram tick_ns;                                 // pose in hand to force computed
    Histogram wake_late_ns;                            // after the deadline; empty on the virtual clock
    Histogram link_ns;                                 // from a force to the pose that answers it, where a device does
    double force_rms_n = 0, force_max_n = 0;           // as sent, over all ticks
    double grip_force_rms_n = 0, grip_force_max_n = 0; // the same of what pushes a gripper's fingers apart
    double energy_j = 0;         // that the forces gave to the hand; negative where they took more than they gave
    uint64_t faults = 0;         // ticks with a fault of texture, pose or force
    uint32_t fault_bits = 0;     // bits of TickResult::faults seen
    uint64_t reloads = 0;        // bindings published after start
    uint64_t scenes_swapped = 0; // scenes that took the place of another one after start
    std::optional<uint64_t> allocations_in_tick; // empty: not counted in this program
    SkippedStages skipped;
    uint64_t records_dropped = 0; // telemetry that nobody read in time
};

} // namespace haptel::runtime
