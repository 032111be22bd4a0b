// How well the servo keeps its deadlines on this machine: by rate, by what it is allowed, and by what else runs.
#pragma once

#include "runtime/servo/servo_report.h"

#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

struct ServoRow {
    double rate_hz = 0;
    std::string scheduling; // "ordinary", "real time", "real time, bound" to the last processor
    bool busy = false;      // another thread computes on each processor
    bool granted = false;   // real time was, where it was asked for
    runtime::ServoReport report;
};

// The servo of `haptel explore` with a hand that strokes a textured ball, by the wall's clock. `progress`: the share
// that is done, 0 .. 1.
std::vector<ServoRow> bench_servo(bool quick, const std::function<void(double)>& progress);

} // namespace haptel::bench
