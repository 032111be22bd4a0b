// Applies what the compiler proposes, so that nothing gets worse.
#pragma once

#include "lang/compile.h"

#include <functional>
#include <string>
#include <vector>

namespace haptel::tools {

// The fix-its for file 0, from its beginning on; of fixes that overlap the first is taken.
std::vector<lang::FixIt> fixes_of(const lang::CompileResult& result);

// `text` with fixes as fixes_of gives them.
std::string apply_fixes(const std::string& text, const std::vector<lang::FixIt>& fixes);

struct Mended {
    std::string text;
    size_t applied = 0;
    size_t left_out = 0; // fixes that would have led to more findings than they mend
};

// Applies fixes until none is left: what was hidden behind one mistake shows when it is mended. `compile` says what is
// found in a text, with warnings as warnings.
Mended mend(std::string text, const std::function<lang::CompileResult(const std::string&)>& compile);

} // namespace haptel::tools
