// Elementary functions against 113 bits: no further away than ops.def says, over the whole range, and at the
// edges what C99 says.
#include "bench/elementary_truth.h"
#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"
#include "tests/lang/ir/ir_support.h"
#include "tests/support/tries.h"

#include <cmath>
#include <random>

using namespace ir_test;

namespace {

// The C library's, but for atan2 at the origin.
double of_library(Op op, double a, double b)
{
    return semantics::elementary_value<double>(op, a, b);
}

const std::vector<double>& edges()
{
    constexpr double inf = std::numeric_limits<double>::infinity(), tiny = 0x1p-1074, normal = 0x1p-1022,
                     huge = 0x1.fffffffffffffp1023;
    static const std::vector<double> values = [] {
        std::vector<double> both;
        for (double x :
             {0.0,        tiny,        3 * tiny, normal - tiny, normal, 0x1p-60, 0.25, 0.5,         1 - 0x1p-53,
              1.0,        1 + 0x1p-52, 1.5,      2.0,           3.0,    4.0,     5.0,  1024.0,      0x1p31,
              0x1p52 + 1, 0x1p53 - 1,  0x1p53,   0x1p53 + 2,    0x1p60, huge,    inf,  std::nan("")}) {
            both.push_back(x);
            both.push_back(-x);
        }
        return both;
    }();
    return values;
}

bool has_two_operands(Op op)
{
    return op_info(op).arity == 2;
}

} // namespace

TEST_CASE("elementary functions are what the C standard says at infinities, zeros, NaN and the ends of the range")
{
    for (const Op op : elementary_ops())
        for (const double a : edges())
            for (const double b : has_two_operands(op) ? edges() : std::vector<double>{0}) {
                const double expected = of_library(op, a, b), found = elementary_f64(op, a, b);
                const auto a32 = static_cast<float>(a), b32 = static_cast<float>(b);
                const double of_single = of_library(op, static_cast<double>(a32), static_cast<double>(b32));
                const auto expected32 = static_cast<float>(of_single), found32 = elementary_f32(op, a32, b32);
                CAPTURE(op_info(op).name, a, b, expected, found, expected32, found32);
                const auto is_edge = [](double x, const Quad& exact) {
                    return !std::isfinite(x) || x == 0 || exact == 1 || exact == -1;
                };
                const Quad exact = elementary_truth(op, a, b);
                if (is_edge(expected, exact))
                    CHECK(same(found, expected));
                else
                    CHECK(units_off(found, exact) <= traits(op).ulp);
                if (is_edge(static_cast<double>(expected32),
                            elementary_truth(op, static_cast<double>(a32), static_cast<double>(b32))))
                    CHECK(same(static_cast<double>(found32), static_cast<double>(expected32)));
            }
}

TEST_CASE("elementary functions are as exact as they say, over the whole range")
{
    for (const Op op : elementary_ops()) {
        double worst = 0, worst32 = 0, of_angle = 0;
        for (const auto& [a, b] : elementary_arguments(op, haptel::test::tries(6000))) {
            const double found = elementary_f64(op, a, b), off = units_off(found, elementary_truth(op, a, b));
            const auto a32 = static_cast<float>(a), b32 = static_cast<float>(b);
            const float found32 = elementary_f32(op, a32, b32);
            const double off32 =
                units_off(found32, elementary_truth(op, static_cast<double>(a32), static_cast<double>(b32)));
            CAPTURE(op_info(op).name, a, b, found, off, found32, off32);
            if (!(off <= traits(op).ulp) || !(off32 <= traits(op).ulp)) FAIL("too far away");
            worst = std::max(worst, off);
            worst32 = std::max(worst32, off32);
            if (!takes_angle(op)) continue;
            const float narrowed = elementary_f32_of_angle(op, a);
            of_angle = std::max(of_angle, units_off(narrowed, elementary_truth(op, a, b)));
        }
        CAPTURE(op_info(op).name, worst, worst32, of_angle);
        CHECK((worst > 0.5 && worst32 > 0.45)); // there was something to see
        CHECK(of_angle <= traits(op).ulp);
    }
}

TEST_CASE("elementary functions keep the symmetry of what they stand for")
{
    for (const Op op : elementary_ops()) {
        const bool is_odd = op == Op::sin || op == Op::tan || op == Op::asin || op == Op::atan || op == Op::sinh ||
                            op == Op::tanh || op == Op::asinh || op == Op::atanh;
        const bool is_even = op == Op::cos || op == Op::cosh;
        if (!is_odd && !is_even) continue;
        for (const auto& [a, b] : elementary_arguments(op, 300)) {
            CAPTURE(op_info(op).name, a);
            CHECK(same(elementary_f64(op, -a), is_odd ? -elementary_f64(op, a) : elementary_f64(op, a)));
        }
    }
}

TEST_CASE("elementary functions fall by no more than a unit in the last place from one double to the next where they "
          "should rise")
{
    for (const Op op : elementary_ops()) {
        if (traits(op).shape != Shape::rising) continue;
        for (const auto& [a, b] : elementary_arguments(op, haptel::test::tries(2000))) {
            const double next = std::nextafter(a, HUGE_VAL), below = elementary_f64(op, a),
                         above = elementary_f64(op, next);
            CAPTURE(op_info(op).name, a, below, above);
            if (below == below && above == above) CHECK(above >= std::nextafter(below, -HUGE_VAL));
        }
    }
}
