// Owners of libusb's handles: each is given back by its destructor.
#pragma once

#include "device/usb/usb_devices.h"

#include <memory>
#include <string>
#include <utility>
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

// Closed by its destructor, unless it is somebody else's.
class UsbFile {
public:
    UsbFile() = default;
    UsbFile(int file_descriptor, bool ours) : file_descriptor_(file_descriptor), ours_(ours) {}
    ~UsbFile();
    UsbFile(UsbFile&& other) noexcept : UsbFile() { swap(other); }
    UsbFile& operator=(UsbFile&& other) noexcept
    {
        swap(other);
        return *this;
    }
    int file_descriptor() const noexcept { return file_descriptor_; }

private:
    void swap(UsbFile& other) noexcept
    {
        std::swap(file_descriptor_, other.file_descriptor_);
        std::swap(ours_, other.ours_);
    }

    int file_descriptor_ = -1;
    bool ours_ = false;
};

// A file for the device of that place. Without one: `code` is the libusb_error.
UsbFile open_usb_file(int bus, int address, int& code);
// The file must outlive the handle. Null: `code` is the libusb_error.
UsbHandle open_usb_handle(libusb_context* context, const UsbFile& file, int& code);
UsbHandle open_usb_handle(libusb_device* device, int& code);
std::string usb_serial(libusb_device_handle* handle); // empty: it has none

} // namespace haptel::device
