// How a value varies with the point that is touched: bounds of its first and second derivatives, and how smooth it is.
//
// Derivatives are held twice, because neither form is always the sharper one: as intervals by component (exact for
// affine maps and for what depends on one axis), and as norms (exact for what is known by a bound of its slope only).
#pragma once

#include "lang/ir/bounds/partials.h"

#include <array>
#include <optional>
#include <span>

namespace haptel::ir {

// What makes a value rough: an operation, something inside of a library function, or a condition that decides between
// two values.
struct Cause {
    Span span;
    std::optional<Op> op;
    bool is_library = false;
};

struct Variation {
    static constexpr size_t directions = 3; // the axes of p

    bool is_active = false; // depends on the point at all; else the rest, but the next two, stays as it is here
    // An entry computes a gradient of it, be it 0 for certain: 0 times what is infinite is not a number.
    bool has_tangent = false;
    bool may_fault = false; // the gradient, as an entry computes it, may be infinite or NaN
    Smoothness smoothness = Smoothness::smooth;
    Cause cause; // of the roughest part
    // Not 0: the value is smooth but where it is 0, as |u|, a length and max(u, 0) are; its powers of 2, 3.. are C1,
    // C2..
    uint32_t kink = 0;       // which kink: values that share it are 0 in the same places
    uint32_t kink_power = 0; // of max(u, 0) in it
    // The value jumps by multiples of this alone, as fract and mod do, and is so smooth between: whole jumps are none
    // to what repeats with every whole number. Where it only jumps between `from` and from + by, and these lie as far
    // from 0, they are one and the same to |value|.
    struct Wrap {
        double by;
        std::optional<double> from;
        Smoothness between;
    };
    std::optional<Wrap> wrap;
    std::array<Interval, 3> gradient = {}; // by axis
    std::array<Interval, 6> hessian = {};  // xx xy xz yy yz zz
    double slope = 0;                      // sup of the gradient's Euclidean norm
    double curvature = 0;                  // sup of the Hessian's spectral norm
};

Variation axis(size_t direction); // of p_x, p_y, p_z themselves
Variation unknown_variation(Span where);

// Rougher of the two, with its cause.
void roughen(Variation& variation, Smoothness smoothness, const Cause& cause);

// How smooth it is but for jumps by whole numbers.
Smoothness smoothness_but_for_turns(const Variation& variation);

// Of what may be either: an `if`, a choice, the lesser of two.
Variation join(const Variation& a, const Variation& b);
// Of what is known by two ways.
Variation intersect(const Variation& a, const Variation& b);

// By the chain rule, of a real operation with these partials at its operands. Without `second` the Hessian is left out.
Variation chain(Op op, std::span<const Interval> operands, std::span<const Variation> variations,
                const Partials& partials, bool second);

// By the chain rule, of a function known by its facts: slope and curvature are norms with respect to these arguments.
Variation chain(const Facts& facts, std::span<const Variation> arguments);

} // namespace haptel::ir
