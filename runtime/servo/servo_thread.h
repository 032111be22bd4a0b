// The loop between device and hand: one thread per device, one tick per period.
//
// On the wall clock it keeps absolute deadlines: a tick that is late makes the loop skip the periods that have passed,
// count them and go on, never catch up in a burst. Where the system lets it, it runs under SCHED_FIFO with locked
// memory and spins over the last part of each wait (a fifth of a CPU); where not, it sleeps and says so in the report.
// On the virtual clock it runs as fast as it can, and the same scene and device give the same forces bit for bit.
// A scene that does not validate (validation.h) is never felt: the run ends before its first tick.
// Whatever ends the loop - its time, a request, the device - ends it with zero force and a stopped device.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "runtime/render/renderer.h"
#include "runtime/render/renderer_slot.h"
#include "runtime/scene/scene.h"
#include "runtime/servo/overload.h"
#include "runtime/servo/servo_report.h"
#include "runtime/servo/telemetry.h"

#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace haptel::runtime {

enum class ServoClock : uint8_t { wall, virtual_time };

struct ServoOptions {
    HandSettings hand; // its force_max_n is the device's
    ServoClock clock = ServoClock::wall;
    double seconds = std::numeric_limits<double>::infinity(); // then it finishes
    bool ask_for_real_time = true;                            // wall clock only
    std::optional<unsigned> core = {};                        // processor to stay on, from 0; wall clock only
    std::size_t telemetry_capacity = 1 << 14;                 // records
    // Virtual clock only: wait while the telemetry ring is full, so that no record is lost. Somebody must read it.
    bool wait_for_reader = false;
    // Allocations of the calling thread so far (runtime/servo/allocation_count.h); null: not counted.
    uint64_t (*allocation_count)() noexcept = nullptr;
};

class ServoThread {
public:
    ServoThread(std::shared_ptr<const Scene> scene, std::unique_ptr<HapticDevice> device, const ServoOptions& options);
    ~ServoThread(); // stops and waits

    ServoThread(const ServoThread&) = delete;
    ServoThread& operator=(const ServoThread&) = delete;

    void start(); // once; throws std::system_error where the system has no thread
    void request_stop() noexcept { stop_requested_.store(true, std::memory_order_relaxed); }
    // Waits for the end of the loop and returns what it was like. Valid until destruction.
    const ServoReport& wait();
    bool running() const noexcept { return running_.load(std::memory_order_acquire); }

    // Any thread: no force from the next tick on, while the servo goes on to follow the hand; and, taken back, forces
    // that rise from 0 as after an interruption. Those ticks are recorded as interrupted.
    void withhold_force(bool is_withheld) noexcept { withheld_.store(is_withheld, std::memory_order_relaxed); }
    bool is_force_withheld() const noexcept { return withheld_.load(std::memory_order_relaxed); }
    // So far. Any thread.
    uint64_t missed_deadlines() const noexcept { return missed_deadlines_.load(std::memory_order_relaxed); }

    // Any thread but the servo: another scene in the place of the one that is felt, from the next tick on
    // (Renderer::take_over). Returns why it is refused, or nothing.
    std::string publish(std::shared_ptr<const Scene> scene) { return scenes_.publish(std::move(scene)); }
    // Frees the scenes that were replaced; publish does so too.
    void collect() { scenes_.collect(); }

    // HapticDevice::state of its device. Any thread but the servo's.
    std::string device_state() const { return device_->state(); }

    // For one reader.
    Telemetry& telemetry() noexcept { return telemetry_; }

private:
    friend class ServoTurns;

    void run();
    void begin();
    bool turn(); // a tick of the virtual clock; false: the run is over
    void keep_deadlines();
    void finish();
    bool over(); // its time is, or it was asked to stop
    bool tick(); // false: there was nothing left to live through, as after the end of a recording
    void record(const DevicePose& pose, const TickResult& result, uint64_t compute_ns);
    void end(ServoState state, const std::string& reason);

    std::unique_ptr<HapticDevice> device_;
    ServoOptions options_;
    std::unique_ptr<Renderer> renderer_; // of the servo thread once it runs
    double rate_hz_;
    double periods_wanted_;
    RendererSlot scenes_;
    OverloadPolicy overload_; // of the servo thread
    Telemetry telemetry_;
    ServoReport report_;
    std::atomic<bool> stop_requested_{false};
    std::atomic<bool> running_{false};
    std::atomic<bool> withheld_{false};
    std::atomic<uint64_t> missed_deadlines_{0};
    std::thread thread_;

    // Of the servo thread only.
    glm::dvec3 last_tip_m_{0}, last_force_n_{0};
    glm::dvec3 last_along_{0}, last_torque_n_m_{0}; // of the stylus, the torque about its tip
    double last_length_m_ = 0, last_grip_n_ = 0;    // the same of a gripper
    bool has_last_tip_ = false;
    uint64_t periods_ = 0;                     // gone by, missed deadlines included
    uint64_t periods_since_pose_ = 0;          // of the device; missed deadlines included
    uint64_t woken_ns_ = 0, wake_late_ns_ = 0; // for the tick that runs
    bool interrupted_ = false;                 // the device was not ready since
    double force_squared_sum_ = 0, grip_squared_sum_ = 0;
};

} // namespace haptel::runtime
