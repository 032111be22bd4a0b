// The range of heights that a hand is given of a texture: what is proven, or what was found where that says too little.
//
// Interval arithmetic knows little of some textures that hands know well: simplex noise as published stays within 50 um
// and is proven to stay within 16 mm. A surface that is lowered by what is proven would never be felt. So the heights
// are searched as well: by even points, where the proof says that its ends may be, and by the gradient uphill from the
// highest. Where the proof is much wider, and so much that a hand would have to press for it, the range is that of the
// search with a margin, made true by shoulders (TextureBinding::shoulder_m). Of most textures a few places show that
// the proof will do: then no more of them are looked at, and a parameter that is set is felt at once.
#pragma once

#include "jit/texture/facts.h"
#include "lang/abi/texture_binding.h"

namespace haptel::jit {

// How far: up to where it is clear that no envelope will be given, or to the end in any case.
enum class Search : uint8_t { until_clear, to_the_end };
// The same for the same binding and request, on any machine. Its facts are proven.
FoundHeights find_heights(const TextureBinding& binding, const TextureRequest& request, const FindPlaces& places,
                          Search how_far);

// Sets range and shoulders of a binding whose facts are proven. Whether an end is one of the search.
bool give_envelope(TextureBinding& binding, const FoundHeights& found);

// The same at once, after `before`, which has the envelope of other values. What was proven well is taken to be so
// again; a range that was found is stretched as the heights at a few places are. False: nothing can be said.
bool stretch_envelope(TextureBinding& binding, const TextureBinding& before, const TextureRequest& request);

} // namespace haptel::jit
