// How the servo's tick grows with the scene, one thing at a time, and what a surface costs to build and to hold.
#pragma once

#include "bench/timing.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

// Of ticks in contact with fbm of four octaves, damping and, where not said otherwise, friction.
struct ScaleRow {
    std::string axis; // what grows: triangles, objects, contacts (objects touched at once), radius (of a ball as probe)
    std::string probe;
    double probe_radius_m = 0; // 0: not a ball
    bool friction = true;
    uint64_t triangles = 0, objects = 1;
    double contacts = 0; // mean
    // The clock's own time taken off. The same ticks are run five times (once if quick): `tick_ns` is of the least
    // time of each, what the tick itself costs; `once_ns` is of the first run, with whatever else the machine did
    // meanwhile.
    Times tick_ns, once_ns;
    // Over the first row of the same axis, probe and friction.
    double growth_median = 1, growth_p99 = 1;
};

struct BuildRow {
    uint64_t triangles = 0;
    double build_ms = 0, ns_per_triangle = 0;
    double bytes_per_triangle = 0; // that the process has more resident; 0: not known on this system
    double growth = 1;             // of the time per triangle, over the first row
};

struct Scale {
    std::vector<ScaleRow> rows;
    std::vector<BuildRow> builds;
};

// Interleaved: the ticks of all rows of an axis by turns. `progress`: the share that is done, 0 .. 1.
Scale bench_scale(bool quick, const std::function<void(double)>& progress);

} // namespace haptel::bench
