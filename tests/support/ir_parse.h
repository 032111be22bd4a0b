// Reads the text form of the IR back, so that passes are tested text to text: print(parse(text)) == text for printed
// text. The grammar stands at the top of ir_parse.cpp.
#pragma once

#include "lang/ir/ir.h"
#include "lang/ir/print.h"

#include <optional>
#include <string>
#include <string_view>

namespace haptel::ir {

struct ParsedModule {
    std::optional<Module> module;
    std::string error; // "line 3: unknown operation 'ad', did you mean 'add'?"; empty if module is set
};
ParsedModule parse(std::string_view text);

} // namespace haptel::ir
