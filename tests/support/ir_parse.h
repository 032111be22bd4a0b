// Reads the text form of the IR back, so that passes are tested text to text: print(parse(text)) == text for printed
// text.
//
// Grammar (line breaks and blanks only separate; "#" starts a comment):
//
//   module      { table | function | texture }
//   table       "table" string type "[" [ number { "," number } ] "]"      referred to by its position, from 0
//   function    "function" string "(" [ value ":" type { "," value ":" type } ] ")" [ "first" count ] facts
//               "{" { instruction } "return" [ values ] "}"
//   facts       { "minimum" number | "maximum" number | "slope" number | "curvature" number | "continuity" count
//               | "proven" }
//   instruction values "=" ( operation values | "real" number | "i32" number | "u32" number
//               | "bool" ( "true" | "false" ) | "input" name | "parameter" count type | "table" count value
//               | "call" string "(" [ values ] ")" | "if" value "{" arm "}" "else" "{" arm "}"
//               | "for" value "max" count "(" values ")" "from" "(" [ values ] ")" "{" arm "}" )
//   arm         { instruction } "yield" [ values ]
//   values      value { "," value }              value  "%" name
//   texture     "texture" string "{" [ "doc" string ] { parameter } "block" count "reads" count "writes" count
//               [ "body" string ] [ "height" string ] [ "height_gradient" string ] "}"
//   parameter   "parameter" string type number "in" number ".." number "unit" string "offset" count [ "doc" string ]
//
// Reading checks names, types and the number of operands; everything else is verify's.
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
