// Opens a Falcon made of bytes.
#pragma once

#include "device/falcon/falcon_driver.h"
#include "tests/device/falcon/fake_falcon.h"
#include "tests/device/usb/fake_transport.h"

#include <array>
#include <memory>

namespace haptel::device {

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
