// Text form of the IR, printable and parseable: print(parse(text)) == text for printed text. Passes are tested text to
// text. The grammar stands at the top of parse.cpp.
#pragma once

#include "lang/ir/ir.h"

#include <optional>
#include <string>
#include <string_view>

namespace haptel::ir {

std::string print(const Module& module);
std::string print(const Module& module, const Function& function);

struct ParsedModule {
    std::optional<Module> module;
    std::string error; // "line 3: unknown operation 'ad', did you mean 'add'?"; empty if module is set
};
ParsedModule parse(std::string_view text);

} // namespace haptel::ir
