// Text to tree, with recovery: always returns a tree, however broken the text; what is wrong goes to the diagnostics.
#pragma once

#include "lang/ast.h"
#include "lang/diagnostic.h"

namespace haptel::lang {

ast::File parse(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics);

} // namespace haptel::lang
