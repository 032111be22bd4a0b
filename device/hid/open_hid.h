// Opens a device of the USB's Physical Interface class by its ids, and what it does not say of itself:
//
//   openffboard[:SERIAL],travel_m=0.4,force_max_n=15
//   hid:VID:PID[:SERIAL],travel_m=0.4,force_max_n=15
#pragma once

#include "device/axes/axis_settings.h"
#include "device/hid/pid_axes.h"
#include "device/usb/usb_devices.h"
#include "runtime/hand/haptic_device.h"

#include <string>
#include <string_view>

namespace haptel::device {

inline constexpr UsbIds openffboard_ids{0x1209, 0xffb0};
inline constexpr int openffboard_interface = 2; // beside a serial port

// Do not wait: the device is not ready until it was nudged.
runtime::DeviceResult open_openffboard(std::string_view variant, const runtime::DeviceRequest& request);
runtime::DeviceResult open_hid(std::string_view variant, const runtime::DeviceRequest& request);

// One that somebody else has opened: the file descriptor stays open, and stays theirs.
runtime::DeviceResult open_hid(const runtime::DeviceRequest& request, int file_descriptor, int interface,
                               const AxisSettings& settings);

// The text is taken apart and nothing is opened.
struct HidText {
    UsbIds ids;
    std::string serial;
    AxisSettings settings;
    std::string error;
};
HidText read_hid_text(std::string_view variant);

UsbList list_openffboards();

} // namespace haptel::device
