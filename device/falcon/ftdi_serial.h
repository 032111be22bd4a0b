// The USB serial converter in front of the Falcon's processor, as bring-up uses it: requests, bytes out, bytes in.
#pragma once

#include "device/usb/transport.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptel::device {

// Each packet that comes in begins with two bytes about the converter itself.
inline constexpr std::size_t ftdi_packet_bytes = 64, ftdi_status_bytes = 2;

// Calls `take` for each byte of one IN transfer that is no status.
template <typename Take>
void for_each_ftdi_byte(std::span<const uint8_t> transfer, Take take)
{
    for (std::size_t i = 0; i < transfer.size(); ++i)
        if (i % ftdi_packet_bytes >= ftdi_status_bytes) take(transfer[i]);
}

enum class FtdiRequest : uint8_t { reset = 0, modem = 1, flow = 2, baud_divisor = 3, line = 4, latency_ms = 9 };

// The first error is kept, and nothing is sent after it: a sequence of steps is checked once, at its end.
class FtdiSerial {
public:
    FtdiSerial(Transport& transport, int timeout_ms) : transport_(transport), timeout_ms_(timeout_ms) {}

    void request(FtdiRequest request, uint16_t value);
    void purge(); // forgets what was received and what is still to be sent
    void write(std::span<const uint8_t> bytes);
    // What one IN transfer brings, without status; empty if nothing came in time. Valid until the next call.
    std::span<const uint8_t> read();

    UsbError error() const { return error_; }
    bool good() const { return error_ == UsbError::none; }

private:
    Transport& transport_;
    int timeout_ms_;
    UsbError error_ = UsbError::none;
    std::array<uint8_t, ftdi_packet_bytes> received_{}, payload_{};
};

} // namespace haptel::device
