// The same ticks of the servo, run several times.
//
// A tick does the same work whenever it is run, but a machine that is not set aside does other work too. Its least time
// is what it costs itself.
#pragma once

#include "bench/timing.h"
#include "runtime/render/renderer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace haptel::bench {

// What is there for whoever looks after a tick: the work of it alone, and where the hand was.
struct TickLook {
    const runtime::TickResult& felt;
    runtime::ContactWork work;
    double ahead_ns; // that bringing into the cache what the next may need took
    glm::dvec3 hand_m;
    double clock_ns; // what reading the clock added to a time
};

class RepeatedTicks {
public:
    using Place = std::function<glm::dvec3(int)>; // of the hand in that tick, metres
    using Look = std::function<void(const TickLook&)>;

    // Each of the passes has a renderer of its own, which feels `start_m` first.
    RepeatedTicks(const std::shared_ptr<const runtime::Scene>& scene, int passes, const glm::dvec3& start_m);

    // One pass after the other. `look`: after each tick of the first pass; what it does is not timed.
    void turn(int first, int end, const Place& place, const Look& look);

    Times least_ns() const { return summary(least_ns_); }
    Times once_ns() const { return summary(once_ns_); } // of the first pass alone
    std::size_t count() const { return once_ns_.size(); }

private:
    std::vector<std::unique_ptr<runtime::Renderer>> passes_;
    std::vector<double> least_ns_, once_ns_; // by tick
};

} // namespace haptel::bench
