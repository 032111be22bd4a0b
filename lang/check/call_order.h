// In which order functions are checked: those that call before those that are called, so that a function knows between
// what its whole numbers lie wherever it is called, and its loops have a bound.
#pragma once

#include "lang/syntax/resolution.h"

#include <deque>
#include <vector>

namespace haptel::lang {

// As far as names tell; functions that call each other in a circle, which is a mistake, stand last.
std::vector<FunctionInfo*> callers_first(std::deque<FunctionInfo>& functions);

} // namespace haptel::lang
