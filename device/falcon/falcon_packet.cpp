#include "device/falcon/falcon_packet.h"

namespace haptel::device {

namespace {

constexpr uint8_t first_byte = '<', last_byte = '>', zero_byte = 0x41;
constexpr std::size_t flags_at = 13, unknown_at = 14, last_at = 15;

// Whether this byte may stand there, between the delimiters.
bool fits(uint8_t byte, std::size_t at)
{
    if (at == last_at) return byte == last_byte;
    return byte >= zero_byte && byte < zero_byte + (at < flags_at ? 0x10 : 0x80);
}

int16_t number_at(const FalconPacketBytes& bytes, std::size_t at)
{
    unsigned value = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) value |= unsigned(bytes[at + nibble] - zero_byte) << 4 * nibble;
    return static_cast<int16_t>(static_cast<uint16_t>(value));
}

} // namespace

FalconPacketBytes encode(const FalconCommand& command)
{
    FalconPacketBytes bytes{};
    bytes[0] = first_byte;
    for (std::size_t i = 1; i < flags_at; ++i) {
        const auto value = static_cast<uint16_t>(command.motors[(i - 1) / 4]);
        bytes[i] = static_cast<uint8_t>(zero_byte + ((value >> 4 * ((i - 1) % 4)) & 0xf));
    }
    bytes[flags_at] = static_cast<uint8_t>(zero_byte + (command.flags & 0x7f));
    bytes[unknown_at] = zero_byte;
    bytes[last_at] = last_byte;
    return bytes;
}

std::optional<FalconReply> FalconReplyReader::add(uint8_t byte)
{
    if (byte == first_byte) {
        malformed_ += size_ > 0;
        bytes_[0] = byte;
        size_ = 1;
        return std::nullopt;
    }
    if (size_ == 0) {
        ++strays_;
        return std::nullopt;
    }
    if (!fits(byte, size_)) {
        ++malformed_;
        size_ = 0;
        return std::nullopt;
    }
    bytes_[size_++] = byte;
    if (size_ < falcon_packet_bytes) return std::nullopt;
    size_ = 0;
    const auto flags = static_cast<uint8_t>(bytes_[flags_at] - zero_byte);
    return FalconReply{{number_at(bytes_, 1), number_at(bytes_, 5), number_at(bytes_, 9)},
                       static_cast<uint8_t>(flags & 0xf),
                       static_cast<uint8_t>(flags >> 4)};
}

} // namespace haptel::device
