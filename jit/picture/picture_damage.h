// Damage that the reader of common pictures takes without a look in some of its releases, and computes with: of what is
// cut off it takes memory that nobody has written.
#pragma once

#include <string_view>

namespace haptel::jit {

// In words, what is wrong; empty: nothing of that kind. Of formats that it does not know nothing is said.
const char* picture_damage(std::string_view bytes);

} // namespace haptel::jit
