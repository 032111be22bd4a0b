// What of a picture's file a hand may feel beside the surface that it shows: the steps between the levels of its whole
// numbers, and the borders of the blocks in which a JPEG is coded. A file does not say whether its levels are meant (a
// mask of black and white has none between), so this speaks of pictures with shades, and only of what can be felt.
#pragma once

#include <string>
#include <vector>

namespace haptel::jit {

struct Picture;

// Of a picture that was read.
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

} // namespace haptel::jit
