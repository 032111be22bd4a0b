// Opens a Haply Inverse3 by what stands behind "inverse3:", its id; nothing: the first that the service names. The
// service is on this machine, or where the environment says: HAPTEL_INVERSE3_SERVICE=HOST:PORT.
#pragma once

#include "device/inverse3/inverse3_device.h"
#include "runtime/hand/haptic_device.h"

#include <string>
#include <string_view>
#include <vector>

namespace haptel::device {

// Asks the service once, for a second at most. An error if it is not there or has no such device.
runtime::DeviceResult open_inverse3(std::string_view id, const runtime::DeviceRequest& request);

struct Inverse3List {
    std::vector<std::string> ids;
    std::string at;    // of the service
    std::string error; // what answers is no such service; or none does where the environment says that there is one
};
// Within 0.3 s. None, and no error, where no service is told of and none answers.
Inverse3List list_inverse3s();

} // namespace haptel::device
