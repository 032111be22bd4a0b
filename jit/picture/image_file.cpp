#include "jit/picture/image_file.h"

#include "input/regular_file.h"
#include "jit/codegen/content_hash.h"
#include "jit/picture/picture.h"
#include "lang/text/diagnostic.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>

namespace haptel::jit {

namespace {

namespace fs = std::filesystem;

ImageFile fail(std::string error, std::string hint = {})
{
    return {nullptr, std::move(error), std::move(hint), {}};
}

ImageFile decode(const std::string& bytes, const std::string& shown, ir::ImageParts parts)
{
    const Picture picture = read_picture(bytes, parts.channels ? Colours::kept : Colours::ignored);
    if (!picture.error.empty()) return fail("'" + shown + "' " + lang::printable(picture.error), picture.hint);
    ImageFile made;
    made.grain = grain_of(picture);
    const auto& [red, green, blue, alpha] = picture.colours;
    made.image = ir::SplineImage::make({picture.gray, {red, green, blue, alpha}, picture.width, picture.height}, parts,
                                       made.error);
    if (!made.image) made.error = "'" + shown + "': " + made.error;
    return made;
}

// The clock of a file system may tick slowly: within a tick of its last change a file may change unseen.
constexpr auto tick_longest = std::chrono::milliseconds(100);

// What the file was when it was read.
struct Known {
    fs::file_time_type written, read; // the latter: when reading began
    uintmax_t size = 0;
    ContentHash content = {};
    std::weak_ptr<const ir::SplineImage> image;
    PictureGrain grain = {};
};

// A finger at rest feels an edge of 0.85 um on a smooth plate (Johansson and LaMotte 1983, Tactile detection thresholds
// for a single asperity on an otherwise smooth surface).
constexpr double felt_edge_m = 1e-6;

std::string micrometres(double height_m)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2g um", height_m * 1e6);
    return text;
}

std::shared_ptr<const ir::SplineImage> image_of(double texel)
{
    std::string error;
    return ir::SplineImage::make({{&texel, 1}, {}, 1, 1}, {}, error);
}

} // namespace

std::string image_file(const std::string& path, const std::string& folder)
{
    std::error_code fault;
    return fs::absolute(fs::path(folder) / path, fault).lexically_normal().string();
}

ImageFile read_image(const std::string& path, const std::string& folder, ir::ImageParts parts)
{
    static std::mutex mutex;
    static std::map<std::pair<std::string, ir::ImageParts>, Known> all; // by absolute path

    const std::string shown = lang::printable(path);
    std::error_code fault;
    const fs::path file = image_file(path, folder);
    const uintmax_t size = fs::file_size(file, fault);
    const auto written = fs::last_write_time(file, fault);

    const std::lock_guard lock(mutex);
    std::erase_if(all, [](const auto& known) { return known.second.image.expired(); });
    Known& known = all[{file.string(), parts}];
    const auto image = known.image.lock();
    if (image && known.size == size && known.written == written && known.read > written + tick_longest)
        return {image, {}, {}, known.grain};
    const auto now = fs::file_time_type::clock::now();
    const auto [bytes, refused] = input::read_regular_file(file, image_bytes_max);
    switch (refused.refusal) {
    case input::Refusal::none: break;
    case input::Refusal::missing:
        return fail("there is no file '" + shown + "'", "it was looked for at " + lang::printable(file.string()) +
                                                            "; a scene's pictures lie beside the scene");
    case input::Refusal::unreadable: return fail("'" + shown + "' " + refused.why, "may you read it?");
    case input::Refusal::folder:
    case input::Refusal::not_regular:
    case input::Refusal::too_large: return fail("'" + shown + "' " + refused.why);
    }
    const ContentHash content = content_hash(bytes);
    ImageFile made =
        image && known.content == content ? ImageFile{image, {}, {}, known.grain} : decode(bytes, shown, parts);
    known = {written, now, size, content, made.image, made.grain};
    return made;
}

const ir::SplineImage& flat_image()
{
    static const auto image = image_of(0);
    return *image;
}

const ir::SplineImage& white_image()
{
    static const auto image = image_of(1);
    return *image;
}

PictureGrain grain_of(const Picture& picture)
{
    const auto [darkest, brightest] = std::minmax_element(picture.gray.begin(), picture.gray.end());
    if (darkest == picture.gray.end()) return {};
    const double low = *darkest, high = *brightest;
    const bool has_shades = std::ranges::any_of(picture.gray, [&](double gray) { return low < gray && gray < high; });
    return {has_shades && picture.levels > 0 ? 1 / picture.levels : 0, picture.has_blocks};
}

std::vector<GrainNote> grain_notes(const PictureGrain& grain, const std::string& shown, double white_m)
{
    std::vector<GrainNote> notes;
    const double step_m = white_m * grain.level;
    if (std::isfinite(step_m) && step_m > felt_edge_m)
        notes.push_back({"'" + shown + "' has " + std::to_string(std::lround(1 / grain.level) + 1) +
                             " levels, so heights go in steps of " + micrometres(step_m) +
                             "; a hand feels edges from about " + micrometres(felt_edge_m) + " on",
                         "a file of 16 bits or of real numbers has no steps that can be felt"});
    if (grain.has_blocks)
        notes.push_back({"'" + shown + "' is coded in blocks of 8 x 8 texels, whose borders may be felt as a grid",
                         "use a PNG, TIFF or EXR made from the original; written anew, this one keeps its blocks"});
    return notes;
}

} // namespace haptel::jit
