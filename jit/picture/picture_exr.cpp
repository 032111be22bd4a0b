#include "jit/picture/picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>

#include <cstring>
#include <exception>
#include <stdexcept>

namespace haptel::jit {

namespace {

class Bytes final : public Imf::IStream {
public:
    explicit Bytes(std::string_view bytes) : IStream("picture"), bytes_(bytes) {}

    bool read(char to[], int count) override
    {
        if (count < 0 || at_ > bytes_.size() || static_cast<uint64_t>(count) > bytes_.size() - at_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(to, bytes_.data() + at_, static_cast<size_t>(count));
        at_ += static_cast<uint64_t>(count);
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t at) override { at_ = at; }

private:
    std::string_view bytes_;
    uint64_t at_ = 0;
};

// The channels that make the brightness: Y, or R, G and B, or the only one.
std::vector<std::string> channels_of(const Imf::ChannelList& channels)
{
    if (channels.findChannel("Y")) return {"Y"};
    if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")) return {"R", "G", "B"};
    const auto first = channels.begin();
    if (first == channels.end()) return {};
    auto next = first;
    return ++next == channels.end() ? std::vector<std::string>{first.name()} : std::vector<std::string>{};
}

Picture read(Imf::InputFile& file)
{
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
    Picture made = picture_of(width, height);
    if (!made.error.empty()) return made;
    const Imf::ChannelList& all = file.header().channels();
    const std::vector<std::string> names = channels_of(all);
    constexpr const char* which = "EXR with a channel Y, with R, G and B, or with one channel";
    if (names.empty()) return no_picture("has no channel that says how bright it is", which);
    for (const std::string& name : names)
        if (all[name].xSampling != 1 || all[name].ySampling != 1)
            return no_picture("has not all of its texels in channel " + name, which);

    const size_t count = made.gray.size();
    std::vector<float> texels(names.size() * count);
    const auto row_bytes = sizeof(float) * static_cast<size_t>(width);
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < names.size(); ++i)
        frame.insert(names[i],
                     Imf::Slice::Make(Imf::FLOAT, texels.data() + i * count, window, sizeof(float), row_bytes));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);

    for (size_t i = 0; i < count; ++i) {
        const size_t row = i / static_cast<size_t>(width), column = i % static_cast<size_t>(width);
        const auto to = (static_cast<size_t>(height) - 1 - row) * static_cast<size_t>(width) + column;
        made.gray[to] = names.size() == 1 ? static_cast<double>(texels[i])
                                          : brightness(texels[i], texels[count + i], texels[2 * count + i]);
    }
    return made;
}

} // namespace

bool is_exr(std::string_view bytes)
{
    return bytes.starts_with("\x76\x2f\x31\x01");
}

Picture read_exr(std::string_view bytes)
try {
    // Of the process, but always the same: the library takes memory for its tables before it can be asked for the size.
    const int side = static_cast<int>(picture_side_max());
    Imf::Header::setMaxImageSize(side, side);
    Imf::Header::setMaxTileSize(side, side);
    Bytes stream(bytes);
    Imf::InputFile file(stream, 0);
    return read(file);
} catch (const std::exception& problem) {
    return no_picture(std::string("is damaged: ") + problem.what());
}

} // namespace haptel::jit
