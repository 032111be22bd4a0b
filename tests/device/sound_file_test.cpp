// WAV files by their bytes, as the format is published (Microsoft and IBM 1991, "Multimedia Programming Interface and
// Data Specifications"), and without the library that writes them.
#include "device/sound_file.h"
#include "tests/support/catch.h"

#include <cstring>

using namespace haptel::device;

namespace {

template <typename Number>
Number little_endian(const std::string& bytes, std::size_t at)
{
    REQUIRE(at + sizeof(Number) <= bytes.size());
    Number number;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

// Where the content of a chunk begins, and how long it is.
std::pair<std::size_t, std::size_t> chunk(const std::string& bytes, const std::string& name)
{
    std::size_t at = 12;
    while (at + 8 <= bytes.size() && bytes.substr(at, 4) != name)
        at += 8 + (little_endian<uint32_t>(bytes, at + 4) + 1) / 2 * 2;
    return {at + 8, little_endian<uint32_t>(bytes, at + 4)};
}

constexpr float frames[] = {0, 1, -1, 0.5f, 0.25f, -0.125f};

} // namespace

TEST_CASE("a WAV file has its rate, its channels and its samples")
{
    struct Case {
        SoundFormat format;
        int code, bits;
    };
    for (const Case& c :
         {Case{SoundFormat::pcm16, 1, 16}, Case{SoundFormat::pcm24, 1, 24}, Case{SoundFormat::float32, 3, 32}}) {
        CAPTURE(c.bits);
        const SoundBytes sound = wav_bytes(frames, 2, c.format, "a note");
        REQUIRE(sound.error == "");
        const std::string& bytes = sound.bytes;
        CHECK(bytes.substr(0, 4) == "RIFF");
        CHECK(little_endian<uint32_t>(bytes, 4) == bytes.size() - 8);
        CHECK(bytes.substr(8, 4) == "WAVE");
        const std::size_t format = chunk(bytes, "fmt ").first;
        CHECK(little_endian<uint16_t>(bytes, format) == c.code);
        CHECK(little_endian<uint16_t>(bytes, format + 2) == 2);
        CHECK(little_endian<uint32_t>(bytes, format + 4) == 48'000);
        CHECK(little_endian<uint32_t>(bytes, format + 8) == 48'000u * 2 * c.bits / 8);
        CHECK(little_endian<uint16_t>(bytes, format + 14) == c.bits);
        const auto [data, length] = chunk(bytes, "data");
        REQUIRE(length == std::size_t(6 * c.bits / 8));
        for (std::size_t i = 0; i < 6; ++i) {
            const std::size_t at = data + i * c.bits / 8;
            if (c.bits == 32) {
                CHECK(little_endian<float>(bytes, at) == frames[i]);
                continue;
            }
            const double full_scale = c.bits == 16 ? 32'767 : 8'388'607;
            int found = little_endian<int16_t>(bytes, at);
            if (c.bits == 24) found = (little_endian<uint16_t>(bytes, at) | int8_t(bytes[at + 2]) * 65'536);
            CHECK(std::abs(found - full_scale * double(frames[i])) <= 0.5);
        }
        CHECK(bytes.find("a note") != bytes.npos);
        CHECK(wav_bytes(frames, 2, c.format, "a note").bytes == bytes); // no time of day in it
    }
}

TEST_CASE("a sound without a frame is a file, too")
{
    const SoundBytes sound = wav_bytes({}, 1, SoundFormat::pcm16, "");
    CHECK(sound.error == "");
    CHECK(chunk(sound.bytes, "data").second == 0);
}
