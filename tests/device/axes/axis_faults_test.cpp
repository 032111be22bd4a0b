// Servo and faults run against each other: whichever fault of a board or a wheel begins at whichever moment, the device
// comes back, pushes nobody before it has a pose, and no force stays when it is let go.
#include "device/evdev/evdev_axes.h"
#include "tests/device/evdev/fake_wheel.h"
#include "tests/device/hid/board_ticks.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

constexpr glm::dvec3 push_n{6, 0, 0}; // of 20
constexpr double nudge_share_max = 0.2;
constexpr AxisTimes hurried{.watchdog_ms = 200, .nudge_ms = 60, .again_ms = 5, .patience_s = 600};

struct AxisFaultRun {
    bool survived = false;             // it had a pose and pushed again afterwards
    double strongest_without_pose = 0; // share of the force, if it never had a pose before the fault ended
    double left = 0;                   // of the force, when it was let go
    double seconds = 0;
};

// `strongest` so far and `level` now are shares of the force.
template <typename Mend, typename Strongest, typename Level>
AxisFaultRun run_with_fault(std::optional<AxisDevice>& device, int ticks, Mend mend, Strongest strongest, Level level)
{
    AxisFaultRun run;
    const auto start = std::chrono::steady_clock::now();
    bool had_pose = false;
    for (int i = 0; i < ticks; ++i) {
        DevicePose pose;
        had_pose = device->read(pose) == DeviceStatus::ok || had_pose;
        device->write(push_n, no_torque);
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        if (!had_pose) run.strongest_without_pose = strongest();
    }
    mend();
    run.survived = ticks_until(*device, push_n, [&](DeviceStatus status, auto&) {
        return status == DeviceStatus::ok && std::fabs(level()) > nudge_share_max;
    });
    device.reset();
    run.left = level();
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return run;
}

AxisFaultRun run_board(std::mt19937& random)
{
    FakeBoard board;
    board.wire(0, random() % 2 == 0 ? 1 : -1);
    const auto fault = static_cast<BoardFault>(random() % 9); // `none` unplugs it
    const bool unplugs = fault == BoardFault::none;
    if (!unplugs) board.inject(fault, random() % 600, random() % 2 == 0 ? 1 + random() % 60 : uint64_t{1} << 60);
    std::optional<AxisDevice> device;
    device.emplace("openffboard", open_board(board), board_settings, hurried);
    if (unplugs) {
        const int until = static_cast<int>(random() % 400);
        for (int i = 0; i < until; ++i) {
            DevicePose pose;
            device->read(pose);
            device->write(push_n, no_torque);
            std::this_thread::sleep_for(std::chrono::microseconds(500));
        }
        board.plug(false);
    }
    const auto mend = [&] {
        board.inject(BoardFault::none, 0, 0);
        board.plug(true);
        board.turn_to(0, 0);
        board.turn_to(1, 0);
    };
    return run_with_fault(
        device, 60, mend, [&] { return unplugs ? 0 : board.strongest(); }, [&] { return board.force(0); });
}

AxisFaultRun run_wheel(std::mt19937& random)
{
    FakeWheel wheel(1 + static_cast<int>(random() % 2));
    wheel.axes[0].sign = random() % 2 == 0 ? 1 : -1;
    const bool unplugs = random() % 3 == 0;
    const int64_t after = random() % 120, calls = random() % 2 == 0 ? 1 + random() % 30 : int64_t{1} << 60;
    if (!unplugs) wheel.fails_for = calls, wheel.fails_at = after;
    std::optional<AxisDevice> device;
    device.emplace(
        "evdev:fake", [&wheel] { return evdev_axes(wheel.open(), {}); },
        AxisSettings{.travel_m = 0.4, .force_max_n = 20, .axes = wheel.count}, hurried);
    if (unplugs) {
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 200));
        wheel.is_plugged = false;
    }
    const auto mend = [&] {
        wheel.fails_at = -1;
        wheel.is_plugged = true;
        wheel.turn_to(0, 0);
        wheel.turn_to(1, 0);
    };
    const auto level = [&] { return wheel.level(0); };
    return run_with_fault(device, 60, mend, [&] { return std::fabs(level()); }, level);
}

void run_with_faults(uint32_t runs)
{
    double longest_s = 0;
    for (uint32_t seed = 1; seed <= runs; ++seed) {
        std::mt19937 random(seed);
        const bool of_board = random() % 2 == 0;
        const AxisFaultRun run = of_board ? run_board(random) : run_wheel(random);
        INFO("seed " << seed << (of_board ? ": board" : ": wheel"));
        CHECK(run.survived);
        CHECK(run.strongest_without_pose <= nudge_share_max * 1.001);
        CHECK(run.left == 0);
        longest_s = std::max(longest_s, run.seconds);
    }
    WARN(runs << " runs, the longest " << longest_s << " s");
}

} // namespace

TEST_CASE(
    "faults of boards and wheels at random moments: no force without a pose, a pose again, and no force in the end")
{
    run_with_faults(haptel::test::is_sanitized ? 6 : 20); // each waits
}

TEST_CASE("faults of boards and wheels at random moments, two thousand times", "[.long]")
{
    run_with_faults(2000);
}
