// The operations of the intermediate representation over balls, where they are more than arithmetic of balls.
#include "lang/ir/run/interpret_machine.h"
#include "tests/support/ball_arithmetic.h"

#include <algorithm>

// What double does at once, and would seem worse if it were put together from balls.
namespace haptel::ir::exact {

template <>
test::Ball atan2(const test::Ball& y, const test::Ball& x)
{
    const bool is_origin = y.middle == 0 && x.middle == 0;
    const bool is_exact = y.radius == 0 && x.radius == 0;
    return is_origin ? test::Ball(0, is_exact ? 0 : 7) : test::atan2(y, x);
}

} // namespace haptel::ir::exact

namespace haptel::ir::semantics {

using test::Ball, test::are_apart, test::rounded;

template <>
bool is_nan(const Ball& a)
{
    return is_nan(a.middle);
}

template <>
bool is_finite(const Ball& a)
{
    test::decide(is_finite(a.radius));
    return is_finite(a.middle);
}

template <>
Ball minimum(const Ball& a, const Ball& b)
{
    test::decide(are_apart(a, b));
    const Quad middle = minimum(a.middle, b.middle);
    if (are_apart(a, b)) return {middle, a.middle < b.middle ? a.radius : b.radius};
    return {middle, std::max(a.radius, b.radius)};
}

template <>
Ball maximum(const Ball& a, const Ball& b)
{
    return -minimum(Ball(-a), Ball(-b));
}

template <>
Ball round_to_even(const Ball& a)
{
    return test::of_steps(a, [](const Quad& x) { return round_to_even(x); });
}

template <>
Ball fused_multiply_add(const Ball& a, const Ball& b, const Ball& c)
{
    return rounded(a.middle * b.middle + c.middle, test::reach_of_product(a, b) + c.radius);
}

// Its gradient has length 1. Rounded are squares, sums and root: no more than 4 half ulps for four of them.
template <>
Ball length(const Ball* x, int count)
{
    Quad middles[4], squares = 0;
    for (int i = 0; i < count; ++i) {
        middles[i] = x[i].middle;
        squares += x[i].radius * x[i].radius;
    }
    return rounded(length(middles, count), sqrt(squares), 4);
}

// Beside the sine's own rounding: of 2 pi, and of the product with it.
template <>
Ball sine_of_turns(const Ball& a)
{
    const Quad reach = two_pi<Quad>() * a.radius;
    return rounded(sine_of_turns(a.middle), reach <= 2 ? reach : Quad(2), test::library + 3);
}

template <>
Ball cosine_of_turns(const Ball& a)
{
    const Quad reach = two_pi<Quad>() * a.radius;
    return rounded(cosine_of_turns(a.middle), reach <= 2 ? reach : Quad(2), test::library + 3);
}

template <>
uint32_t to_i32(const Ball& a)
{
    test::decide(to_i32(test::low(a)) == to_i32(test::high(a)));
    return to_i32(a.middle);
}

template <>
uint32_t to_u32(const Ball& a)
{
    test::decide(to_u32(test::low(a)) == to_u32(test::high(a)));
    return to_u32(a.middle);
}

} // namespace haptel::ir::semantics

namespace haptel::ir {

template class Interpreter<test::Ball>;

} // namespace haptel::ir
