#include "device/usb/usb_transport.h"

#include "device/guard/force_guard.h"
#include "device/usb/usb_context.h"
#include "device/usb/usb_handle.h"
#include "device/usb/usb_stream.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <libusb.h>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace haptel::device {

namespace {

OpenedTransport not_opened(UsbError code, std::string why)
{
    return {nullptr, code, std::move(why)};
}

class UsbTransport final : public Transport {
public:
    UsbTransport(UsbContext context, UsbHandle handle, int file_descriptor, const UsbInterface& interface)
        : context_(std::move(context))
        , handle_(std::move(handle))
        , file_descriptor_(file_descriptor)
        , interface_(interface)
    {
    }
    ~UsbTransport() override { libusb_release_interface(handle_.get(), interface_.number); }

    Transferred control(const ControlRequest& request, std::span<uint8_t> data, int timeout_ms) override
    {
        const int code =
            libusb_control_transfer(handle_.get(), request.type, request.request, request.value, request.index,
                                    data.data(), static_cast<uint16_t>(data.size()), limited(timeout_ms));
        if (code < 0) return {usb_error(code), 0};
        return {UsbError::none, static_cast<std::size_t>(code)};
    }

    Transferred out(uint8_t endpoint, std::span<const uint8_t> bytes, int timeout_ms) override
    {
        // libusb takes one kind of pointer for both directions, and only reads here.
        return transfer(endpoint, const_cast<uint8_t*>(bytes.data()), bytes.size(), timeout_ms);
    }

    Transferred in(uint8_t endpoint, std::span<uint8_t> bytes, int timeout_ms) override
    {
        return transfer(endpoint, bytes.data(), bytes.size(), timeout_ms);
    }

    UsbError stream(const StreamSettings& settings, WakeEvent& wake, StreamClient& client) override
    {
        std::array<uint8_t, 64> word{};
        const std::size_t size = std::min(client.last_word(word), word.size());
        ForceGuard guard(file_descriptor_, settings.out_endpoint, {word.data(), size});
        UsbStream running(context_.get(), handle_.get(), interface_.kind == EndpointKind::interrupt, settings, client);
        return running.run(wake, guard);
    }

private:
    // To libusb 0 means for ever.
    static unsigned limited(int timeout_ms) { return static_cast<unsigned>(std::max(timeout_ms, 1)); }

    Transferred transfer(uint8_t endpoint, uint8_t* bytes, std::size_t size, int timeout_ms)
    {
        const auto transfer_now =
            interface_.kind == EndpointKind::interrupt ? libusb_interrupt_transfer : libusb_bulk_transfer;
        const auto wanted = static_cast<int>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
        int done = 0;
        const int code = transfer_now(handle_.get(), endpoint, bytes, wanted, &done, limited(timeout_ms));
        return {usb_error(code), static_cast<std::size_t>(std::max(done, 0))};
    }

    UsbContext context_;
    UsbHandle handle_;
    int file_descriptor_; // the handle's or the caller's; -1: not known
    UsbInterface interface_;
};

// Takes the interface. A message if that fails.
std::string claim(libusb_device_handle* handle, const UsbInterface& interface, UsbError& error)
{
    libusb_set_auto_detach_kernel_driver(handle, 1); // not supported everywhere: then claiming tells
    const int code = libusb_claim_interface(handle, interface.number);
    error = usb_error(code);
    libusb_device* device = libusb_get_device(handle);
    if (code == LIBUSB_SUCCESS) return {};
    return usb_open_failure(code, usb_ids(device), libusb_get_bus_number(device), libusb_get_device_address(device))
        .text();
}

// `others`: serial numbers of those that are connected.
OpenedTransport not_connected(const UsbIds& ids, std::string_view serial, std::vector<std::string> others)
{
    std::ranges::sort(others);
    std::string why = fmt::format("no USB device {:04x}:{:04x}{} is connected", ids.vendor, ids.product,
                                  serial.empty() ? "" : fmt::format(" with the serial number '{}'", serial));
    why += others.empty() ? ": plug it in and switch it on" : fmt::format(": there are {}", fmt::join(others, ", "));
    return not_opened(UsbError::not_found, std::move(why));
}

// Without a transport if `device` is another one, whose serial number goes to `others`, or cannot be had: `refused`
// says why.
std::unique_ptr<Transport> open_and_claim(libusb_device* device, std::string_view serial, const UsbInterface& interface,
                                          UsbContext& context, OpenedTransport& refused,
                                          std::vector<std::string>& others)
{
    int code = LIBUSB_SUCCESS;
    const int bus = libusb_get_bus_number(device), address = libusb_get_device_address(device);
    UsbHandle handle = open_usb_handle(device, code);
    if (!handle) {
        refused = not_opened(usb_error(code), usb_open_failure(code, usb_ids(device), bus, address).text());
        return {};
    }
    if (std::string its = usb_serial(handle.get()); !serial.empty() && its != serial) {
        others.push_back(its.empty() ? "one without" : "'" + its + "'");
        return {};
    }
    refused.error = claim(handle.get(), interface, refused.code);
    if (!refused.error.empty()) return {};
    return std::make_unique<UsbTransport>(std::move(context), std::move(handle), usb_file_descriptor(bus, address),
                                          interface);
}

} // namespace

OpenedTransport open_usb(const UsbIds& ids, std::string_view serial, const UsbInterface& interface)
{
    std::string error;
    UsbContext context = make_usb_context(UsbDiscovery::on, error);
    if (!context) return not_opened(UsbError::failed, std::move(error));
    OpenedTransport refused;
    std::vector<std::string> others;
    const auto devices = usb_devices(context.get());
    for (const UsbDevicePtr& device : devices) {
        if (usb_ids(device.get()) != ids) continue;
        if (auto transport = open_and_claim(device.get(), serial, interface, context, refused, others))
            return {std::move(transport), UsbError::none, {}};
    }
    return refused.error.empty() ? not_connected(ids, serial, std::move(others)) : std::move(refused);
}

OpenedTransport open_usb(int file_descriptor, const UsbInterface& interface)
{
    std::string error;
    UsbContext context = make_usb_context(UsbDiscovery::off, error);
    if (!context) return not_opened(UsbError::failed, std::move(error));
    libusb_device_handle* handle = nullptr;
    const int code = libusb_wrap_sys_device(context.get(), static_cast<intptr_t>(file_descriptor), &handle);
    if (code != LIBUSB_SUCCESS)
        return not_opened(usb_error(code), fmt::format("file descriptor {} is no USB device that can be used ({})",
                                                       file_descriptor, libusb_error_name(code)));
    UsbHandle owned(handle);
    UsbError refused = UsbError::none;
    std::string why = claim(handle, interface, refused);
    if (!why.empty()) return not_opened(refused, std::move(why));
    return {std::make_unique<UsbTransport>(std::move(context), std::move(owned), file_descriptor, interface),
            UsbError::none,
            {}};
}

} // namespace haptel::device
