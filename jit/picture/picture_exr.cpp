#include "jit/picture/picture.h"
#include "lang/ir/bounds/spline_image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStdIO.h>

#include <exception>

namespace haptel::jit {

namespace {

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

Picture read(Imf::InputFile& file, Colours kept)
{
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
    Picture made = picture_of(width, height);
    if (!made.error.empty()) return made;
    const Imf::ChannelList& all = file.header().channels();
    std::vector<std::string> names = channels_of(all);
    constexpr const char* which = "EXR with a channel Y, with R, G and B, or with one channel";
    if (names.empty()) return no_picture("has no channel that says how bright it is", which);
    if (kept == Colours::kept && all.findChannel("A") && names[0] != "A") names.push_back("A");
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

    if (kept == Colours::kept) keep_colours(made, names.size());
    const float* from = texels.data();
    for (int64_t row = height; row-- > 0;) // files begin at the top
        for (int64_t column = 0; column < width; ++column, ++from) {
            double values[4] = {};
            for (size_t i = 0; i < names.size(); ++i) values[i] = from[i * count];
            put_texel(made, static_cast<size_t>(row * width + column), {values, names.size()});
        }
    return made;
}

} // namespace

Picture read_exr(std::string_view bytes, Colours colours)
try {
    // Of the process, but always the same: the library takes memory for its tables before it can be asked for the size.
    constexpr int side = ir::SplineImage::side_max;
    Imf::Header::setMaxImageSize(side, side);
    Imf::Header::setMaxTileSize(side, side);
    Imf::StdISStream stream;
    stream.str(std::string(bytes));
    Imf::InputFile file(stream, 0);
    return read(file, colours);
} catch (const std::exception& problem) {
    return no_picture(std::string("is damaged: ") + problem.what());
}

} // namespace haptel::jit
