// The resolver that compiles: what the runtime's scenes ask for textures.
#pragma once

#include "jit/texture/program_cache.h"
#include "lang/abi/texture_binding.h"

namespace haptel::jit {

// Resolves "PATH.haptel:NAME", or "PATH.haptel" where the file holds one texture. The result's diagnostics start with
// the file's name; warnings stand beside a binding. A texture that is too slow for the request's servo is refused with
// the figure. Any thread.
TextureResolver make_resolver(std::shared_ptr<ProgramCache> cache = ProgramCache::shared(),
                              Unbounded unbounded = Unbounded::refused);

} // namespace haptel::jit
