// The version of the language that this Haptel reads: what `language 1;` at the beginning of a file, and `language = 1`
// of a library, ask for.
#pragma once

#include <cstdint>

namespace haptel {

inline constexpr uint32_t language_version = 1;

} // namespace haptel
