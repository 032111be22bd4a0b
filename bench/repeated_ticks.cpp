#include "bench/repeated_ticks.h"

#include <algorithm>
#include <chrono>

namespace haptel::bench {

using namespace haptel::runtime;

namespace {

ContactWork difference(const ContactWork& after, const ContactWork& before)
{
    return {after - before, after.read_ahead - before.read_ahead};
}

// The tail of a stylus is so far out that its shaft stands on the ball.
DevicePose pose_at(const glm::dvec3& hand_m)
{
    return {hand_m, 1.5 * hand_m};
}

} // namespace

RepeatedTicks::RepeatedTicks(const std::shared_ptr<const Scene>& scene, int passes, const glm::dvec3& start_m)
{
    while (passes--) {
        passes_.push_back(std::make_unique<Renderer>(scene));
        passes_.back()->tick(pose_at(start_m));
    }
}

void RepeatedTicks::turn(int first, int end, const Place& place, const Look& look)
{
    using Clock = std::chrono::steady_clock;
    double clock_ns = 0;
    const auto ns = [&](Clock::time_point from, Clock::time_point to) {
        return std::max(0.0, std::chrono::duration<double, std::nano>(to - from).count() - clock_ns);
    };
    for (auto& pass : passes_) {
        clock_ns = clock_reading_ns();
        for (int number = first; number < end; ++number) {
            const glm::dvec3 hand_m = place(number);
            const ContactWork before = pass->work();
            const auto begin = Clock::now();
            const TickResult felt = pass->tick(pose_at(hand_m));
            const auto done = Clock::now();
            pass->between_ticks();
            const double took = ns(begin, done), ahead = ns(done, Clock::now());
            if (pass == passes_.front()) {
                least_ns_.push_back(took);
                once_ns_.push_back(took);
                look({felt, difference(pass->work(), before), ahead, hand_m, clock_ns});
            } else {
                double& least = least_ns_[static_cast<std::size_t>(number)];
                least = std::min(least, took);
            }
        }
    }
}

} // namespace haptel::bench
