// The range of heights that a hand is given of a texture: what is proven, or what was found where that says too little.
//
// Interval arithmetic knows little of some textures that hands know well: simplex noise as published stays within 50 um
// and is proven to stay within 16 mm. A surface that is lowered by what is proven would never be felt. So the heights
// are searched as well, by even points and by the gradient uphill from the highest; and where the proof is much wider,
// the range is that of the search with a margin, made true by shoulders (TextureBinding::shoulder_m).
#pragma once

#include "lang/abi/texture_binding.h"

namespace haptel::jit {

// The same for the same binding and request, on any machine. Empty (minimum > maximum) never.
struct FoundHeights {
    double minimum_m, maximum_m;
};
FoundHeights find_heights(const TextureBinding& binding, const TextureRequest& request);

// Sets range and shoulders of a binding, made for this request, whose facts are proven. Whether they are of the search.
bool give_envelope(TextureBinding& binding, const FoundHeights& found);

} // namespace haptel::jit
