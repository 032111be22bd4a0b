// A USB device made of bytes, as a host sees it. FakeTransport stands in front of it, or the real libusb
// (usbfs_shim.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptel::device {

struct UsbSetup {
    uint8_t type = 0, request = 0; // bit 7 of the type: the device sends
    uint16_t value = 0, index = 0;
};

class FakeUsbDevice {
public:
    enum class Answer { fine, nothing, stall, gone }; // nothing: it has nothing to send yet

    virtual ~FakeUsbDevice() = default;
    // `data` goes to the device, or has room for what it sends: `size` bytes.
    virtual Answer control(const UsbSetup& setup, std::span<uint8_t> data, std::size_t& size) = 0;
    virtual Answer out(std::span<const uint8_t> bytes) = 0;
    virtual Answer in(std::span<uint8_t> bytes, std::size_t& size) = 0;
    virtual std::vector<uint8_t> descriptors() const = 0; // of the device (18 bytes), and of its configuration
};

} // namespace haptel::device
