// The stream of a UsbTransport: IN transfers that always wait for data, one OUT transfer at a time, and the loop that
// serves them.
#pragma once

#include "device/guard/force_guard.h"
#include "device/usb/transport.h"

#include <memory>
#include <vector>

struct libusb_context;
struct libusb_device_handle;
struct libusb_transfer;

namespace haptel::device {

class UsbStream {
public:
    UsbStream(libusb_context* context, libusb_device_handle* handle, bool interrupt_endpoints,
              const StreamSettings& settings, StreamClient& client);
    ~UsbStream();
    UsbStream(const UsbStream&) = delete;
    UsbStream& operator=(const UsbStream&) = delete;

    // Until the client wants no more or the device fails; once. All transfers have come back then, or, if the system
    // keeps them for longer than a quarter of a second, are left to it.
    UsbError run(WakeEvent& wake, ForceGuard& guard);

private:
    struct Slot; // one transfer and its bytes

    void post_in(Slot& slot) noexcept;
    void offer_out() noexcept;
    void finished_in(Slot& slot) noexcept;
    void finished_out(Slot& slot) noexcept;
    void failed(UsbError error) noexcept; // ends the stream if the device is gone or fails again and again
    bool any_in_flight() const noexcept;
    void cancel_all() noexcept;

    libusb_context* context_;
    StreamSettings settings_;
    StreamClient& client_;
    std::vector<std::unique_ptr<Slot>> in_;
    std::unique_ptr<Slot> out_;
    UsbError ended_ = UsbError::none;
    int failures_in_a_row_ = 0;
    bool ending_ = false;
};

} // namespace haptel::device
