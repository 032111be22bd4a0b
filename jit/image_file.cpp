#include "jit/image_file.h"

#include "jit/content_hash.h"
#include "lang/diagnostic.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_ONLY_PNM
#define STBI_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace haptel::jit {

namespace {

namespace fs = std::filesystem;

ImageFile fail(std::string error, std::string hint = {})
{
    return {nullptr, std::move(error), std::move(hint)};
}

std::shared_ptr<const ir::SplineImage> image_of(const stbi_us* gray, int width, int height, std::string& error)
{
    std::vector<double> texels(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int row = 0; row < height; ++row) // files begin at the top
        for (int column = 0; column < width; ++column) {
            const auto to =
                static_cast<size_t>(height - 1 - row) * static_cast<size_t>(width) + static_cast<size_t>(column);
            texels[to] =
                gray[static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column)] / 65535.0;
        }
    return ir::SplineImage::make(texels, width, height, error);
}

ImageFile decode(const std::string& bytes, const std::string& shown)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    constexpr const char* formats = "a picture is a PNG, JPEG, BMP, TGA or PGM file";
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        return fail("'" + shown + "' is no picture that can be read", formats);
    if (width > ir::SplineImage::side_max || height > ir::SplineImage::side_max ||
        int64_t{width} * height > ir::SplineImage::texels_max)
        return fail("'" + shown + "' is too large: " + std::to_string(width) + " x " + std::to_string(height) +
                        " texels",
                    "a side may have " + std::to_string(ir::SplineImage::side_max) + ", the whole " +
                        std::to_string(ir::SplineImage::texels_max));
    const std::unique_ptr<stbi_us, void (*)(void*)> gray(
        stbi_load_16_from_memory(data, size, &width, &height, &channels, 1), stbi_image_free);
    if (!gray) return fail("'" + shown + "' is damaged: " + stbi_failure_reason(), formats);
    ImageFile made;
    made.image = image_of(gray.get(), width, height, made.error);
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
};

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
    if (!fs::exists(file, fault))
        return fail("there is no file '" + shown + "'", "it was looked for at " + lang::printable(file.string()) +
                                                            "; a scene's pictures lie beside the scene");
    if (!fs::is_regular_file(file, fault)) return fail("'" + shown + "' is not a file");
    const uintmax_t size = fs::file_size(file, fault);
    if (fault || size > image_bytes_max) return fail("'" + shown + "' is too large to read");
    const auto written = fs::last_write_time(file, fault);

    const std::lock_guard lock(mutex);
    std::erase_if(all, [](const auto& known) { return known.second.image.expired(); });
    Known& known = all[file.string()];
    const auto image = known.image.lock();
    if (image && known.size == size && known.written == written && known.read > written + tick_longest)
        return {image, {}, {}};
    const auto now = fs::file_time_type::clock::now();
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in.is_open() || in.bad()) return fail("'" + shown + "' cannot be read", "may you read it?");
    const ContentHash content = content_hash(bytes);
    ImageFile made = image && known.content == content ? ImageFile{image, {}, {}} : decode(bytes, shown);
    known = {written, now, size, content, made.image};
    return made;
}

const ir::SplineImage& flat_image()
{
    static const auto image = [] {
        std::string error;
        const double zero[] = {0};
        return ir::SplineImage::make(zero, 1, 1, error);
    }();
    return *image;
}

} // namespace haptel::jit
