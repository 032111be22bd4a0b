// A value as a polynomial of few others that sums, differences and products make it of. Where one of these stands in it
// more than once, as t in a * (1 - t) + b * t and f in f * f * (3 - 2 * f), the polynomial knows what the intervals of
// the operands do not: that it is the same each time. Nor do they know that a sine and a cosine of one angle lie on a
// circle: x * cos(a) + y * sin(a) is no more than length(vec2(x, y)), whatever the angle.
#pragma once

#include "lang/ir/bounds/interval.h"
#include "lang/ir/ir.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace haptel::ir {

class Polynomial {
public:
    // Nothing where no part stands in it twice, and no two are of a circle, or where it is none that range() knows.
    // `makers` by Value::index.
    static std::optional<Polynomial> of(std::span<const Instruction* const> makers, Value whole);

    // All that it can be where each value, by Value::index, lies in its interval: as exact numbers would have it, and
    // as far around as code may be off that. Nothing where they are not finite.
    std::optional<Interval> range(std::span<const Interval> values) const;

private:
    static constexpr size_t parts_max = 16;
    static constexpr size_t degree_max = 8;           // of one part alone
    static constexpr size_t corners_max = 6;          // parts that multiply others: two ends of each are looked at
    static constexpr double least_magnitude = 1e-250; // of a coefficient: far above where numbers lose their digits

    struct Coefficient {
        double factor = 0, magnitude = 0; // the latter: the sum of what the former was made of, without signs
    };
    struct Alone {
        Value part;
        Coefficient times;
    };

    class Expansion;
    struct Term;
    bool set(std::span<const Value> parts, std::span<const Term> terms, size_t of_circle);
    Interval of_one_part(const Interval& at) const;
    Interval of_corners(std::span<const Interval> values) const;
    double magnitude(std::span<const Interval> values) const;

    std::vector<Value> parts; // the one whose powers it is made of, or those that stand in products, none squared
    // By power, or by which of the parts a product is made of, a bit each.
    std::vector<Coefficient> coefficients;
    std::vector<Alone> alone; // what is added besides, and stands in no product
    bool is_of_powers = false;
    bool has_circle = false; // the first two parts are a cosine and the sine beside it
    uint32_t operations = 0; // of the code, and of the above
};

} // namespace haptel::ir
