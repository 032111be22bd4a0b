#include "device/falcon/falcon_packet.h"
#include "device/falcon/ftdi_serial.h"
#include "tests/support/catch.h"

#include <random>
#include <string>
#include <vector>

using namespace haptel::device;

namespace {

// A reply as the device writes it: the rules of the protocol, in digits of base 16 instead of shifts.
std::string written_reply(const FalconCounts& encoders, int buttons, int homed)
{
    std::string bytes = "<";
    for (const int16_t encoder : encoders) {
        int rest = encoder < 0 ? encoder + 65536 : encoder;
        for (int digit = 0; digit < 4; ++digit, rest /= 16) bytes += "ABCDEFGHIJKLMNOP"[rest % 16];
    }
    bytes += static_cast<char>('A' + 16 * homed + buttons);
    return bytes + "A>";
}

std::vector<FalconReply> read_all(FalconReplyReader& reader, std::string_view bytes)
{
    std::vector<FalconReply> replies;
    for (const char byte : bytes)
        if (const auto reply = reader.add(static_cast<uint8_t>(byte))) replies.push_back(*reply);
    return replies;
}

bool equal(const FalconReply& a, const FalconReply& b)
{
    return a.encoders == b.encoders && a.buttons == b.buttons && a.homed == b.homed;
}

} // namespace

TEST_CASE("a command is written as in a recorded trace: 4095 is 3c 50 50 50 41")
{
    const FalconPacketBytes bytes = encode({{4095, -4095, 1}, falcon_homing | falcon_red});
    const FalconPacketBytes expected = {0x3c, 0x50, 0x50, 0x50, 0x41, 0x42, 0x41, 0x41,
                                        0x50, 0x42, 0x41, 0x41, 0x41, 0x4a, 0x41, 0x3e};
    CHECK(bytes == expected);
}

TEST_CASE("every number survives writing and reading")
{
    FalconReplyReader reader;
    uint64_t wrong = 0;
    for (int value = -32768; value < 32768; ++value) {
        const auto number = static_cast<int16_t>(value);
        const FalconCommand command{{number, static_cast<int16_t>(~value), 77}, 0x7a};
        std::string written;
        for (const uint8_t byte : encode(command)) written += static_cast<char>(byte);
        const auto replies = read_all(reader, written);
        wrong += replies.size() != 1 || replies[0].encoders != command.motors || replies[0].buttons != 0xa ||
                 replies[0].homed != 7 || written != written_reply(command.motors, 0xa, 7);
    }
    CHECK(wrong == 0);
    CHECK(reader.malformed() + reader.strays() == 0);
}

TEST_CASE("a reply is found however it is split, whatever stands before it")
{
    const std::string first = written_reply({-1, 2000, -2000}, 5, 7), second = written_reply({3, 2, 1}, 0, 3);
    const FalconReply expected{{3, 2, 1}, 0, 3};
    for (std::size_t cut = 0; cut <= first.size(); ++cut) {
        FalconReplyReader reader;
        CHECK(read_all(reader, std::string_view(first).substr(0, cut)).size() == (cut == first.size()));
        CHECK(read_all(reader, std::string_view(first).substr(cut)).size() == (cut != first.size()));

        FalconReplyReader late; // listens from the middle of a packet on
        const auto heard = read_all(late, first.substr(cut) + second);
        REQUIRE(heard.size() == (cut == 0 ? 2 : 1));
        CHECK(equal(heard.back(), expected));
        CHECK(late.strays() == (cut == 0 ? 0 : first.size() - cut));

        FalconReplyReader shortened; // a byte is lost
        std::string lacking = first;
        if (cut < lacking.size()) lacking.erase(cut, 1);
        const auto kept = read_all(shortened, lacking + second);
        CHECK(kept.size() == (cut == first.size() ? 2 : 1));
        CHECK(equal(kept.back(), expected));
        CHECK(shortened.malformed() == (cut == 0 || cut == first.size() ? 0 : 1));
    }
}

TEST_CASE("a short packet of 14 bytes is no reply: it would read as homed with all buttons pressed")
{
    FalconReplyReader reader;
    std::string bytes = written_reply({100, 200, 300}, 0, 7);
    bytes.erase(11, 2);
    CHECK(read_all(reader, bytes).empty());
    CHECK(reader.malformed() == 1);
}

TEST_CASE("each byte out of its range breaks a packet, each one within does not")
{
    const std::string good = written_reply({1, 2, 3}, 0, 7);
    for (std::size_t at = 0; at < good.size(); ++at)
        for (int byte = 0; byte < 256; ++byte) {
            std::string bytes = good;
            bytes[at] = static_cast<char>(byte);
            const bool in_range = at == 0    ? byte == 0x3c
                                  : at == 15 ? byte == 0x3e
                                             : byte >= 0x41 && byte <= (at < 13 ? 0x50 : 0xc0);
            FalconReplyReader reader;
            INFO("byte " << at << " is " << byte);
            REQUIRE(read_all(reader, bytes).size() == in_range);
        }
}

TEST_CASE("among garbage every whole packet is found, and no other")
{
    std::mt19937 random(7);
    FalconReplyReader reader;
    uint64_t lost = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string bytes;
        for (std::size_t length = random() % 40; length > 0; --length) bytes += static_cast<char>(random() % 256);
        const FalconReply sent{{static_cast<int16_t>(random()), static_cast<int16_t>(random()), 0},
                               static_cast<uint8_t>(random() % 16),
                               static_cast<uint8_t>(random() % 8)};
        const auto replies = read_all(reader, bytes + written_reply(sent.encoders, sent.buttons, sent.homed));
        lost += replies.empty() || !equal(replies.back(), sent);
    }
    CHECK(lost == 0);
    CHECK(reader.malformed() > 0);
}

TEST_CASE("the serial converter's two status bytes are left out at each 64")
{
    for (std::size_t size = 0; size <= 200; ++size) {
        std::vector<uint8_t> transfer;
        std::string expected, got;
        for (std::size_t i = 0; i < size; ++i) {
            const bool status = i == 0 || i == 1 || i == 64 || i == 65 || i == 128 || i == 129 || i == 192 || i == 193;
            transfer.push_back(status ? 0x3c : static_cast<uint8_t>(i));
            if (!status) expected += static_cast<char>(i);
        }
        for_each_ftdi_byte(transfer, [&](uint8_t byte) { got += static_cast<char>(byte); });
        REQUIRE(got == expected);
    }
}
