// Applies what the compiler proposes.
#pragma once

#include "lang/diagnostic.h"

#include <string>

namespace haptel::tools {

struct FixedText {
    std::string text;
    size_t applied = 0;
};

// The fix-its of the findings in file `file`; of fixes that overlap the first is
// taken.
FixedText apply_fixes(const std::string& text, uint32_t file, const lang::Diagnostics& diagnostics);

} // namespace haptel::tools
