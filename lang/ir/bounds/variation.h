// How a value varies with the point that is touched: bounds of its first and second derivatives, and how smooth it is.
//
// Derivatives are held twice, because neither form is always the sharper one: as intervals by component (exact for
// affine maps and for what depends on one axis), and as norms (exact for what is known by a bound of its slope only).
#pragma once

#include "lang/ir/bounds/partials.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace haptel::ir {

// What makes a value rough: an operation, something inside of a library function, or a condition that decides between
// two values.
struct Cause {
    Span span;
    std::optional<Op> op;
    bool is_library = false;
};

// One side of a seam (seams.h): which value it is among its like (value_numbers.h).
struct Side {
    uint32_t near = 0;    // in a neighbourhood on that side
    uint32_t there = 0;   // on the seam
    Interval value{0, 0}; // likewise
};

struct Crossing {
    uint32_t seam;
    Side before, after;
    bool is_continuous; // both sides have the same value there
    Cause cause;        // the operation that jumps
};

struct Variation {
    static constexpr size_t directions = 3; // the axes of p

    bool is_active = false; // depends on the point at all; else the rest, but the next two, stays as it is here
    // An entry computes a gradient of it, be it 0 for certain: 0 times what is infinite is not a number.
    bool has_tangent = false;
    bool may_fault = false; // the gradient, as an entry computes it, may be infinite or NaN
    Continuity continuity = Continuity::smooth;
    Cause cause; // of the roughest part
    // Not 0: the value is smooth but where it is 0, as |u|, a length and max(u, 0) are; its powers of 2, 3.. are C1,
    // C2..
    uint32_t kink = 0;                     // which kink: values that share it are 0 in the same places
    uint32_t kink_power = 0;               // of max(u, 0) in it
    std::vector<Crossing> crossings;       // where it jumps, or may, at seams that its class does not speak of
    uint32_t number = 0;                   // which value it is among its like; 0: not known
    std::array<Interval, 3> gradient = {}; // by axis
    std::array<Interval, 6> hessian = {};  // xx xy xz yy yz zz
    double slope = 0;                      // sup of the gradient's Euclidean norm
    double curvature = 0;                  // sup of the Hessian's spectral norm
};

Variation axis(size_t direction); // of p_x, p_y, p_z themselves
Variation unknown_variation(Span where);

// Bounds the norms by the components.
void tighten(Variation& variation);

// Rougher of the two, with its cause.
void roughen(Variation& variation, Continuity continuity, const Cause& cause);
// What depends on an undecided choice that depends on the point jumps with it.
void jump_with(const Variation& choice, Span where, Variation& variation);

// Of what may be either: an `if`, a choice, the lesser of two. Crossings become part of the class, but in `merge`,
// which leaves them out.
Variation join(const Variation& a, const Variation& b);
Variation merge(const Variation& a, const Variation& b);
// Of what is known by two ways.
Variation intersect(const Variation& a, const Variation& b);

// By the chain rule, of a real operation with these partials at its operands; without its curvature, that is 0.
Variation chain(Op op, std::span<const Interval> operands, std::span<const Variation> variations,
                const Partials& partials, bool with_curvature);

// By the chain rule, of a function known by its facts: slope and curvature are norms with respect to these arguments.
Variation chain(const Facts& facts, std::span<const Variation> arguments);

} // namespace haptel::ir
