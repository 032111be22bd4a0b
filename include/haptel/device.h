// Haptic devices: those that Haptel drives, by name, and your own.
#pragma once

#include <haptel/mesh.h>

#include <memory>
#include <string>

namespace haptel {

// World frame: x to the right, y away from the user, z up.
struct Pose {
    Vec3 tip_m = {};
    Vec3 tail_m = {}; // the other end of a stylus, the other finger of a gripper; else not read
};

enum class DeviceState {
    ok,
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
    double speed_m_per_s = 0.1;
    double press_n = 1;
};

// A device that a servo opens for the scene that is felt with it.
class HAPTEL_API DeviceSource {
public:
    struct Implementation;
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
HAPTEL_API DeviceSource own_device(std::unique_ptr<Device> device);

} // namespace haptel
