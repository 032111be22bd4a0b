// First and second partial derivatives of operations over intervals, from the rules of derivative_rules.cpp: each
// needed case is differentiated once into a straight line of operations, which is then evaluated for every operand box.
#pragma once

#include "lang/ir/bounds/interval.h"

#include <map>
#include <tuple>

namespace haptel::ir {

constexpr size_t operands_max = 4;

struct Partials {
    Interval first[operands_max];
    Interval second[operands_max][operands_max]; // symmetric
    bool may_fault[operands_max] = {};           // the first, as code computes it, may be infinite or NaN
};

class PartialRules {
public:
    // Of a real operation of reals with this result, with respect to the operands whose bit is set in `active`; the
    // others are left 0. May be infinite where the true derivative has no bound. The second are left 0 unless they are
    // wanted.
    Partials of(Op op, std::span<const Interval> operands, const Interval& result, uint32_t active, bool with_second);

private:
    struct Rule {
        Function line;
        std::vector<std::pair<uint32_t, Value>> first;             // operand, where
        std::vector<std::tuple<uint32_t, uint32_t, Value>> second; // operand, operand, where
    };
    std::map<std::tuple<Op, uint32_t, bool>, Rule> rules;
    std::vector<Interval> values; // of one evaluation; kept for its memory

    static Rule differentiated(Op op, uint32_t active, bool with_second);
};

} // namespace haptel::ir
