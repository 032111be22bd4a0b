#include "tests/device/falcon/fake_transport.h"
#include "tests/device/falcon/quick_falcon.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <limits>
#include <random>

using namespace haptel::device;
using namespace haptel::runtime;
using glm::dvec3;

namespace {

// Servo and faults run against each other: whichever fault begins at whichever moment, the device comes back or says
// why not, and pushes nobody in between.
struct FaultRun {
    FakeFault fault;
    bool survived = false; // a pose was there afterwards
    uint64_t forces_without_pose = 0, violations = 0;
    double seconds = 0;
};

FaultRun run_with_fault(uint32_t seed)
{
    std::mt19937 random(seed);
    FaultRun run{all_fake_faults[random() % all_fake_faults.size()]};
    const auto start = std::chrono::steady_clock::now();
    FakeFalcon falcon(random() % 2 == 0, 2);
    FalconOptions options = quick_options();
    options.times.silence_ms = 30;
    options.pose_age_max_ms = 15;
    options.tries = 100;
    options.again_ms = 1;
    falcon.inject(run.fault, random() % 250, random() % 2 == 0 ? 1 + random() % 60 : uint64_t{1} << 60);
    FalconDevice device("falcon", open_fake(falcon), options);
    constexpr uint64_t none = std::numeric_limits<uint64_t>::max();
    uint64_t limit = none; // of packets with a force, while there is no pose: one may be on its way
    const auto ticks = [&](int count, bool wait_for_pose) {
        for (int i = 0; i < count; ++i) {
            DevicePose pose;
            const bool has_pose = device.read(pose) == DeviceStatus::ok;
            device.write({0, 0, 2}, dvec3(0));
            if (has_pose && wait_for_pose) return true;
            if (has_pose)
                limit = none;
            else if (limit == none)
                limit = falcon.packets_with_force() + 1;
            std::this_thread::sleep_for(std::chrono::microseconds(300));
            run.forces_without_pose += falcon.packets_with_force() > limit;
        }
        return false;
    };
    ticks(60, false);
    falcon.inject(FakeFault::none, 0, 0);
    if (run.fault == FakeFault::unplug) falcon.plug_in();
    run.survived = ticks(6000, true);
    run.violations = falcon.violations();
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return run;
}

void run_with_faults(uint32_t runs)
{
    double longest_s = 0;
    uint32_t survived = 0;
    for (uint32_t seed = 1; seed <= runs; ++seed) {
        const FaultRun run = run_with_fault(seed);
        INFO("seed " << seed << ": " << name_of(run.fault));
        CHECK(run.survived);
        CHECK(run.forces_without_pose == 0);
        CHECK(run.violations == 0);
        CHECK(run.seconds < 10);
        survived += run.survived;
        longest_s = std::max(longest_s, run.seconds);
    }
    WARN(runs << " runs, " << survived << " with a pose after the fault, the longest " << longest_s << " s");
}

} // namespace

TEST_CASE("faults at random moments: never a force without a pose, and a pose again afterwards")
{
    run_with_faults(200);
}

TEST_CASE("faults at random moments, ten thousand times", "[.long]")
{
    run_with_faults(10'000);
}
