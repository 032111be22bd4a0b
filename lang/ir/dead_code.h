// What results depend on: instructions, results of `if`, carried values of loops.
#pragma once

#include "lang/ir/ir.h"

#include <map>
#include <utility>
#include <vector>

namespace haptel::ir {

// What some results of a module's functions are made from, through calls; worked out as it is asked for.
class NeededValues {
public:
    explicit NeededValues(const Module& of) : module(of) {}
    // By Value::index: whether one of those results of the function is made from it.
    const std::vector<bool>& of(uint32_t function, const std::vector<bool>& results);

private:
    const Module& module;
    std::map<std::pair<uint32_t, std::vector<bool>>, std::vector<bool>> known;
};

// Removes what no result depends on. Renumbers values densely, in order of appearance.
void remove_dead_code(Function& function);

} // namespace haptel::ir
