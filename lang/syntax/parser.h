// Text to tree, with recovery: always returns a tree, however broken the text; what is wrong goes to the diagnostics.
#pragma once

#include "lang/syntax/ast.h"
#include "lang/text/diagnostic.h"
#include "lang/text/lexer.h"

namespace haptel::lang {

ast::File parse(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics);
// Of tokens of that file.
ast::File parse(const SourceSet& sources, uint32_t file, TokenList tokens, Diagnostics& diagnostics);

} // namespace haptel::lang
