// Forces as sound files: WAV, for voice coils and whatever plays them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace haptel::device {

// What voice coils are fed with, everywhere.
inline constexpr double sound_rate_hz = 48'000;
inline constexpr int sound_channels_max = 4;

enum class SoundFormat : uint8_t { pcm16, pcm24, float32 };

// The bytes of a WAV file, the same on every run. `frames`: channel beside channel, full scale is 1; nothing beyond it.
// `comment` is for people who look into the file.
struct SoundBytes {
    std::string bytes;
    std::string error; // in words; empty: none
};
SoundBytes wav_bytes(std::span<const float> frames, int channels, SoundFormat format, const std::string& comment);

} // namespace haptel::device
