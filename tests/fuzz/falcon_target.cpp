// Bytes that claim to come from a Falcon, and files that claim to be its program.
#include "device/falcon/falcon_firmware.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/falcon/falcon_link.h"
#include "tests/device/falcon/firmware_image.h"
#include "tests/fuzz/target.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace haptel::fuzz {
namespace {

using namespace haptel::device;

// Delimiters do not occur within a packet, so the packets of a stream are all places where one fits.
uint64_t packets_in(std::string_view bytes)
{
    uint64_t count = 0;
    for (size_t at = 0; at + falcon_packet_bytes <= bytes.size(); ++at) {
        const std::string_view packet = bytes.substr(at, falcon_packet_bytes);
        bool fits = packet.front() == '<' && packet.back() == '>';
        for (size_t i = 1; i + 1 < falcon_packet_bytes; ++i) {
            const int value = static_cast<uint8_t>(packet[i]) - 'A';
            fits = fits && value >= 0 && value < (i < 13 ? 16 : 128);
        }
        count += fits;
    }
    return count;
}

void check_reply(const FalconReply& reply)
{
    const auto place = falcon_place(falcon_encoder_angles(reply.encoders), falcon_centre_m);
    if (!place) return;
    if (place->iterations > falcon_iterations_max) fail("a place that took too long");
    const auto torques = falcon_torques({1, -2, 3}, place->place_m, falcon_encoder_angles(reply.encoders));
    if (!torques) return;
    for (const int16_t count : falcon_motor_counts(*torques))
        if (std::abs(count) > falcon_motor_max_counts) fail("a motor out of its range");
}

} // namespace

void hear_falcon(std::string_view bytes)
{
    FalconReplyReader reader;
    uint64_t replies = 0;
    for (const char byte : bytes)
        if (const auto reply = reader.add(static_cast<uint8_t>(byte))) ++replies, check_reply(*reply);
    if (replies != packets_in(bytes)) fail("a reader that finds other packets than there are");
    count("packets", replies);

    // By the stream: whatever is heard, what is said is a packet, and no force while nobody has commanded one.
    FalconLink link({});
    link.begin_session();
    std::array<uint8_t, 64> room{};
    for (size_t at = 0; at < bytes.size(); at += room.size()) {
        const std::string_view transfer = bytes.substr(at, room.size());
        link.received({reinterpret_cast<const uint8_t*>(transfer.data()), transfer.size()});
        const size_t size = link.next_out(room);
        if (size != 0 && size != falcon_packet_bytes) fail("a packet of another length");
        if (size != 0 && std::any_of(room.begin() + 1, room.begin() + 13, [](uint8_t byte) { return byte != 'A'; }))
            fail("a force that nobody commanded");
    }

    const auto image = std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    count(firmware_fault(image).empty() ? "programs" : "no programs");
}

std::vector<std::string> falcon_corpus()
{
    std::vector<std::string> corpus;
    std::string stream = "1`"; // the converter's status
    for (const FalconCounts& numbers :
         {FalconCounts{0, 1, -1}, FalconCounts{2000, -2000, 500}, FalconCounts{32767, -32768, 0}}) {
        for (const uint8_t byte : encode({numbers, 0x70})) stream += static_cast<char>(byte);
        corpus.push_back(stream);
    }
    const auto image = synthetic_firmware(5);
    corpus.emplace_back(image.begin(), image.end());
    return corpus;
}

} // namespace haptel::fuzz
