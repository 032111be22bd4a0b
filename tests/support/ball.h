// A number as double, or float, may have it: the exact one, and how far rounding may lead away from it.
//
// The interpreter over balls gives, beside the 113-bit truth, a bound of |double - truth| that holds for every engine
// that rounds each operation once: no constant is chosen by what was measured. It holds where both take the same
// decisions (Interpreter::decisions); where a ball lets a decision fall either way, Ball::undecided says so, sticky and
// per thread as the flags of floating-point exceptions are.
#pragma once

#include "lang/ir/run/interpret.h"
#include "lang/math/quad.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace haptel::test {

using ir::Quad;

struct Ball {
    Quad middle = 0, radius = 0; // radius: infinite where nothing is known, as beyond the range of double

    Ball() = default;
    template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
    Ball(Number exact) : middle(exact)
    {
        if (!in_singles || !std::isfinite(static_cast<double>(exact))) return;
        const double off = std::fabs(static_cast<double>(static_cast<float>(exact)) - static_cast<double>(exact));
        radius = std::isfinite(off) ? Quad(off) : std::numeric_limits<Quad>::infinity();
    }
    Ball(const Quad& around, const Quad& reach) : middle(around), radius(reach) {}

    explicit operator double() const { return static_cast<double>(middle); }
    explicit operator int32_t() const { return static_cast<int32_t>(middle); }
    explicit operator uint32_t() const { return static_cast<uint32_t>(middle); }

    // Whether double may have this for the exact `middle`.
    bool may_be(double found) const;

    static thread_local bool undecided;  // since somebody set it to false
    static thread_local bool in_singles; // what is made from now on may be rounded to f32
};

} // namespace haptel::test

namespace haptel::ir {
extern template class Interpreter<test::Ball>;
}
