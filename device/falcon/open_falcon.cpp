#include "device/falcon/open_falcon.h"

#include "device/falcon/falcon_firmware.h"
#include "device/servo_silence.h"
#include "device/usb/usb_transport.h"

#include <memory>
#include <string>
#include <utility>

namespace haptel::device {

namespace {

constexpr UsbInterface falcon_interface{0, EndpointKind::bulk};

// Opens it once here, so that an absent device is told of at once and not by waiting.
runtime::DeviceResult falcon_through(const runtime::DeviceRequest& request, OpenTransport open,
                                     const std::filesystem::path& firmware)
{
    FirmwareFile file = read_falcon_firmware(firmware);
    if (!file.error.empty()) return {nullptr, std::move(file.error), {}, runtime::DeviceKey::name};
    OpenedTransport tried = open();
    if (!tried.transport) return {nullptr, "falcon: " + tried.error, {}, runtime::DeviceKey::name};
    tried.transport.reset(); // the driver opens it anew

    FalconOptions options;
    options.firmware = std::move(file.image);
    options.times.watchdog_ms = servo_silence_ms(request.rate_hz);
    return {std::make_unique<FalconDevice>(request.name, std::move(open), std::move(options)),
            {},
            {},
            runtime::DeviceKey::name};
}

} // namespace

runtime::DeviceResult open_falcon(const runtime::DeviceRequest& request, std::string_view serial,
                                  const std::filesystem::path& firmware)
{
    return falcon_through(
        request, [serial = std::string(serial)] { return open_usb(falcon_ids, serial, falcon_interface); }, firmware);
}

runtime::DeviceResult open_falcon(const runtime::DeviceRequest& request, int file_descriptor,
                                  const std::filesystem::path& firmware)
{
    return falcon_through(request, [file_descriptor] { return open_usb(file_descriptor, falcon_interface); }, firmware);
}

UsbList list_falcons()
{
    return list_usb_devices(falcon_ids, falcon_interface.number);
}

} // namespace haptel::device
