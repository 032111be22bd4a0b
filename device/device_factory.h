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

#include "runtime/hand/haptic_device.h"

#include <string>
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

struct ConnectedDevice {
    std::string name; // that open_device opens it by
    std::string what, at;
    std::string refused; // why it cannot be opened, and what to do about it; empty: it can
};

struct ConnectedDevices {
    std::vector<ConnectedDevice> devices;
    std::vector<std::string> errors; // what could not be looked for, and why
};
ConnectedDevices connected_devices();

} // namespace haptel::device
