// What a tick saves by leaving out what cannot change the force, and that nobody feels it.
#pragma once

#include "bench/timing.h"

#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

struct SkipRow {
    std::string scene, skip;   // where the hand is; what is left out
    Times with_ns, without_ns; // a tick with the skip and one without it
    double counted = 0;        // per tick, by the report's counter of that skip
    double force_difference_max_n = 0;
};

// The ticks of one stroke, with and without, by turns. `progress`: the share that is done, 0 .. 1.
std::vector<SkipRow> bench_skip(bool quick, const std::function<void(double)>& progress);

} // namespace haptel::bench
