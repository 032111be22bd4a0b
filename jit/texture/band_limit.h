// Whether a footprint takes anything away from a texture.
#pragma once

#include "lang/abi/texture_binding.h"

namespace haptel::jit {

// True if the height of the binding, made for this request, is another one without its footprint at any of up to
// 32 places of the box: octaves are faded or left out.
bool is_band_limited(const TextureBinding& binding, const TextureRequest& request);

} // namespace haptel::jit
