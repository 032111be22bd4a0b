// How a statement can end, on some path: by going on, by returning, by leaving the loop round it.
#pragma once

#include "lang/ast.h"

#include <span>
#include <vector>

namespace haptel::lang {

struct Outcome {
    bool falls_through = false, returns = false, breaks = false;
    bool may_leave() const { return returns || breaks; }
};

Outcome outcome(const ast::Statement& s);
Outcome outcome(std::span<const ast::StatementPtr> statements);

// Slots of variables that are assigned in a statement and declared outside of it; appended.
void collect_changed(const ast::Statement& s, std::vector<uint32_t>& slots);

} // namespace haptel::lang
