#include "device/hid/open_hid.h"

#include "device/axes/axis_device.h"
#include "device/usb/usb_transport.h"

#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace haptel::device {

namespace {

runtime::DeviceResult open_by_ids(const UsbIds& ids, std::string serial, int first, const AxisSettings& settings,
                                  const runtime::DeviceRequest& request)
{
    const OpenInterface open = [ids, serial = std::move(serial)](int number) {
        return open_usb(ids, serial, {number, EndpointKind::interrupt});
    };
    return open_axes(request, [open, first] { return open_pid_axes(open, first, {}); }, settings);
}

std::optional<uint16_t> four_digits(std::string_view text)
{
    uint16_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
    if (text.size() != 4 || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

} // namespace

HidText read_hid_text(std::string_view variant)
{
    AxisText read = read_axis_text(variant, "hid:VID:PID");
    HidText hid{{}, "", read.settings, std::move(read.error)};
    const std::string_view what = read.what;
    const auto vendor = four_digits(what.substr(0, 4));
    const auto product = what.size() >= 9 && what[4] == ':' ? four_digits(what.substr(5, 4)) : std::nullopt;
    if (!vendor || !product || (what.size() > 9 && what[9] != ':')) {
        hid.error =
            "hid needs the ids of a USB device, as `lsusb` tells them: hid:1209:ffb0, and a serial number behind "
            "them if there are several: hid:1209:ffb0:SERIAL";
        return hid;
    }
    hid.ids = {*vendor, *product};
    if (what.size() > 9) hid.serial = what.substr(10);
    return hid;
}

runtime::DeviceResult open_openffboard(std::string_view variant, const runtime::DeviceRequest& request)
{
    AxisText read = read_axis_text(variant, "openffboard");
    if (!read.error.empty()) return {nullptr, std::move(read.error)};
    return open_by_ids(openffboard_ids, std::move(read.what), openffboard_interface, read.settings, request);
}

runtime::DeviceResult open_hid(std::string_view variant, const runtime::DeviceRequest& request)
{
    HidText read = read_hid_text(variant);
    if (!read.error.empty()) return {nullptr, std::move(read.error)};
    return open_by_ids(read.ids, std::move(read.serial), 0, read.settings, request);
}

runtime::DeviceResult open_hid(const runtime::DeviceRequest& request, int file_descriptor, int interface,
                               const AxisSettings& settings)
{
    const OpenInterface open = [file_descriptor](int number) {
        return open_usb(file_descriptor, {number, EndpointKind::interrupt});
    };
    return open_axes(request, [open, interface] { return open_pid_axes(open, interface, {}); }, settings);
}

UsbList list_openffboards()
{
    return list_usb_devices(openffboard_ids, openffboard_interface);
}

} // namespace haptel::device
