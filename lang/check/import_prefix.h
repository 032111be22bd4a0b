// The prefix of an import is a name of the file: nothing else in it is called so.
#pragma once

#include "lang/check/body_checker.h"

namespace haptel::lang {

// Reports the prefixes in a file that are something else as well; `own` is what the file declares.
void check_prefixes(CheckContext& context, const ast::File& tree, const Declarations& own);

} // namespace haptel::lang
