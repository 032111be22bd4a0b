// Opens a wheel or a stick by what stands behind "evdev:" - its file, and what the kernel does not know of it:
//
//   evdev:/dev/input/by-id/usb-...-event-joystick,travel_m=0.4,force_max_n=15
#pragma once

#include "device/axes/axis_settings.h"
#include "runtime/hand/haptic_device.h"

#include <string_view>

namespace haptel::device {

// Does not wait: the device is not ready until it was nudged.
runtime::DeviceResult open_evdev(std::string_view variant, const runtime::DeviceRequest& request);

// The text is taken apart and nothing is opened.
AxisText read_evdev_text(std::string_view variant);

} // namespace haptel::device
