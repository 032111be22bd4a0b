// The range of heights that a hand is given of a texture: what is proven, or what was found where that says too little.
//
// Interval arithmetic knows little of some textures that hands know well: simplex noise as published stays within 50 um
// and is proven to stay within 16 mm. A surface that is lowered by what is proven would never be felt. So the heights
// are searched as well: by even points, where the proof says that its ends may be, and by the gradient uphill from the
// highest. Where the proof is much wider, and so much that a hand would have to press for it, the range is that of the
// search with a margin, made true by shoulders (TextureBinding::shoulder_m).
#pragma once

#include "jit/texture/facts.h"
#include "lang/abi/texture_binding.h"

namespace haptel::jit {

// The same for the same binding and request, on any machine. Its facts are proven.
FoundHeights find_heights(const TextureBinding& binding, const TextureRequest& request, const LikelyPlaces& places);

// Sets range and shoulders of a binding whose facts are proven. Whether an end is one of the search.
bool give_envelope(TextureBinding& binding, const FoundHeights& found);

} // namespace haptel::jit
