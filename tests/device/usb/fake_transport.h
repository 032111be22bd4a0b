// A Transport whose other end is a FakeUsbDevice. `period_ms` passes between two transfers of its stream, so that
// thousands of sessions fit a test.
#pragma once

#include "device/usb/transport.h"
#include "tests/device/usb/fake_usb_device.h"

#include <array>
#include <memory>

namespace haptel::device {

class FakeTransport final : public Transport {
public:
    FakeTransport(FakeUsbDevice& device, int period_ms) : device_(device), period_ms_(period_ms) {}

    Transferred control(const ControlRequest& request, std::span<uint8_t> data, int) override
    {
        std::size_t size = data.size();
        const UsbError failed =
            error(device_.control({request.type, request.request, request.value, request.index}, data, size));
        return {failed, failed == UsbError::none ? size : 0};
    }
    Transferred out(uint8_t, std::span<const uint8_t> bytes, int) override
    {
        const UsbError failed = error(device_.out(bytes));
        return {failed, failed == UsbError::none ? bytes.size() : 0};
    }
    Transferred in(uint8_t, std::span<uint8_t> bytes, int) override
    {
        std::size_t size = 0;
        const UsbError failed = error(device_.in(bytes, size));
        return {failed, size};
    }
    UsbError stream(const StreamSettings& settings, WakeEvent& wake, StreamClient& client) override
    {
        std::array<uint8_t, 64> bytes{};
        for (int failures = 0; client.wants_more() && failures < 16;) {
            const std::size_t size = client.next_out(bytes);
            const UsbError sent = size > 0 ? error(device_.out({bytes.data(), size})) : UsbError::none;
            if (sent != UsbError::none) client.out_failed();
            const Transferred got = in(settings.in_endpoint, bytes, 0);
            if (got.error == UsbError::none) client.received({bytes.data(), got.bytes});
            const UsbError failed = sent != UsbError::none ? sent : got.error;
            if (failed == UsbError::gone) return failed;
            failures = failed == UsbError::none || failed == UsbError::timeout ? 0 : failures + 1;
            wake.wait(period_ms_);
        }
        return client.wants_more() ? UsbError::stall : UsbError::cancelled;
    }

private:
    static UsbError error(FakeUsbDevice::Answer answer)
    {
        switch (answer) {
        case FakeUsbDevice::Answer::fine: return UsbError::none;
        case FakeUsbDevice::Answer::nothing: return UsbError::timeout;
        case FakeUsbDevice::Answer::stall: return UsbError::stall;
        case FakeUsbDevice::Answer::gone: return UsbError::gone;
        }
        return UsbError::failed;
    }

    FakeUsbDevice& device_;
    int period_ms_;
};

} // namespace haptel::device
