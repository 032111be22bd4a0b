// The axes of a wheel or a stick that the kernel drives: forces as often as its drivers send them on, and each effect
// played again before the kernel or the device ends it.
#pragma once

#include "device/axes/axis_port.h"
#include "device/evdev/input_port.h"

namespace haptel::device {

struct EvdevTimes {
    int update_ms = 2;    // between two forces
    int replay_ms = 1000; // between two plays of an effect
};

OpenedAxes evdev_axes(OpenedInput opened, const EvdevTimes& times);

} // namespace haptel::device
