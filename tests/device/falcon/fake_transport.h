// A FakeFalcon where libusb would be, without a bus: nothing waits but the stream, which takes `period_ms` a turn.
#pragma once

#include "device/falcon/falcon_driver.h"
#include "tests/device/falcon/fake_falcon.h"

#include <memory>

namespace haptel::device {

class FakeTransport final : public Transport {
public:
    FakeTransport(FakeFalcon& falcon, int period_ms) : falcon_(falcon), period_ms_(period_ms) {}

    Transferred control(const ControlRequest& request, std::span<uint8_t>, int) override
    {
        return {error(falcon_.control(request.type, request.request, request.value)), 0};
    }
    Transferred out(uint8_t, std::span<const uint8_t> bytes, int) override
    {
        const UsbError failed = error(falcon_.out(bytes));
        return {failed, failed == UsbError::none ? bytes.size() : 0};
    }
    Transferred in(uint8_t, std::span<uint8_t> bytes, int) override
    {
        std::size_t size = 0;
        const UsbError failed = error(falcon_.in(bytes, size));
        return {failed, size};
    }
    UsbError stream(const StreamSettings&, WakeEvent& wake, StreamClient& client) override
    {
        std::array<uint8_t, 64> bytes{};
        for (int failures = 0; client.wants_more() && failures < 16;) {
            const std::size_t size = client.next_out(bytes);
            const UsbError sent = size > 0 ? error(falcon_.out({bytes.data(), size})) : UsbError::none;
            if (sent != UsbError::none) client.out_failed();
            const Transferred got = in(0x81, bytes, 0);
            if (got.error == UsbError::none) client.received({bytes.data(), got.bytes});
            const UsbError failed = sent != UsbError::none ? sent : got.error;
            if (failed == UsbError::gone) return failed;
            failures = failed == UsbError::none ? 0 : failures + 1;
            wake.wait(period_ms_);
        }
        return client.wants_more() ? UsbError::stall : UsbError::cancelled;
    }

private:
    static UsbError error(FakeFalcon::Answer answer)
    {
        return answer == FakeFalcon::Answer::gone    ? UsbError::gone
               : answer == FakeFalcon::Answer::stall ? UsbError::stall
                                                     : UsbError::none;
    }

    FakeFalcon& falcon_;
    int period_ms_;
};

// Opens it anew whenever asked, while it is plugged in. The fake must outlive the driver.
inline OpenTransport open_fake(FakeFalcon& falcon, int period_ms = 1)
{
    return [&falcon, period_ms]() -> OpenedTransport {
        std::array<uint8_t, 64> none{};
        std::size_t size = 0;
        if (falcon.in(none, size) == FakeFalcon::Answer::gone)
            return {nullptr, UsbError::not_found, "no USB device 0403:cb48 is connected"};
        return {std::make_unique<FakeTransport>(falcon, period_ms), UsbError::none, {}};
    };
}

} // namespace haptel::device
