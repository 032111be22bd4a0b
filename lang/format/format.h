// Source text in the one style of the language.
//
// Works on tokens and the comments between them, which it neither adds, drops nor moves past one another: what is
// printed means what was read. Formatting twice changes nothing.
#pragma once

#include "lang/text/diagnostic.h"

#include <optional>
#include <string>

namespace haptel::lang {

// Nothing where the text is not Haptel; `diagnostics` then says why.
std::optional<std::string> format(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics);

} // namespace haptel::lang
