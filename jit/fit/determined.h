// Which parameters a fit has found, and which could as well have another value.
#pragma once

#include "jit/fit/fit.h"
#include "jit/fit/search.h"

#include <span>
#include <vector>

namespace haptel::jit {

// `all`: what the search found, the best first.
std::vector<Undetermined> undetermined(Unknowns& unknowns, Misfit& misfit, const haptel_texture& texture,
                                       std::span<const Found> all);

} // namespace haptel::jit
