// Opens a device by its name, as written in a scene or after --device:
//
//   simulated[:PRESET[:HAND]]   simulated:premium:firm is the default
//   replay:FILE                 a recording of `haptel record`, or a trace.csv
//   falcon[:SERIAL]             a Novint Falcon on the USB
//   inverse3[:DEVICE_ID]        a Haply Inverse3, through the service of its maker
//   openffboard[:SERIAL]        an OpenFFBoard on the USB
//   hid:VID:PID[:SERIAL]        another wheel or stick on the USB that keeps to the class PID
//   evdev:FILE                  a wheel or a stick with force feedback, through the kernel
#pragma once

#include "device/refusal.h"
#include "runtime/hand/haptic_device.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::device {

// Fits runtime::DeviceFactory. Errors are in words and name what there is instead.
runtime::DeviceResult open_device(const runtime::DeviceRequest& request);

// Names for help and lists: "simulated:premium", ..., "replay:FILE".
std::vector<std::string> device_names();

struct SupportedDevice {
    std::string name; // as for open_device; what may be left out in brackets
    std::string what; // one line
};
std::vector<SupportedDevice> supported_devices();

enum class DeviceState : uint8_t {
    ready,
    absent,  // none of its kind is connected
    refused, // it is there and cannot be opened
    faulty,  // its kind cannot be looked for
};

struct ListedDevice {
    std::string name; // that open_device opens it by
    std::string_view kind, transport;
    std::string what, at;
    DeviceState state = DeviceState::ready;
    Refusal refused;                         // unless it is ready
    std::optional<runtime::DeviceAxes> axes; // as far as known without opening it
    double force_max_n = 0, rate_hz = 0;     // what it can do; 0: not known without opening it
};
// All that is connected, the simulated devices, and a line for each kind of which none is there.
std::vector<ListedDevice> listed_devices();

} // namespace haptel::device
