// In which order files and functions are checked. Files: those that are imported before those that import them.
// Functions: those that call before those that are called, so that a function knows between what its whole numbers lie
// wherever it is called, and its loops have a bound.
#pragma once

#include "lang/program/checked_program.h"

#include <deque>
#include <vector>

namespace haptel::lang {

// As far as names and numbers of arguments tell. What is, or is called, in a circle of them stands last and is marked:
// of its calls nothing is known.
std::vector<FunctionInfo*> callers_first(std::deque<FunctionInfo>& functions);

// Indices of files. Where files import each other, which is told, some order.
std::vector<uint32_t> imported_first(const std::vector<CheckFile>& files);

} // namespace haptel::lang
