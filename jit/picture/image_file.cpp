#include "jit/picture/image_file.h"

#include "input/regular_file.h"
#include "jit/codegen/content_hash.h"
#include "jit/picture/picture.h"
#include "lang/text/diagnostic.h"

#include <chrono>
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

ImageFile decode(const std::string& bytes, const std::string& shown)
{
    const Picture picture = read_picture(bytes);
    if (!picture.error.empty()) return fail("'" + shown + "' " + lang::printable(picture.error), picture.hint);
    ImageFile made;
    made.grain = grain_of(picture);
    made.image = ir::SplineImage::make(picture.gray, picture.width, picture.height, made.error);
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

std::shared_ptr<const ir::SplineImage> image_of(double texel)
{
    std::string error;
    return ir::SplineImage::make({&texel, 1}, 1, 1, error);
}

} // namespace

std::string image_file(const std::string& path, const std::string& folder)
{
    std::error_code fault;
    return fs::absolute(fs::path(folder) / path, fault).lexically_normal().string();
}

ImageFile read_image(const std::string& path, const std::string& folder)
{
    static std::mutex mutex;
    static std::map<std::string, Known> all; // by absolute path

    const std::string shown = lang::printable(path);
    std::error_code fault;
    const fs::path file = image_file(path, folder);
    const auto refuse = [&](const input::Refused& refused) {
        switch (refused.refusal) {
        case input::Refusal::missing:
            return fail("there is no file '" + shown + "'", "it was looked for at " + lang::printable(file.string()) +
                                                                "; a scene's pictures lie beside the scene");
        case input::Refusal::unreadable: return fail("'" + shown + "' " + refused.why, "may you read it?");
        case input::Refusal::none:
        case input::Refusal::folder:
        case input::Refusal::not_regular:
        case input::Refusal::too_large: break;
        }
        return fail("'" + shown + "' " + refused.why);
    };
    const input::Refused look = input::look_at_regular_file(file, image_bytes_max);
    if (look.refusal != input::Refusal::none) return refuse(look);
    const uintmax_t size = fs::file_size(file, fault);
    const auto written = fs::last_write_time(file, fault);

    const std::lock_guard lock(mutex);
    std::erase_if(all, [](const auto& known) { return known.second.image.expired(); });
    Known& known = all[file.string()];
    const auto image = known.image.lock();
    if (image && known.size == size && known.written == written && known.read > written + tick_longest)
        return {image, {}, {}, known.grain};
    const auto now = fs::file_time_type::clock::now();
    const input::FileBytes read = input::read_regular_file(file, image_bytes_max);
    if (read.refused.refusal != input::Refusal::none) return refuse(read.refused);
    const std::string& bytes = read.bytes;
    const ContentHash content = content_hash(bytes);
    ImageFile made = image && known.content == content ? ImageFile{image, {}, {}, known.grain} : decode(bytes, shown);
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

} // namespace haptel::jit
