// What is known of a texture: proven, as the C interface carries it; and seen, by calls at random places of an object.
#pragma once

#include "jit/texture/texture.h"
#include "lang/ir/bounds/spline_image.h"

#include <functional>
#include <span>
#include <string>

namespace haptel::jit {

// For every point and all values within the parameters' ranges. Where they are not wanted, nothing is known but the
// operations: their count costs nothing.
haptel_facts facts_over_ranges(const ir::Module& module, const ir::Texture& texture, bool are_wanted);

// For points of the box, these values and images (by Texture::parameters, SI), this footprint, and normals and mesh
// coordinates as the request knows them. Bounds of slope and curvature take up to a thousand times as long as those of
// heights, which are all that a hand needs: those take up to 15 ms or, at once, one evaluation.
enum class Bounded : uint8_t { heights, heights_at_once, all };
// Of heights alone: where the least and the greatest may be, if the bounds are true.
struct LikelyPlaces {
    haptel_point lowest{}, highest{};
};
// To be called while the module is there; takes up to 8 ms.
using FindPlaces = std::function<LikelyPlaces()>;
haptel_facts facts_over_box(const ir::Module& module, const ir::Texture& texture, std::span<const double> values,
                            std::span<const ir::SplineImage* const> images, const haptel_block_head& head,
                            const TextureRequest& request, Bounded what, FindPlaces* places = nullptr);

// True if the height of the binding, made for this request, is another one without its footprint at any of up to
// 32 places: octaves are faded or left out.
bool is_band_limited(const TextureBinding& binding, const TextureRequest& request);

// What one call of the binding's height_gradient takes, at places of the request's object: as many calls as fit into
// `patience_s`, or a few.
double median_call_s(const TextureBinding& binding, const TextureRequest& request, double patience_s = 3e-3);

// Why this binding of that program, made for this request, is too slow for the request's servo, with the figure
// measured; empty: it is not, or no servo waits for it. Code is optimised before it is refused. Faults the code's and
// the block's pages in on the way.
std::string too_slow(const CompiledProgram& program, const TextureBinding& binding, const TextureRequest& request);

} // namespace haptel::jit
