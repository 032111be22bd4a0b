// From checked trees to IR: one IR function per source function and the functions passed to it, as far as textures
// reach them; vectors split into scalars, early returns and breaks into flags and nesting, inputs into parameters.
#pragma once

#include "lang/ir/ir.h"
#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

#include <string_view>

namespace haptel::lang {

// The program must have passed the checker without error. `only_texture` empty: all textures. What can only be seen
// here (cost, depth) is reported; the module is then not to be used.
ir::Module lower(const CheckedProgram& program, std::string_view only_texture, Diagnostics& diagnostics);

} // namespace haptel::lang
