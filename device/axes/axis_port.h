// A device of one axis or two that can be pushed, whatever it is connected by: a file of the kernel's, USB, a device in
// memory in tests. Its driver (axis_driver.h) says how hard, the port carries that over as often as its link can.
#pragma once

#include "device/usb/wake_event.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace haptel::device {

inline constexpr std::size_t axes_max = 2; // x and y

// In counts of the sensor.
struct AxisRange {
    int64_t minimum = 0, maximum = 0;
    std::optional<int64_t> value = {}; // nothing: it has not said yet
};

// Constant forces along the axes, each -1 .. 1 of what the device can do, in the sense of its motors.
using AxisLevels = std::array<double, axes_max>;

// The driver's side. All calls come from the thread that serves the port.
class AxisClient {
public:
    virtual ~AxisClient() = default;
    virtual void moved(int axis, int64_t value) noexcept = 0;
    // That the motors should have now. Asked at least every few milliseconds.
    virtual AxisLevels levels() noexcept = 0;
    virtual bool wants_more() noexcept = 0;
    virtual void was_silenced() noexcept = 0; // the force was taken away, for this thread stood still
};

class AxisPort {
public:
    virtual ~AxisPort() = default;                               // no force afterwards
    virtual std::optional<AxisRange> axis(int number) const = 0; // 0: x, 1: y. Nothing: it has no such axis
    // Makes the device ready and serves it until the client wants no more (empty) or it fails (why, in words). The
    // motors are told to have no force before this comes back. `wake`: other levels may be wanted now.
    virtual std::string serve(WakeEvent& wake, AxisClient& client) = 0;
};

struct OpenedAxes {
    std::unique_ptr<AxisPort> port; // null: see error
    std::string error;              // in words, with what to do about it
    bool absent = false;            // it may come back
};

// How many axes in a row, x first, can be pushed along.
inline int axis_count(const AxisPort& port)
{
    return !port.axis(0) ? 0 : port.axis(1) ? 2 : 1;
}

} // namespace haptel::device
