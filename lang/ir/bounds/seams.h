// Seams: the places where an operation jumps, as floor() does at whole numbers, and what comes of a value on both
// sides.
//
// A texture made of cells is computed from fract(), floor(), round() or a condition, each of which jumps, and yet its
// height need not. Beside a seam each value that depends on the jump is followed twice, before and after it, as a
// number (value_numbers.h) and an interval. Where both sides are the same in a neighbourhood the seam is none of that
// value; where they are the same on the seam the value is continuous there.
//
// Seams are taken one at a time, all others held as they are: where two meet, one after the other is crossed, and what
// is equal for every value of the other one is equal at both of its sides.
#pragma once

#include "lang/ir/bounds/value_numbers.h"
#include "lang/ir/bounds/variation.h"

#include <functional>

namespace haptel::ir {

// The crossings as part of the class: a jump, or a kink.
Variation settled(Variation variation);
// Tells conditions of the place where they choose.
void choose_at(Span span, Variation& variation);

class Seams {
public:
    using Number = ValueNumbers::Number;
    struct Operand {
        Number number;
        Interval value;
        std::span<const Crossing> crossings;
        bool is_real;
    };
    // What a function makes of its operands: as an interval, and as a number, for which it may be told by such values
    // of them which one it is.
    using ValueOf = std::function<Interval(std::span<const Interval>)>;
    using NumberOf = std::function<Number(std::span<const Number>, std::span<const Interval>)>;

    ValueNumbers numbers;

    // Lives as long as the variation.
    Operand operand(const Variation& variation, const Interval& value, Type type);
    // Number and crossings of a result.
    void cross(std::span<const Operand> operands, const Interval& result, const NumberOf& number, const ValueOf& value,
               Variation& made);
    void cross(Op op, std::span<const Operand> operands, const Interval& result, Variation& made);
    // The seam of an operation that jumps where its operands move. False: it has none that can be followed.
    bool begin(Op op, std::span<const Operand> operands, const Interval& result, const Cause& cause, Variation& made);
    // Where a condition `a < b` changes; nothing if it has no seam.
    std::optional<uint32_t> of_condition(Number a, Number b);

private:
    struct Seam {
        Number place, value; // the former is the latter there: 0, or a whole number, whichever
    };
    std::vector<Seam> seams;
    std::map<std::pair<Number, bool>, uint32_t> by_place; // and whether it is 0 there

    Number of(Op op, Number a, Number b);
    uint32_t seam_at(Number place, bool is_zero = false);
    Side side_of(const Seam& seam, Number near, const Interval& value);
};

} // namespace haptel::ir
