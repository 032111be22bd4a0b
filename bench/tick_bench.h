// The servo's tick: how long it takes and what it looks at, by probe, size of the mesh and number of objects.
#pragma once

#include "bench/timing.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

struct TickRow {
    std::string scene; // what is felt, in a word or two
    uint64_t triangles = 0, objects = 1;
    double contact = 0; // share of the ticks that touch
    // The clock's own time taken off. The same ticks are run five times (twice if quick): the least time of each, and
    // those of the first run.
    Times tick_ns, once_ns;
    Times ahead_ns;          // after the tick: what the next may need, brought into the cache
    Times tree_ns;           // a walk through the tree of boxes for the same way of the hand, in the same run
    Times queries;           // per tick: walks through trees
    Times triangles_stepped; // per tick, for its force: delivered by trees, and stepped on by proxies
    Times triangles_touched; // all that the servo reads for a tick: those, and the ones ahead, some of them twice
};

// Ticks along one stroke over a ball with small bumps, which differs between rows only in what it is made of.
// Interleaved: the ticks of all rows by turns. `progress`: the share that is done, 0 .. 1.
std::vector<TickRow> bench_tick(bool quick, const std::function<void(double)>& progress);

// What a tick costs more on the last of these rows than on the first.
struct Growth {
    double median = 0, p99 = 0, touched_p99 = 0, stepped_p99 = 0;
};
Growth growth(const TickRow& first, const TickRow& last);

} // namespace haptel::bench
