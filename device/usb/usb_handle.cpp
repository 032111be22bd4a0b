#include "device/usb/usb_handle.h"

#include <array>
#include <libusb.h>

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

} // namespace haptel::device
