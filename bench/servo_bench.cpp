#include "bench/servo_bench.h"

#include "bench/bumpy_ball.h"
#include "runtime/servo/servo_thread.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <thread>

namespace haptel::bench {
namespace {

using namespace haptel::runtime;

class StrokingHand final : public HapticDevice {
public:
    const DeviceInfo& info() const override { return info_; }
    DeviceStatus read(DevicePose& pose) noexcept override
    {
        pose.tip_m = pose.tail_m = place_on_stroke(tick_++, -1e-3);
        return DeviceStatus::ok;
    }
    DeviceStatus write(const glm::dvec3&, const glm::dvec3&) noexcept override { return DeviceStatus::ok; }
    void stop() noexcept override {}

private:
    DeviceInfo info_{"hand on a stroke", 10};
    int tick_ = 0;
};

// A thread on each processor that does not rest.
class BusyProcessors {
public:
    explicit BusyProcessors(unsigned count)
    {
        for (unsigned i = 0; i < count; ++i)
            threads_.emplace_back([this] {
                while (!ending_.load(std::memory_order_relaxed)) {
                }
            });
    }
    ~BusyProcessors()
    {
        ending_ = true;
        for (std::thread& thread : threads_) thread.join();
    }
    BusyProcessors(const BusyProcessors&) = delete;
    BusyProcessors& operator=(const BusyProcessors&) = delete;

private:
    std::atomic<bool> ending_{false};
    std::vector<std::thread> threads_;
};

struct Scheduling {
    const char* name;
    bool real_time, bound;
};

} // namespace

std::vector<ServoRow> bench_servo(bool quick, const std::function<void(double)>& progress)
{
    constexpr double rates_hz[] = {250, 1000, 4000, 10'000};
    constexpr Scheduling schedulings[] = {
        {"ordinary", false, false}, {"real time", true, false}, {"real time, bound", true, true}};
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    const auto surface = build_surface(bumpy_ball(4)).surface;
    const TextureBinding stone = bound_over_ball("texture stone() { return 60um * fbm(p / 2mm, 4); }", "stone");
    std::vector<ServoRow> rows;
    const double all = 2.0 * static_cast<double>(std::size(rates_hz) * std::size(schedulings));
    for (const bool busy : {false, true})
        for (const double rate_hz : rates_hz)
            for (const Scheduling& scheduling : schedulings) {
                const auto scene = balls_on_a_grid(surface, 1, stone, {});
                scene->servo.rate_hz = rate_hz;
                ServoOptions options;
                options.seconds = quick ? 0.3 : 5;
                options.ask_for_real_time = scheduling.real_time;
                if (scheduling.bound) options.core = processors - 1;
                const BusyProcessors others(busy ? processors : 0);
                ServoThread servo(scene, std::make_unique<StrokingHand>(), options);
                servo.start();
                const ServoReport& report = servo.wait();
                rows.push_back({rate_hz, scheduling.name, busy, report.real_time, report});
                progress(static_cast<double>(rows.size()) / all);
            }
    return rows;
}

} // namespace haptel::bench
