// The functions of C text that are no texture's: elementary functions, and what an operation of the IR means where C
// has no operator for it.
#pragma once

#include <string>
#include <string_view>

namespace haptel::emit_c {

// Of these functions those that `text` calls, with what they call, callees first. Every name begins with haptel_.
std::string helpers_for(std::string_view text, bool is_single);

} // namespace haptel::emit_c
