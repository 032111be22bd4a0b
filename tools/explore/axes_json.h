// Which axes a device senses and pushes, as every command tells it.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "tools/output/json.h"

namespace haptel::tools {

// {"sensed": ["x"], "pushed": ["x"]}
Json axes_json(const runtime::DeviceAxes& axes);

} // namespace haptel::tools
