// Parameters of a texture from what was measured of a surface.
#pragma once

#include "jit/fit/stroke.h"
#include "jit/texture/texture.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptel::jit {

// Heights over a grid, rows from the lowest up, its middle at the origin of the plane z = 0.
struct HeightMap {
    std::size_t columns = 0, rows = 0;
    double pixel_m = 0;
    std::vector<double> heights_m;

    haptel_point point(std::size_t column, std::size_t row) const; // with uv from 0 to 1 over the map
};

struct FitRequest {
    std::string texture;                                         // its name
    std::vector<std::pair<std::string, std::string>> parameters; // that are known, as a TextureRequest has them
    uint64_t seed = 1;
};

struct FittedParameter {
    std::string name;
    uint32_t index = 0;  // in haptel_texture::parameters
    double value = 0;    // SI
    bool is_free = true; // looked for; else as given or as the author has it
};

// A parameter whose value what was measured does not tell, or not to 1 %.
struct Undetermined {
    std::string name, why;
};

// Of a stroke's spectrum: how much more power the texture has than the recording.
struct FittedBand {
    double from_hz = 0, to_hz = 0, off_db = 0;
};

struct FitResult {
    std::vector<FittedParameter> parameters; // all but pictures
    double error = 0;  // root of the mean square of what is left: metres of heights, decibels of a stroke's bands
    double of_all = 0; // of heights: that over the root of the mean square of what was measured, its mean taken off
    std::vector<FittedBand> bands; // of a stroke
    std::vector<Undetermined> undetermined;
    std::string failure; // why there is none: empty where there is one
};

// `program` has batches in f64. Takes seconds, and as many evaluations as there are guesses and points.
FitResult fit_heights(const std::shared_ptr<const CompiledProgram>& program, const FitRequest& request,
                      const HeightMap& map);

// The same of a recorded stroke, whose phases nothing on a rough surface can have: by the power in each third of an
// octave, and white noise of the recording beside.
FitResult fit_stroke(const std::shared_ptr<const CompiledProgram>& program, const FitRequest& request,
                     const Stroke& stroke);

} // namespace haptel::jit
