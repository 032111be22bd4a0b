// How a statement can end, on some path: by going on, by returning, by leaving the loop or switch round it or the
// loop's turn.
#pragma once

#include "lang/syntax/ast.h"

#include <span>
#include <vector>

namespace haptel::lang {

struct Completion {
    bool falls_through = false, returns = false, breaks = false, continues = false;
    bool may_leave() const { return returns || breaks || continues; }
    void add(const Completion& other) // that way too
    {
        returns |= other.returns;
        breaks |= other.breaks;
        continues |= other.continues;
    }
};

Completion completion_of(const ast::Statement& s);
Completion completion_of(std::span<const ast::StatementPtr> statements);

// Slots of variables that are assigned in statements that follow each other, and declared outside of them; sorted.
std::vector<uint32_t> changed_in(std::span<const ast::Statement* const> statements);

} // namespace haptel::lang
