// A libusb context of one's own, closed with its owner. Names of libusb stay in this folder.
#pragma once

#include "device/usb/transport.h"

#include <memory>
#include <string>

struct libusb_context;

namespace haptel::device {

struct ExitUsb {
    void operator()(libusb_context* context) const noexcept;
};
using UsbContext = std::unique_ptr<libusb_context, ExitUsb>;

// Whether libusb looks for devices. Where it need not, an open file descriptor is enough, on systems without USB too.
enum class UsbDiscovery : uint8_t { on, off };

// Null: `error` says why.
UsbContext make_usb_context(UsbDiscovery discovery, std::string& error);

// Of a libusb_error.
UsbError usb_error(int libusb_code) noexcept;

} // namespace haptel::device
