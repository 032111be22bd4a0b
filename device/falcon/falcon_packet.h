// The packets that a Falcon and its host exchange: 16 bytes each way, one reply for each packet sent.
//
//   '<'  three 16-bit numbers, four bytes each  flags  'A'  '>'
//
// A number is two's complement, written as four nibbles, the lowest first, each as 0x41 + nibble.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace haptel::device {

inline constexpr std::size_t falcon_packet_bytes = 16;
using FalconPacketBytes = std::array<uint8_t, falcon_packet_bytes>;
using FalconCounts = std::array<int16_t, 3>; // of the arms: top, right, left as seen from the front

// Flags to the device. The colours are those of its ring of lights.
inline constexpr uint8_t falcon_homing = 0x01, falcon_green = 0x02, falcon_blue = 0x04, falcon_red = 0x08;

struct FalconCommand {
    FalconCounts motors{}; // -4095 .. 4095
    uint8_t flags = 0;     // below 0x80
};

struct FalconReply {
    FalconCounts encoders{};
    uint8_t buttons = 0; // 1 plus, 2 forward, 4 centre, 8 minus
    uint8_t homed = 0;   // bit i: arm i knows where it is

    bool all_homed() const { return homed == 7; }
};

FalconPacketBytes encode(const FalconCommand& command);

// Finds replies in a stream of bytes that may begin anywhere, lack some or hold others. Delimiters never occur inside
// of a packet, so a packet that is broken ends at the byte that breaks it, and the next begins at the next '<'.
class FalconReplyReader {
public:
    // The reply that ends with this byte.
    std::optional<FalconReply> add(uint8_t byte);
    void reset() { size_ = 0; }

    uint64_t malformed() const { return malformed_; } // packets that began and were broken
    uint64_t strays() const { return strays_; }       // bytes outside of any packet

private:
    FalconPacketBytes bytes_{};
    std::size_t size_ = 0;
    uint64_t malformed_ = 0, strays_ = 0;
};

} // namespace haptel::device
