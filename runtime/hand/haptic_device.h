// The device as the servo loop sees it. The runtime owns this interface because it is its user; device/ implements it.
// A simulated, a replayed and a USB device are drivers of equal rank.
#pragma once

#include "runtime/hand/degradation.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace haptel::runtime {

// Where the hand holds the probe: world frame, metres.
struct DevicePose {
    glm::dvec3 tip_m{0};  // haptic interface point
    glm::dvec3 tail_m{0}; // other end of the stylus; equals tip_m for devices that report no orientation
    // Whole periods that the hand has lived since the pose before. 0: as many as went by on the servo's clock, which is
    // right for a hand of flesh. A simulated hand lives one per read; a replayed one says what was recorded.
    uint64_t periods = 0;
    // No force was on the hand since the pose before: it must not come back at once.
    bool interrupted = false;
    // What is left out of this tick, at least. A recorded hand says what was then; the servo adds what it leaves out.
    Degradation degradation = Degradation::none;
    // From the sending of a force to the arrival of this pose, which answers it. 0: not known, or told before.
    int64_t link_ns = 0;
};

// Along x, y and z of the device's frame. What a device does not sense or push is left to FewerAxes.
struct DeviceAxes {
    glm::bvec3 senses{true}, pushes{true};

    bool all() const { return glm::all(senses) && glm::all(pushes); }
};

struct DeviceInfo {
    std::string name;                 // as given in the scene: "simulated:premium"
    double force_max_n = 0;           // what the motors can hold for a moment
    double stiffness_max_n_per_m = 0; // recommended at 1 kHz; 0: unknown
    double workspace_radius_m = 0;    // 0: unbounded
    double press_n = 0;               // with which a simulated hand presses; 0: another hand, not known
    double position_resolution_m = 0; // the step of its position sensors; 0: not known
    DeviceAxes axes = {};
    bool slopes_only = false; // it feels no heights: the force model is `lateral`, whatever the scene says
};

enum class DeviceStatus : uint8_t {
    ok,
    finished,  // a replay at its end, a stroke that is over: stop without alarm
    not_ready, // homing, connecting: no pose yet, force must be zero
    disconnected,
    fault,
};

// read and write are called once per tick by the servo thread only. They allocate, lock, throw and log nothing.
class HapticDevice {
public:
    virtual ~HapticDevice() = default;
    virtual const DeviceInfo& info() const = 0;
    virtual DeviceStatus read(DevicePose& pose) noexcept = 0;
    // Force (N) and torque about the grip of a stylus (N m; ProbeSettings::grip_m) on the hand, world frame, held until
    // the next write.
    virtual DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept = 0;
    // Before write, of a gripper alone: how hard its fingers are to be pushed apart, N. For devices with such a motor.
    virtual void write_grip(double /*grip_force_n*/) noexcept {}
    // In words, what it does or why it has no pose; empty: nothing to tell. Any thread but the servo's.
    virtual std::string state() const { return {}; }
    // Zero force, motors off. Safe to call at any time, from the destructor too.
    virtual void stop() noexcept = 0;
};

// The surface as a simulated hand looks for it: first hit of a line along -z.
struct SurfaceHit {
    glm::dvec3 point_m{0};
    glm::dvec3 facet_normal{0, 0, 1};
};

// First hit from +z at (x, y), or nothing. Allocates nothing.
using SurfaceBelow = std::function<std::optional<SurfaceHit>(double x_m, double y_m)>;

// All that a driver may need to know of the scene it is opened for.
struct DeviceRequest {
    std::string name;   // "simulated:premium", "replay:FILE" (path resolved), "falcon"
    std::string stroke; // "circles" | "scan" | "press" | "random"
    double speed_m_per_s = 0.1;
    double press_n = 1.0;
    uint64_t seed = 1;
    double rate_hz = 1000;
    bool exact_positions = false;                  // of a simulated device: not rounded to the steps of its sensors
    double stylus_length_m = 0;                    // or from finger to finger of a gripper; 0: point probe
    bool gripper = false;                          // what has that length has fingers at its ends
    glm::dvec3 box_minimum_m{0}, box_maximum_m{0}; // of the object that the stroke explores, world frame
    SurfaceBelow surface_below;                    // may be called from read()
};

// What of a request a driver speaks of, so that its words stand where that is written.
enum class DeviceKey : uint8_t { device, name, stroke, speed, press, stylus_length };

struct DeviceResult {
    std::unique_ptr<HapticDevice> device; // null: see error
    std::string error;
    std::string warning = {}; // beside a device: what the user should know of it, in words
    DeviceKey about = DeviceKey::name;
};

using DeviceFactory = std::function<DeviceResult(const DeviceRequest&)>;

} // namespace haptel::runtime
