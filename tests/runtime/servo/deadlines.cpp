// Deadlines on a busy machine, against a log that the device keeps by a clock of its own.
#include "runtime/servo/servo_thread.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

using SteadyClock = std::chrono::steady_clock;

// When each tick began and ended, and what it was about.
struct Log {
    struct Tick {
        double began_s = 0, ended_s = 0;
        glm::dvec3 hand_m{0}, force_n{0};
    };
    std::vector<Tick> ticks;
    double finished_s = 0;
};

// A hand of flesh: it moves by the clock of the wall, late ticks or not.
class LoggedDevice final : public HapticDevice {
public:
    LoggedDevice(std::size_t ticks, Log& log) : ticks_(ticks), log_(log)
    {
        info_.name = "logged";
        info_.force_max_n = 100;
        log_.ticks.reserve(ticks);
    }
    const DeviceInfo& info() const override { return info_; }
    DeviceStatus read(DevicePose& pose) noexcept override
    {
        const double t = now_s();
        pose = at(0.02 * std::sin(5 * t), 0.01 * std::cos(3 * t), -2e-3 - 1e-3 * std::sin(7 * t));
        if (log_.ticks.size() == ticks_) {
            ended_ = true;
            log_.finished_s = t;
            return DeviceStatus::finished;
        }
        log_.ticks.push_back({t, t, pose.tip_m, {}});
        return DeviceStatus::ok;
    }
    DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3&) noexcept override
    {
        if (ended_) return DeviceStatus::ok; // the zero of the end
        log_.ticks.back().force_n = force_n;
        log_.ticks.back().ended_s = now_s();
        return DeviceStatus::ok;
    }
    void stop() noexcept override {}

private:
    double now_s() const noexcept { return std::chrono::duration<double>(SteadyClock::now() - start_).count(); }

    DeviceInfo info_;
    std::size_t ticks_;
    Log& log_;
    bool ended_ = false;
    SteadyClock::time_point start_ = SteadyClock::now();
};

// A thread on each processor that does not rest, and two more.
class BusyMachine {
public:
    BusyMachine()
    {
        for (unsigned i = 0; i < std::thread::hardware_concurrency() + 2; ++i)
            threads_.emplace_back([this] {
                while (!ending_.load(std::memory_order_relaxed)) {
                }
            });
    }
    ~BusyMachine()
    {
        ending_ = true;
        for (std::thread& thread : threads_) thread.join();
    }
    BusyMachine(const BusyMachine&) = delete;
    BusyMachine& operator=(const BusyMachine&) = delete;

private:
    std::atomic<bool> ending_{false};
    std::vector<std::thread> threads_;
};

// By how much the servo's count of periods contradicts the log. Deadlines are a grid of equal periods; no tick begins
// before its own, and its own comes after the end of the tick before. A period too few or too many moves all ticks
// behind it along the grid by one, where those that were in time are before their deadline, or end after the next.
double contradiction_s(const Log& log, const std::vector<double>& deadlines_s)
{
    double grid_s = 1e9;
    for (std::size_t i = 0; i < deadlines_s.size(); ++i)
        grid_s = std::min(grid_s, log.ticks[i].began_s - deadlines_s[i]);
    double worst_s = -1;
    for (std::size_t i = 1; i < deadlines_s.size(); ++i)
        worst_s = std::max(worst_s, log.ticks[i - 1].ended_s - (grid_s + deadlines_s[i]));
    return worst_s;
}

} // namespace

TEST_CASE("on a busy machine missed deadlines are told as the device's own clock has them, and no force steps")
{
    for (const double rate_hz : {250.0, 1000.0, 10'000.0}) {
        CAPTURE(rate_hz);
        Scene scene = bare_scene(plane_mesh(0.1, 16));
        scene.servo.rate_hz = rate_hz;
        Log log;
        ServoOptions options;
        options.ask_for_real_time = false; // it is late more often
        // fewer than it takes until a servo that misses most of its deadlines ends the run
        const auto ticks = static_cast<std::size_t>(std::clamp(rate_hz / 2, 250.0, 2000.0));
        const BusyMachine others;
        ServoThread servo(shared(std::move(scene)), std::make_unique<LoggedDevice>(ticks, log), options);
        servo.start();
        const ServoReport& report = servo.wait();
        REQUIRE(log.ticks.size() == ticks);
        CHECK(report.ticks == ticks);

        std::vector<double> deadlines_s;
        TickRecord record;
        while (servo.telemetry().pop(record)) deadlines_s.push_back(record.time_s);
        REQUIRE(deadlines_s.size() == ticks);
        CHECK(contradiction_s(log, deadlines_s) <= 0);
        for (const double wrong_s : {-1 / rate_hz, 1 / rate_hz}) {
            std::vector<double> miscounted_s = deadlines_s;
            for (std::size_t i = ticks / 2; i < ticks; ++i) miscounted_s[i] += wrong_s;
            CHECK(contradiction_s(log, miscounted_s) > 0);
        }

        const double periods = std::round((deadlines_s.back() - deadlines_s.front()) * rate_hz) + 1;
        const double missed = periods - static_cast<double>(ticks);
        const double told = static_cast<double>(report.missed_deadlines);
        const double at_the_end = std::ceil((log.finished_s - log.ticks.back().ended_s) * rate_hz);
        CHECK(told >= missed);
        CHECK(told <= missed + at_the_end);

        double worst = 0; // change of force over what the hand's way is worth
        for (std::size_t i = 1; i < ticks; ++i) {
            const double way_m = glm::distance(log.ticks[i].hand_m, log.ticks[i - 1].hand_m);
            const double change_n = glm::distance(log.ticks[i].force_n, log.ticks[i - 1].force_n);
            worst = std::max(worst, change_n - spring_n_per_m * way_m);
        }
        CHECK(worst <= 1e-9);
        WARN(rate_hz << " Hz: " << told << " of " << periods << " deadlines missed");
    }
}
