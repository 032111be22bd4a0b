// Opens a device by its name, as written in a scene or after --device:
//
//   simulated[:PRESET[:HAND]]   simulated:premium:firm is the default
//   replay:FILE                 a trace.csv
//   falcon[:SERIAL]             a Novint Falcon on the USB
#pragma once

#include "runtime/hand/haptic_device.h"

#include <string>
#include <vector>

namespace haptel::device {

// Fits runtime::DeviceFactory. Errors are in words and name what there is instead.
runtime::DeviceResult open_device(const runtime::DeviceRequest& request);

// Names for help and lists: "simulated:premium", ..., "replay:FILE".
std::vector<std::string> device_names();

} // namespace haptel::device
