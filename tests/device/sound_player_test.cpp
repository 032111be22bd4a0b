// A player on ALSA's devices without hardware: `null`, and `file`, which keeps what it is given. Gaps are made by a
// snd_pcm_writei in the place of ALSA's, which breaks down where a test says.
#include "device/sound_player.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <fstream>
#include <iterator>

using haptel::device::SoundPlayer;
using haptel::test::Folder;

namespace {

std::vector<long> answers; // of the next writes, in place of ALSA's; 0: ALSA's

std::string bytes_of(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<float> ramp(std::size_t count)
{
    std::vector<float> frames(count);
    for (std::size_t i = 0; i < count; ++i) frames[i] = static_cast<float>(i) / static_cast<float>(count);
    return frames;
}

std::string as_bytes(const std::vector<float>& frames)
{
    std::string bytes(4 * frames.size(), 0);
    std::memcpy(bytes.data(), frames.data(), bytes.size());
    return bytes;
}

} // namespace

// As alsa/pcm.h declares it, whose headers are the player's.
extern "C" long snd_pcm_writei(void* pcm, const void* frames, unsigned long count)
{
    using Write = long (*)(void*, const void*, unsigned long);
    static const auto alsa = reinterpret_cast<Write>(dlsym(RTLD_NEXT, "snd_pcm_writei"));
    if (answers.empty()) return alsa(pcm, frames, count);
    const long answer = answers.front();
    answers.erase(answers.begin());
    return answer < 0 ? answer : alsa(pcm, frames, answer == 0 ? count : static_cast<unsigned long>(answer));
}

TEST_CASE("what is played is what was given, to the last frame")
{
    const Folder folder;
    const std::string file = folder.file("heard.raw");
    const std::vector<float> frames = ramp(4 * 1234);
    SoundPlayer player;
    REQUIRE(player.open("file:" + file + ",raw", 4) == "");
    CHECK(player.write(frames) == "");
    CHECK(player.write({}) == "");
    player.finish();
    CHECK(player.underruns() == 0);
    CHECK(bytes_of(file) == as_bytes(frames));
}

TEST_CASE("a gap is counted, and what is left is played; a card that takes a part gets the rest")
{
    const Folder folder;
    const std::string file = folder.file("heard.raw");
    const std::vector<float> frames = ramp(1000);
    SoundPlayer player;
    REQUIRE(player.open("file:" + file + ",raw", 1) == "");
    answers = {100, -EPIPE, 300, -EAGAIN, -EPIPE};
    CHECK(player.write(frames) == "");
    CHECK(answers.empty());
    player.finish();
    CHECK(player.underruns() == 2);
    CHECK(bytes_of(file) == as_bytes(frames));
}

TEST_CASE("a card that goes away is an error")
{
    SoundPlayer player;
    REQUIRE(player.open("null", 1) == "");
    answers = {-ENODEV};
    CHECK(player.write(ramp(10)).find("the sound device failed: No such device") == 0);
}

TEST_CASE("a card that is not there, or cannot, is told with what to do")
{
    const auto said = [](const std::string& name, int channels) { return SoundPlayer().open(name, channels); };
    CHECK(said("nosuch", 1).find("there is no sound device 'nosuch' (Unknown PCM nosuch): `aplay -L` lists") == 0);
    CHECK(said("hw:77", 1).find("there is no sound device 'hw:77'") == 0);
    CHECK(said("", 1).find("there is no sound device ''") == 0);
    CHECK(said("null", 4) == "");
}
