// In which order functions are checked: those that call before those that are called, so that a function knows between
// what its whole numbers lie wherever it is called, and its loops have a bound.
#pragma once

#include "lang/syntax/resolution.h"

#include <deque>
#include <vector>

namespace haptel::lang {

// As far as names and numbers of arguments tell. What is, or is called, in a circle of them stands last and is marked:
// of its calls nothing is known.
std::vector<FunctionInfo*> callers_first(std::deque<FunctionInfo>& functions);

} // namespace haptel::lang
