#include "device/usb/usb_handle.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <libusb.h>
#include <sys/stat.h>
#include <system_error>

namespace haptel::device {

void UnrefUsbDevice::operator()(libusb_device* device) const noexcept
{
    libusb_unref_device(device);
}

void CloseUsb::operator()(libusb_device_handle* handle) const noexcept
{
    libusb_close(handle);
}

std::vector<UsbDevicePtr> usb_devices(libusb_context* context)
{
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context, &list);
    std::vector<UsbDevicePtr> devices;
    for (decltype(libusb_get_device_list(context, &list)) i = 0; i < count; ++i) devices.emplace_back(list[i]);
    if (list) libusb_free_device_list(list, 0); // the references are ours now
    return devices;
}

UsbIds usb_ids(libusb_device* device) noexcept
{
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(device, &descriptor) != LIBUSB_SUCCESS) return {};
    return {descriptor.idVendor, descriptor.idProduct};
}

UsbHandle open_usb_handle(libusb_device* device, int& code)
{
    libusb_device_handle* handle = nullptr;
    code = libusb_open(device, &handle);
    return UsbHandle(code == LIBUSB_SUCCESS ? handle : nullptr);
}

std::string usb_serial(libusb_device_handle* handle)
{
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(libusb_get_device(handle), &descriptor) != LIBUSB_SUCCESS) return {};
    if (descriptor.iSerialNumber == 0) return {};
    std::array<unsigned char, 256> text{};
    const int size = libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber, text.data(),
                                                        static_cast<int>(text.size()));
    return size > 0 ? std::string(text.begin(), text.begin() + size) : std::string();
}

int usb_file_descriptor(int bus, int address)
{
    struct stat node{}, open{};
    if (stat(fmt::format("/dev/bus/usb/{:03}/{:03}", bus, address).c_str(), &node) != 0) return -1;
    int newest = -1; // of several the one opened last, mostly
    std::error_code none;
    for (std::filesystem::directory_iterator file("/proc/self/fd", none), end; file != end; file.increment(none)) {
        const std::string name = file->path().filename();
        int number = -1;
        std::from_chars(name.data(), name.data() + name.size(), number);
        if (fstat(number, &open) == 0 && open.st_dev == node.st_dev && open.st_ino == node.st_ino)
            newest = std::max(newest, number);
    }
    return newest;
}

} // namespace haptel::device
