// Pictures on disk, made ready for textures. lang performs no I/O: this is where texels come from.
#pragma once

#include "lang/ir/bounds/spline_image.h"

#include <memory>
#include <string>
#include <vector>

namespace haptel::jit {

struct Picture;

// What of a picture's file a hand may feel beside the surface that it shows: the steps between the levels of its whole
// numbers, and the borders of the blocks in which a JPEG is coded. A file does not say whether its levels are meant (a
// mask of black and white has none between), so this speaks of pictures with shades, and only of what can be felt.
struct PictureGrain {
    double level = 0; // from one gray value to the next that the file can hold; 0: finer than any hand, or no shades
    bool has_blocks = false; // of 8 x 8 texels
};
PictureGrain grain_of(const Picture& picture);

struct GrainNote {
    std::string message, hint;
};
// To the author of a texture that is `white_m` metres higher where the picture is white than where it is black;
// infinite or NaN where that is not known, and then nothing is said of steps. `shown` names the file.
std::vector<GrainNote> grain_notes(const PictureGrain& grain, const std::string& shown, double white_m);

struct ImageFile {
    std::shared_ptr<const ir::SplineImage> image; // null: see error
    std::string error, hint;
    PictureGrain grain = {};
};

// Gray values of a PNG, JPEG, BMP, TGA or PGM file of 8 or 16 bits, or a TIFF of up to 32, black 0 to white 1 (numbers
// with a sign: -1 to 1); of an EXR or a TIFF of real numbers, as they are. A colour counts by its brightness,
// transparency not at all; its channels are `parts`. A relative path starts from `folder`, or from the working
// directory where that is empty. What was read is kept as long as a binding uses it and the file does not change.
ImageFile read_image(const std::string& path, const std::string& folder, ir::ImageParts parts);
inline constexpr uintmax_t image_bytes_max = 256u << 20;

// Where read_image() looks for it.
std::string image_file(const std::string& path, const std::string& folder = {});

// One texel of 0: what a texture has that got no picture.
const ir::SplineImage& flat_image();
// One texel of 1.
const ir::SplineImage& white_image();

} // namespace haptel::jit
