// What stands behind a DeviceSource.
#pragma once

#include "runtime/hand/haptic_device.h"

#include <haptel/device.h>

#include <memory>
#include <string>

namespace haptel {

struct DeviceSource::Implementation {
    std::string name;            // one of Haptel's
    Stroke stroke;               //
    std::unique_ptr<Device> own; // or the program's own
};

runtime::DeviceResult open(DeviceSource::Implementation& source, const runtime::DeviceRequest& request); // once

} // namespace haptel
