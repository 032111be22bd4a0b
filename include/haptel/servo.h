// The loop between a device and a hand, on a thread of its own, a tick per period of the scene's rate.
#pragma once

#include <haptel/device.h>
#include <haptel/scene.h>

#include <cstdint>
#include <memory>
#include <string>

namespace haptel {

// How a servo runs.
struct ServoOptions {
    double seconds = 0;        // >= 0; then it ends; 0: when it is asked to, or its device is at an end
    bool virtual_time = false; // as fast as it can, the same forces in every run: for simulated devices and your own
    // Asks the system for real-time priority, and to keep all memory of this program in place.
    bool ask_for_real_time = true;
};

// What a run was like.
struct Report {
    bool faulted = false;                    // the scene was refused, the device failed, or the processor was too slow
    std::string stop_reason;                 // in words
    bool real_time = false;                  // the system gave the thread priority and locked memory
    double seconds = 0;                      // periods that went by, missed ones included, times the period
    uint64_t ticks = 0;                      // rounds of the loop
    uint64_t contact_ticks = 0;              // of these with something touched
    uint64_t missed_deadlines = 0;           // periods in which no force was sent because the tick before was late
    uint64_t faults = 0;                     // ticks with a fault of texture, pose or force
    uint64_t textures_changed = 0;           // while it was felt, by values and files
    double force_rms_n = 0, force_max_n = 0; // as sent, over all ticks: root mean square, largest
    double energy_j = 0;                     // that the forces gave to the hand
    double tick_ns_median = 0, tick_ns_p99 = 0;           // from pose to force; 0 where there was no tick
    double wake_late_us_median = 0, wake_late_us_p99 = 0; // how late the system woke the thread
};

// One device that feels a scene. Of several hands each has its own.
class HAPTEL_API Servo {
public:
    // Opens the device. Where that fails messages() says why, and nothing runs.
    Servo(const Scene& scene, DeviceSource device, const ServoOptions& options = {});
    ~Servo(); // ends the run
    Servo(Servo&&) noexcept;
    Servo& operator=(Servo&&) noexcept;

    explicit operator bool() const;      // false: messages() says why
    const std::string& messages() const; // warnings beside a device, too

    void start();         // once
    void request_stop();  // does not wait; any thread
    bool running() const; // from start until its end, whatever ended it
    Report wait();        // for the end

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace haptel
