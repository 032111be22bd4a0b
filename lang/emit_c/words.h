// Numbers, strings, comments and names as C99 and C++ both read them.
#pragma once

#include "lang/ir/ir.h"

#include <string>
#include <string_view>

namespace haptel::emit_c {

// The same bits once a compiler has read it; behind a sign in parentheses. `is_single`: rounded to float.
std::string literal(double value, bool is_single = false);
std::string literal(uint32_t word);

std::string quoted(std::string_view text);

// Text that does not end the comment it stands in; its lines begin with `margin`.
std::string in_comment(std::string_view text, std::string_view margin);

// A parameter as a member of its texture's block: its own name, but for components (size.x: size_x); with a '_' behind
// it where it is a word of C or C++, or another parameter's name.
std::string member_name(const ir::Texture& texture, const ir::Parameter& parameter);

} // namespace haptel::emit_c
