#include "device/usb/usb_context.h"

#include <fmt/format.h>
#include <libusb.h>

namespace haptel::device {

namespace {

// LIBUSB_OPTION_NO_DEVICE_DISCOVERY for one context. Before libusb 1.0.27 it could only be set for all contexts made
// later, which would hide devices from those that look for them: so it is set where looking for devices has failed.
int begin_without_discovery(libusb_context*& context)
{
#if LIBUSB_API_VERSION >= 0x0100010A
    libusb_init_option option{};
    option.option = LIBUSB_OPTION_NO_DEVICE_DISCOVERY;
    return libusb_init_context(&context, &option, 1);
#else
    const int code = libusb_init(&context);
    if (code == LIBUSB_SUCCESS) return code;
    libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
    return libusb_init(&context);
#endif
}

} // namespace

void ExitUsb::operator()(libusb_context* context) const noexcept
{
    libusb_exit(context);
}

UsbContext make_usb_context(UsbDiscovery discovery, std::string& error)
{
    libusb_context* context = nullptr;
    const int code = discovery == UsbDiscovery::on ? libusb_init(&context) : begin_without_discovery(context);
    if (code == LIBUSB_SUCCESS) return UsbContext(context);
    error = fmt::format("this system gives no access to USB ({}): is /dev/bus/usb there?", libusb_error_name(code));
    return {};
}

UsbError usb_error(int libusb_code) noexcept
{
    switch (libusb_code) {
    case LIBUSB_SUCCESS: return UsbError::none;
    case LIBUSB_ERROR_TIMEOUT: return UsbError::timeout;
    case LIBUSB_ERROR_PIPE: return UsbError::stall;
    case LIBUSB_ERROR_OVERFLOW: return UsbError::overflow;
    case LIBUSB_ERROR_NO_DEVICE: return UsbError::gone;
    case LIBUSB_ERROR_BUSY: return UsbError::busy;
    case LIBUSB_ERROR_ACCESS: return UsbError::denied;
    case LIBUSB_ERROR_NOT_FOUND: return UsbError::not_found;
    default: return UsbError::failed;
    }
}

const char* words_of(UsbError error) noexcept
{
    switch (error) {
    case UsbError::none: return "no error";
    case UsbError::timeout: return "no answer in time";
    case UsbError::stall: return "the device refused the request";
    case UsbError::overflow: return "the device sent more than was asked for";
    case UsbError::gone: return "the device was unplugged";
    case UsbError::busy: return "another program uses the device";
    case UsbError::denied: return "no permission to open the device";
    case UsbError::not_found: return "no such device";
    case UsbError::cancelled: return "ended on request";
    case UsbError::failed: return "the transfer failed";
    }
    return "";
}

} // namespace haptel::device
