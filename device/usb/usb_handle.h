// Owners of libusb's handles: each is given back by its destructor.
#pragma once

#include "device/usb/usb_devices.h"

#include <memory>
#include <string>
#include <vector>

struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

namespace haptel::device {

struct UnrefUsbDevice {
    void operator()(libusb_device* device) const noexcept;
};
using UsbDevicePtr = std::unique_ptr<libusb_device, UnrefUsbDevice>;

struct CloseUsb {
    void operator()(libusb_device_handle* handle) const noexcept;
};
using UsbHandle = std::unique_ptr<libusb_device_handle, CloseUsb>;

std::vector<UsbDevicePtr> usb_devices(libusb_context* context);
UsbIds usb_ids(libusb_device* device) noexcept;

// Null: `code` is the libusb_error.
UsbHandle open_usb_handle(libusb_device* device, int& code);
std::string usb_serial(libusb_device_handle* handle); // empty: it has none
// The file by which this process has opened the device of that place: libusb keeps it to itself. -1: it cannot be
// found.
int usb_file_descriptor(int bus, int address);

} // namespace haptel::device
