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

struct Side {
    ValueNumbers::Number near = ValueNumbers::none;  // in a neighbourhood on that side
    ValueNumbers::Number there = ValueNumbers::none; // on the seam
    Interval value{0, 0};                            // likewise
};

struct Crossing {
    uint32_t seam;
    Side before, after;
    bool is_continuous; // both sides have the same value there
    Cause cause;        // the operation that jumps
};

// The crossings as part of the class: a jump, or a kink.
Variation settled(Variation variation);
// With conditions told of the place where they choose.
Variation chosen_at(Variation variation, Span span);
// Without that of one seam.
Variation without(Variation variation, uint32_t seam);

class Seams {
public:
    using Number = ValueNumbers::Number;
    struct Operand {
        Number number;
        Interval value;
        std::shared_ptr<const std::vector<Crossing>> crossings;
        bool is_real;
    };
    // What a function makes of its operands, as numbers and as intervals.
    using NumberOf = std::function<Number(std::span<const Number>)>;
    using ValueOf = std::function<Interval(std::span<const Interval>)>;
    // Which operand the result is, for such values of them; nothing: none. `on_seam`: not only beside it.
    using ChoiceOf = std::function<std::optional<size_t>(std::span<const Interval>, bool on_seam)>;

    ValueNumbers numbers;

    Operand operand(const Variation& variation, const Interval& value, Type type);
    // Number and crossings of a result.
    void cross(std::span<const Operand> operands, const Interval& result, const NumberOf& number, const ValueOf& value,
               const ChoiceOf& choice, Variation& made);
    void cross(Op op, std::span<const Operand> operands, const Interval& result, Variation& made);
    // The seam of an operation that jumps where its operands move. False: it has none that can be followed.
    bool begin(Op op, std::span<const Operand> operands, const Interval& result, const Cause& cause, Variation& made);
    // Where a condition `a < b` changes; nothing if it has no seam.
    std::optional<uint32_t> of_condition(Number a, Number b);

private:
    struct Seam {
        Number place, value; // the former is the latter there
        Number index;        // a whole number: of the seam among its like
    };
    enum class Kind : uint8_t { whole, half, zero };
    std::vector<Seam> seams;
    std::map<std::pair<Kind, Number>, uint32_t> by_place;

    uint32_t seam_at(Kind kind, Number place);
    Side side_of(const Seam& seam, Number near, const Interval& value);
};

} // namespace haptel::ir
