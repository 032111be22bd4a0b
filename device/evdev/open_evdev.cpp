#include "device/evdev/open_evdev.h"

#include "device/axes/axis_device.h"
#include "device/evdev/evdev_axes.h"
#include "device/servo_silence.h"

#include <utility>

namespace haptel::device {

AxisText read_evdev_text(std::string_view variant)
{
    AxisText read = read_axis_text(variant, "evdev:FILE");
    if (read.what.empty())
        read.error = "evdev needs a file: evdev:/dev/input/by-id/NAME-event-joystick; `haptel devices` lists those "
                     "that are connected";
    return read;
}

runtime::DeviceResult open_evdev(std::string_view variant, const runtime::DeviceRequest& request)
{
    AxisText read = read_evdev_text(variant);
    if (!read.error.empty()) return {nullptr, std::move(read.error)};
    OpenAxes open = [path = read.what] { return evdev_axes(open_input_port(path), {}); };
    return open_axes(request, std::move(open), read.settings);
}

} // namespace haptel::device
