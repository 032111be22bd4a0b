// A Transport over libusb.
#pragma once

#include "device/usb/transport.h"
#include "device/usb/usb_devices.h"

#include <string_view>

namespace haptel::device {

enum class EndpointKind : uint8_t { bulk, interrupt };

struct UsbInterface {
    int number = 0;
    EndpointKind kind = EndpointKind::bulk; // of the endpoints that the driver uses
};

// The connected device of these ids and this serial number, or the first that can be opened if none is given. Takes it
// from a kernel driver, which has it back afterwards.
OpenedTransport open_usb(const UsbIds& ids, std::string_view serial, const UsbInterface& interface);

// A device that somebody else has opened and keeps open: an Android activity, a sandbox, a test. On Linux this is the
// file descriptor of a node in /dev/bus/usb.
OpenedTransport open_usb(int file_descriptor, const UsbInterface& interface);

} // namespace haptel::device
