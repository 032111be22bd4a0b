// Which values are the same number whatever the point: by what they are made of, not by what they evaluate to.
//
// Sums of multiples are written out, and what does not change a result is left out: the sign of an even function's
// argument, whole turns, whole numbers in fract(). Factors that differ by rounding alone count as equal, so that
// "equal" here is equal but for some 1e-11 of the parts. What is not seen as equal is only not known to be.
#pragma once

#include "lang/ir/ir.h"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace haptel::ir {

class ValueNumbers {
public:
    using Number = uint32_t;
    static constexpr Number none = 0;
    struct Part {
        Number number;
        double factor;
    };

    Number unlike_any(bool is_whole = false);
    Number constant(double value) { return sum(value, {}); }
    std::optional<double> constant_of(Number number) const;
    // Of a constant and multiples of these.
    Number sum(double constant, std::initializer_list<Part> parts);
    Number of(Op op, std::span<const Number> operands);
    // Of what is no operation: equal kinds of equal operands are equal.
    enum class Other : uint8_t { input, parameter, table, call };
    Number of(Other kind, uint64_t which, std::span<const Number> operands);

    // factor * mod(of, by) + offset, by value of constants.
    struct Remainder {
        Number of;
        double by, factor, offset;
    };
    std::optional<Remainder> remainder(Number number) const;
    // What `number` is where `place` is `value`: in sums; inside of functions it stays.
    Number where(Number number, Number place, Number value);

private:
    struct Sum {
        double constant = 0;
        std::vector<Part> parts; // ascending
    };
    struct Definition {
        Sum sum; // of itself alone, where it is no other
        bool is_whole = false;
        std::vector<uint64_t> function = {}; // operation and operands, where it is one
    };
    std::vector<Definition> definitions{{Sum{0, {{none, 1}}}}}; // by number
    std::map<std::vector<uint64_t>, Number> known;

    Sum sum_of(Number number) const { return definitions[number].sum; }
    Number of(Sum sum);
    Number function(std::vector<uint64_t> key, bool is_whole = false);
    bool is_function(Number number, Op op) const;
    static void add(Sum& sum, const Sum& other, double factor);
    // Makes the first factor positive; whether that turned the sign.
    static bool turn(Sum& sum);
    // Takes whole numbers away, and gives them.
    Sum take_whole(Sum& sum) const;
    std::optional<Number> periodic(Op op, Number operand);
    std::optional<Number> linear(Op op, std::span<const Number> operands);
    Number product(Op op, Number a, Number b);
    std::optional<Number> written_out(Number a, Number b);
};

} // namespace haptel::ir
