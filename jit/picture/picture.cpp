#include "jit/picture/picture.h"

#include "jit/picture/picture_damage.h"
#include "lang/ir/bounds/spline_image.h"

#include <cstdlib>
#include <memory>

namespace haptel::jit {
namespace {

// What one allocation of the reader below may take, set by who calls it: some formats do not say what their bytes
// unpack to, and a kilobyte may hold a gigabyte of zeros.
thread_local std::size_t allocation_max = 0;

void* allocate(std::size_t bytes)
{
    return bytes <= allocation_max ? std::malloc(bytes) : nullptr;
}

void* reallocate(void* old, std::size_t bytes)
{
    return bytes <= allocation_max ? std::realloc(old, bytes) : nullptr;
}

} // namespace
} // namespace haptel::jit

#define STBI_MALLOC(bytes) haptel::jit::allocate(bytes)
#define STBI_REALLOC(old, bytes) haptel::jit::reallocate(old, bytes)
#define STBI_FREE(old) std::free(old)
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace haptel::jit {

Picture no_picture(std::string error, std::string hint)
{
    Picture none;
    none.error = std::move(error);
    none.hint = std::move(hint);
    return none;
}

int64_t picture_side_max()
{
    return ir::SplineImage::side_max;
}

Picture picture_of(int64_t width, int64_t height)
{
    using ir::SplineImage;
    if (width < 1 || height < 1) return no_picture("has no texels");
    if (width > SplineImage::side_max || height > SplineImage::side_max || width * height > SplineImage::texels_max)
        return no_picture("is too large: " + std::to_string(width) + " x " + std::to_string(height) + " texels",
                          "a side may have " + std::to_string(SplineImage::side_max) + ", the whole " +
                              std::to_string(SplineImage::texels_max));
    Picture made;
    made.gray.resize(static_cast<size_t>(width * height));
    made.width = width;
    made.height = height;
    return made;
}

Picture read_picture(std::string_view bytes)
{
    return is_tiff(bytes)  ? read_tiff(bytes)
           : is_exr(bytes) ? read_exr(bytes)
           : is_pnm(bytes) ? read_pnm(bytes)
                           : read_common_picture(bytes);
}

Picture read_common_picture(std::string_view bytes)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size()); // image_bytes_max fits
    constexpr const char* formats = "a picture is a PNG, JPEG, TIFF, EXR, BMP, TGA or PGM file";
    if (const std::string damage = picture_damage(bytes); !damage.empty())
        return no_picture("is damaged: " + damage, formats);
    int width = 0, height = 0, channels = 0;
    allocation_max = 1 << 20;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        return no_picture("is no picture that can be read", formats);
    Picture made = picture_of(width, height);
    if (!made.error.empty()) return made;
    // Twice, as it grows by doubling: the file's own bytes, and 4 channels of 16 bits for each texel.
    allocation_max += 2 * (bytes.size() + 8 * made.gray.size() + static_cast<size_t>(height));
    const std::unique_ptr<stbi_us, void (*)(void*)> gray(
        stbi_load_16_from_memory(data, size, &width, &height, &channels, 1), stbi_image_free);
    if (!gray && std::string_view(stbi_failure_reason()) == "Out of memory")
        return no_picture("is damaged: it unpacks to more than " + std::to_string(width) + " x " +
                              std::to_string(height) + " texels",
                          formats);
    if (!gray) return no_picture(std::string("is damaged: ") + stbi_failure_reason(), formats);
    made.levels = stbi_is_16_bit_from_memory(data, size) ? 65535 : 255;
    made.has_blocks = bytes.starts_with("\xff\xd8\xff");
    if (width != made.width || height != made.height) return no_picture("is damaged: it has two sizes");
    const stbi_us* from = gray.get();
    for (int64_t row = height; row-- > 0;) // files begin at the top
        for (int64_t column = 0; column < width; ++column)
            made.gray[static_cast<size_t>(row * width + column)] = *from++ / 65535.0;
    return made;
}

} // namespace haptel::jit
