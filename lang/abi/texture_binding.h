// The interface between the runtime and a source of textures. The runtime sends a TextureRequest for each object; a
// TextureResolver (the compiler, a library of precompiled textures, a lambda in a test) answers with a TextureBinding,
// which has everything that the servo calls and reads, or with the reason why there is none.
//
// Header-only and part of haptel_abi, so that neither side needs to link the other. Lengths are in metres; text in a
// request is as its author wrote it.
#pragma once

#include "lang/abi/abi.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptel {

// The unit of change: a program, the parameter values it runs with, and what is proven about the two together.
// Immutable once made; copying shares ownership. `owner` keeps code, block and strings alive.
struct TextureBinding {
    std::shared_ptr<const void> owner;
    const haptel_texture* texture = nullptr;
    const void* block = nullptr; // texture->block_size bytes, aligned to 8, starting with haptel_block_head
    haptel_facts facts = {};     // for this block and the object's box
    // Of an end of the range of heights that was found by looking, and not proven: heights that come to within half of
    // it are bent so that none is beyond the end (runtime/texture/surface_texture.h). At the lower and the upper end;
    // 0: proven.
    double shoulder_m[2] = {0, 0};
    bool band_limited = false; // detail is faded or left out because it is finer than the block's footprint
};

// How a mesh is unrolled: the range of its coordinates u and v, of their Jacobian, and how fast each of them changes at
// most (the length of its row). Infinite where that is not known.
struct UvFigures {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    double minimum[2] = {-infinity, -infinity}, maximum[2] = {infinity, infinity};
    double dp_minimum[2][3] = {{-infinity, -infinity, -infinity}, {-infinity, -infinity, -infinity}}; // 1/m, along p
    double dp_maximum[2][3] = {{infinity, infinity, infinity}, {infinity, infinity, infinity}};
    double slope_max_per_m[2] = {infinity, infinity};
};

// What an object asks for. Text stays text: only the resolver knows parameters' types and units.
struct TextureRequest {
    // "rock.haptel:rock": a path, absolute after scene loading, or the name of a library's file (library_name.h), a
    // colon, a texture's name.
    std::string reference;
    std::vector<std::pair<std::string, std::string>> parameters; // name, value as written: "60um", "5"
    double box_minimum_m[3] = {0, 0, 0};                         // the object's bounding box, object space
    double box_maximum_m[3] = {0, 0, 0};
    double footprint_m = 0; // smallest wavelength worth rendering
    // How fast the object's normals turn along its surface (spectral norm of n_dp); infinite where that is not known,
    // and then what is mapped by the normal has no bound of its slope.
    double normal_turn_max_per_m = std::numeric_limits<double>::infinity();
    UvFigures uv = {};
    double servo_period_s = 0; // of the servo that will call it and must not be held up; 0: none
    // Of who asks: relative paths among the values start from it, and so does the search for libraries. Empty: the
    // working directory.
    std::string folder = {};
};

// Either a binding or none and the reason. Diagnostics may hold warnings beside a binding; rendered as text, ready to
// print.
struct TextureResult {
    std::optional<TextureBinding> binding;
    std::string diagnostics;
};

using TextureResolver = std::function<TextureResult(const TextureRequest&)>;

} // namespace haptel
