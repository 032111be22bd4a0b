#include "device/sound_file.h"

#include <sndfile.h>

#include <algorithm>
#include <cstring>

namespace haptel::device {

namespace {

// A file in memory, as libsndfile asks for one.
struct MemoryFile {
    std::string bytes;
    sf_count_t at = 0;
};

sf_count_t length_of(void* file)
{
    return static_cast<sf_count_t>(static_cast<MemoryFile*>(file)->bytes.size());
}

sf_count_t seek_in(sf_count_t offset, int whence, void* user)
{
    auto* file = static_cast<MemoryFile*>(user);
    const sf_count_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file->at : length_of(user);
    return file->at = std::clamp<sf_count_t>(from + offset, 0, length_of(user));
}

sf_count_t read_from(void* to, sf_count_t count, void* user)
{
    auto* file = static_cast<MemoryFile*>(user);
    count = std::min(count, length_of(user) - file->at);
    std::memcpy(to, file->bytes.data() + file->at, static_cast<std::size_t>(count));
    file->at += count;
    return count;
}

sf_count_t write_to(const void* from, sf_count_t count, void* user)
{
    auto* file = static_cast<MemoryFile*>(user);
    const auto end = static_cast<std::size_t>(file->at + count);
    if (file->bytes.size() < end) file->bytes.resize(end);
    std::memcpy(file->bytes.data() + file->at, from, static_cast<std::size_t>(count));
    file->at += count;
    return count;
}

sf_count_t tell_of(void* user)
{
    return static_cast<MemoryFile*>(user)->at;
}

int format_of(SoundFormat format)
{
    switch (format) {
    case SoundFormat::pcm16: return SF_FORMAT_PCM_16;
    case SoundFormat::pcm24: return SF_FORMAT_PCM_24;
    case SoundFormat::float32: return SF_FORMAT_FLOAT;
    }
    return SF_FORMAT_PCM_16;
}

} // namespace

SoundBytes wav_bytes(std::span<const float> frames, int channels, SoundFormat format, const std::string& comment)
{
    SF_INFO info{};
    info.samplerate = static_cast<int>(sound_rate_hz);
    info.channels = channels;
    info.format = SF_FORMAT_WAV | format_of(format);
    SF_VIRTUAL_IO io{length_of, seek_in, read_from, write_to, tell_of};
    MemoryFile file;
    SNDFILE* sound = sf_open_virtual(&io, SFM_WRITE, &info, &file);
    if (!sound) return {{}, sf_strerror(nullptr)};
    sf_command(sound, SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE); // it holds the time of day
    if (!comment.empty()) sf_set_string(sound, SF_STR_COMMENT, comment.c_str());
    const auto count = static_cast<sf_count_t>(frames.size()) / channels;
    std::string error;
    if (sf_writef_float(sound, frames.data(), count) != count) error = sf_strerror(sound);
    if (const int fault = sf_close(sound); fault != 0 && error.empty()) error = sf_error_number(fault);
    return error.empty() ? SoundBytes{std::move(file.bytes), {}} : SoundBytes{{}, std::move(error)};
}

} // namespace haptel::device
