// Pictures on disk, made ready for textures. lang performs no I/O: this is where texels come from.
#pragma once

#include "jit/picture/picture_grain.h"
#include "lang/ir/bounds/spline_image.h"

#include <memory>
#include <string>

namespace haptel::jit {

struct ImageFile {
    std::shared_ptr<const ir::SplineImage> image; // null: see error
    std::string error, hint;
    PictureGrain grain = {};
};

// Gray values of a PNG, JPEG, BMP, TGA or PGM file of 8 or 16 bits, or a TIFF of up to 32, black 0 to white 1 (numbers
// with a sign: -1 to 1); of an EXR or a TIFF of real numbers, as they are. A colour counts by its brightness,
// transparency not at all. A relative path starts from `folder`, or from the working directory where that is empty.
// What was read is kept as long as a binding uses it and the file does not change.
ImageFile read_image(const std::string& path, const std::string& folder = {});
inline constexpr uintmax_t image_bytes_max = 256u << 20;

// Where read_image() looks for it.
std::string image_file(const std::string& path, const std::string& folder = {});

// One texel of 0: what a texture has that got no picture.
const ir::SplineImage& flat_image();
// One texel of 1.
const ir::SplineImage& white_image();

} // namespace haptel::jit
