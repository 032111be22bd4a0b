// Haptic devices: those that Haptel drives, by name, and your own.
#pragma once

#include <haptel/mesh.h>

#include <memory>
#include <string>

namespace haptel {

// World frame: x to the right, y away from the user, z up.
struct Pose {
    Vec3 tip_m = {};  // where the hand touches
    Vec3 tail_m = {}; // the other end of a stylus, the other finger of a gripper; else not read
};

// What a device has come to.
enum class DeviceState {
    ok,           // it has a pose and takes forces
    finished,     // nothing more comes: the run ends without alarm
    not_ready,    // no pose for now, as while it reconnects: no force is sent, and the run goes on
    disconnected, // for good: the run ends
    failed,       // likewise
};

// A device of your own. read, write and write_grip are called in each tick, and once more at the end, by the servo's
// thread alone: they may not allocate, lock, wait or throw.
class HAPTEL_API Device {
public:
    virtual ~Device() = default;
    // Where the hand is; where it is not ok, the pose is not used.
    virtual DeviceState read(Pose& pose) noexcept = 0;
    // On the hand, held until the next call. The torque is about the grip of a stylus.
    virtual DeviceState write(const Vec3& force_n, const Vec3& torque_n_m) noexcept = 0;
    // Of a gripper alone, before write: how hard its fingers are to be pushed apart.
    virtual void write_grip(double /*grip_force_n*/) noexcept {}
    virtual void stop() noexcept = 0;                // no force, motors off; at any time
    virtual double force_max_n() const { return 0; } // 0: not known, the scene's limit alone holds
};

// What a simulated hand does; others ignore it.
struct Stroke {
    std::string name = "circles"; // "scan", "circles", "press", "random"
    double speed_m_per_s = 0.1;   // > 0, along the surface
    double press_n = 1;           // how hard it presses
};

// A device that a servo opens for the scene that is felt with it.
class HAPTEL_API DeviceSource {
public:
    struct Implementation;
    // By open_device and own_device.
    explicit DeviceSource(std::unique_ptr<Implementation> implementation);
    ~DeviceSource();
    DeviceSource(DeviceSource&&) noexcept;
    DeviceSource& operator=(DeviceSource&&) noexcept;
    std::unique_ptr<Implementation> take(); // by the servo, once

private:
    std::unique_ptr<Implementation> implementation_;
};

// "simulated:premium", "falcon", "inverse3", "evdev:FILE", ...: `haptel devices` lists them all.
HAPTEL_API DeviceSource open_device(std::string name, Stroke stroke = {});
// A device of your own, which the servo then owns.
HAPTEL_API DeviceSource own_device(std::unique_ptr<Device> device);

} // namespace haptel
