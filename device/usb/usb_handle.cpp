#include "device/usb/usb_handle.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <fmt/format.h>
#include <libusb.h>
#include <unistd.h>

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

UsbFile::~UsbFile()
{
    if (ours_) close(file_descriptor_);
}

UsbFile open_usb_file(int bus, int address, int& code)
{
    const int file_descriptor = open(fmt::format("/dev/bus/usb/{:03}/{:03}", bus, address).c_str(), O_RDWR | O_CLOEXEC);
    code = file_descriptor >= 0                 ? LIBUSB_SUCCESS
           : errno == EACCES || errno == EPERM  ? LIBUSB_ERROR_ACCESS
           : errno == ENOENT || errno == ENODEV ? LIBUSB_ERROR_NO_DEVICE
           : errno == ENOMEM                    ? LIBUSB_ERROR_NO_MEM
                                                : LIBUSB_ERROR_IO;
    return {file_descriptor, file_descriptor >= 0};
}

UsbHandle open_usb_handle(libusb_context* context, const UsbFile& file, int& code)
{
    libusb_device_handle* handle = nullptr;
    code = libusb_wrap_sys_device(context, static_cast<intptr_t>(file.file_descriptor()), &handle);
    return UsbHandle(code == LIBUSB_SUCCESS ? handle : nullptr);
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

} // namespace haptel::device
