// What the tests of the IR share: running functions over double and over 113 bits, and the difference quotient that is
// the truth about a derivative.
#pragma once

#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/cost.h"
#include "lang/ir/run/interpret.h"
#include "lang/ir/verify.h"
#include "lang/math/quad.h"
#include "tests/support/catch.h"
#include "tests/support/ir_parse.h"

#include <bit>
#include <optional>

namespace ir_test {

using namespace haptel::ir;

inline Module parsed(std::string_view text)
{
    ParsedModule result = parse(text);
    INFO(result.error);
    REQUIRE(result.module.has_value());
    return std::move(*result.module);
}

// Equal bits; every NaN equals every NaN.
inline bool same(double a, double b)
{
    return (a != a && b != b) || std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
}

// Results of one function, by two ways: the half of a slot that its type does not use is not compared.
inline bool same(const Function& function, size_t result, const Slot<double>& a, const Slot<double>& b)
{
    return function.type(function.body.yields[result]) == Type::real ? same(a.real, b.real) : a.bits == b.bits;
}

template <typename T>
std::vector<Slot<T>> slots_of(std::span<const double> values)
{
    std::vector<Slot<T>> slots;
    for (double value : values) slots.push_back({T(value), 0});
    return slots;
}

// Reals only.
inline std::vector<double> call(const Module& module, uint32_t function, std::vector<double> arguments)
{
    Interpreter<double> interpreter(module);
    std::vector<double> results;
    for (const Slot<double>& slot : interpreter.run(function, slots_of<double>(arguments), nullptr))
        results.push_back(slot.real);
    return results;
}

// Intervals of every result of a function that is no entry.
inline std::vector<Interval> bounds_of(const Module& module, uint32_t function, std::vector<Interval> arguments)
{
    return IntervalEvaluator(module, 1'000'000).run(function, arguments, nullptr);
}

// Derivative of every result with respect to argument `which`, by central differences of the 113-bit function at step h
// and h / 2 and one Richardson step: about 20 digits. Nothing where the stencil meets different decisions or the
// function is not finite.
std::optional<std::vector<Quad>> difference(Interpreter<Quad>& oracle, uint32_t function,
                                            std::vector<Slot<Quad>> arguments, size_t which);

} // namespace ir_test
