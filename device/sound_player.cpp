#include "device/sound_player.h"

#include "device/sound_file.h"

#include <alsa/asoundlib.h>

#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <fmt/format.h>

namespace haptel::device {

namespace {

constexpr unsigned latency_us = 100'000; // nothing is sensed, so nobody feels it but who edits a texture
constexpr int wait_ms = 2'000;           // for room in a buffer that lasts a twentieth of that

std::string last_words; // of ALSA, which else writes to standard error; of the thread that opens

void hear(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/, const char* format, ...)
{
    std::array<char, 256> text{};
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text.data(), text.size(), format, arguments);
    va_end(arguments);
    last_words = text.data();
}

std::string cannot_open(const std::string& name, int error)
{
    if (error == -EBUSY)
        return fmt::format("the sound device '{}' is in use by another program: close that, or name another device",
                           name);
    const std::string why = last_words.empty() ? snd_strerror(error) : last_words;
    return fmt::format("there is no sound device '{}' ({}): `aplay -L` lists those that there are", name, why);
}

} // namespace

struct SoundPlayer::Card {
    snd_pcm_t* pcm = nullptr;
    ~Card()
    {
        if (!pcm) return;
        snd_pcm_drop(pcm);
        snd_pcm_close(pcm);
    }
};

SoundPlayer::SoundPlayer() : card_(std::make_unique<Card>()) {}
SoundPlayer::~SoundPlayer() = default;

std::string SoundPlayer::open(const std::string& name, int channels)
{
    last_words.clear();
    snd_lib_error_set_handler(hear);
    channels_ = channels;
    int error = snd_pcm_open(&card_->pcm, name.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
    if (error < 0) return cannot_open(name, error);
    error = snd_pcm_set_params(card_->pcm, SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED,
                               static_cast<unsigned>(channels), static_cast<unsigned>(sound_rate_hz), 1, latency_us);
    if (error >= 0) return {};
    const std::string advice =
        name.starts_with("hw:") ? fmt::format("write 'plug{}', which converts", name) : "name another one";
    return fmt::format("the sound device '{}' does not play {} channel{} of 32-bit floats at {:g} Hz ({}): {}", name,
                       channels, channels == 1 ? "" : "s", sound_rate_hz,
                       last_words.empty() ? snd_strerror(error) : last_words, advice);
}

std::string SoundPlayer::write(std::span<const float> frames)
{
    while (!frames.empty()) {
        const snd_pcm_sframes_t written =
            snd_pcm_writei(card_->pcm, frames.data(), frames.size() / static_cast<std::size_t>(channels_));
        if (written >= 0) {
            frames = frames.subspan(static_cast<std::size_t>(written * channels_));
            continue;
        }
        if (written == -EAGAIN) {
            if (snd_pcm_wait(card_->pcm, wait_ms) == 0)
                return fmt::format("the sound device has taken nothing for {} s", wait_ms / 1000);
            continue;
        }
        underruns_ += written == -EPIPE;
        if (const int error = snd_pcm_recover(card_->pcm, static_cast<int>(written), 1); error < 0)
            return fmt::format("the sound device failed: {}", snd_strerror(error));
    }
    return {};
}

void SoundPlayer::finish()
{
    snd_pcm_nonblock(card_->pcm, 0);
    snd_pcm_drain(card_->pcm);
}

} // namespace haptel::device
