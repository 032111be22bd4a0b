// Intervals of single operations and of programs hold every value, and are not needlessly wide.
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/op_info.h"
#include "tests/lang/ir/ir_random.h"
#include "tests/lang/ir/ir_support.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace ir_test;

namespace {

// A slot's value as intervals see it.
double number(Type type, const Slot<double>& slot)
{
    if (type == Type::real) return slot.real;
    return type == Type::i32 ? static_cast<double>(static_cast<int32_t>(slot.bits)) : static_cast<double>(slot.bits);
}
Slot<double> slot(Type type, double value)
{
    if (type == Type::real) return {value, 0};
    return {0, type == Type::i32 ? static_cast<uint32_t>(static_cast<int32_t>(value)) : static_cast<uint32_t>(value)};
}

bool holds(const Interval& interval, double value)
{
    return value != value ? interval.may_be_nan : interval.contains(value);
}

class Sampler {
public:
    explicit Sampler(uint32_t seed) : random(seed) {}

    Interval interval(Type type)
    {
        if (type == Type::boolean) {
            double a = below(2), b = below(2);
            return {std::min(a, b), std::max(a, b)};
        }
        double a = edge(type), b = below(3) ? edge(type) : a;
        const bool may_be_nan = type == Type::real && below(6) == 0;
        if (may_be_nan && below(4) == 0) return {infinity, -infinity, true};
        return {std::min(a, b), std::max(a, b), may_be_nan};
    }
    double inside(const Interval& interval, Type type)
    {
        if (interval.is_empty() || (interval.may_be_nan && below(3) == 0)) return std::nan("");
        const uint32_t how = below(5);
        if (how == 0) return interval.minimum;
        if (how == 1) return interval.maximum;
        const double low = std::max(interval.minimum, -1e6), high = std::min(interval.maximum, 1e6);
        if (low > high) return interval.minimum;
        double value = std::uniform_real_distribution(low, std::nextafter(high, infinity))(random);
        if (type != Type::real) value = std::floor(value);
        if (type == Type::real && how == 2 && low <= std::round(value) && std::round(value) <= high)
            value = std::round(value);
        return std::clamp(value, interval.minimum, interval.maximum);
    }
    uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random() % limit); }

private:
    std::mt19937 random;

    double edge(Type type)
    {
        if (type == Type::real) {
            const double edges[] = {0.0, -0.0, 1,      -1,      0.5,   2,        -2.5,     3,
                                    100, -1e5, 1e-310, -5e-324, 1e300, infinity, -infinity};
            return below(3) ? std::uniform_real_distribution(-4.0, 4.0)(random) : edges[below(std::size(edges))];
        }
        const Interval all = everything(type);
        const double edges[] = {all.minimum, all.maximum, 0, 1, -1, 2, 7, 31, 100};
        return std::clamp(edges[below(std::size(edges))], all.minimum, all.maximum);
    }
};

} // namespace

TEST_CASE("intervals: every operation stays inside, whatever the operands hold")
{
    Sampler sampler(11);
    for (const OpInfo& info : all_ops()) {
        CAPTURE(info.name);
        if (info.operands[0] == 'm') continue; // of images: spline_test.cpp
        auto type_of = [](char kind) {
            return kind == 'i' ? Type::i32 : kind == 'u' ? Type::u32 : kind == 'b' ? Type::boolean : Type::real;
        };
        const Type result_type = type_of(info.result);
        for (int round = 0; round < 1500; ++round) {
            std::vector<Interval> operands;
            for (char kind : info.operands) operands.push_back(sampler.interval(type_of(kind)));
            const Interval claimed = evaluate(info.op, operands);
            for (int sample = 0; sample < 12; ++sample) {
                Slot<double> in[4], out;
                for (size_t i = 0; i < operands.size(); ++i)
                    in[i] = slot(type_of(info.operands[i]), sampler.inside(operands[i], type_of(info.operands[i])));
                execute(info.op, out, in[0], in[1], in[2], in[3]);
                const double value = number(result_type, out);
                if (holds(claimed, value)) continue;
                CAPTURE(operands[0].minimum, operands[0].maximum, operands.back().minimum, operands.back().maximum);
                CAPTURE(in[0].real, in[1].real, in[0].bits, in[1].bits, claimed.minimum, claimed.maximum, value);
                FAIL("outside");
            }
        }
    }
}

TEST_CASE("intervals: random programs stay inside")
{
    int decided = 0;
    for (uint32_t seed = 1; seed <= 800; ++seed) {
        CAPTURE(seed);
        const Flavour flavour = seed % 2 ? Flavour::tame : Flavour::wild;
        Module module = random_module(seed, flavour);
        const auto last = static_cast<uint32_t>(module.functions.size() - 1);
        const Function& function = module.functions[last];
        Sampler sampler(seed);
        std::vector<Interval> arguments;
        for (Value parameter : function.parameters) arguments.push_back(sampler.interval(function.type(parameter)));
        const std::vector<Interval> claimed = bounds_of(module, last, arguments);
        decided += claimed[0].is_finite();
        Interpreter<double> machine(module);
        for (int sample = 0; sample < 40; ++sample) {
            std::vector<Slot<double>> point;
            for (size_t i = 0; i < arguments.size(); ++i) {
                Type type = function.type(function.parameters[i]);
                point.push_back(slot(type, sampler.inside(arguments[i], type)));
            }
            auto results = machine.run(last, point, nullptr);
            for (size_t r = 0; r < results.size(); ++r) {
                const double value = number(function.type(function.body.yields[r]), results[r]);
                if (holds(claimed[r], value)) continue;
                CAPTURE(r, value, claimed[r].minimum, claimed[r].maximum);
                FAIL("outside");
            }
        }
    }
    CHECK(decided > 100);
}

TEST_CASE("intervals: integers without ends have 32 bits")
{
    const Interval all{-infinity, infinity}, zero{0, 0}, one{1, 1};
    const Interval negated[] = {zero, all}, shifted[] = {all, one};
    CHECK(evaluate(Op::isub, negated).minimum == INT32_MIN);
    CHECK(evaluate(Op::isub, negated).maximum == INT32_MAX);
    CHECK(evaluate(Op::ushr, shifted).maximum >= INT32_MAX);
}

TEST_CASE("intervals: exact ends stay, others move outward")
{
    std::mt19937_64 random(3);
    const auto some = [&] { return std::uniform_real_distribution(-3.0, 3.0)(random); };
    const auto truth = [](Op op, double a, double b) {
        const Quad x = a, y = b;
        return op == Op::add ? Quad(x + y) : op == Op::sub ? Quad(x - y) : op == Op::mul ? Quad(x * y) : Quad(x / y);
    };
    for (int round = 0; round < 2000; ++round)
        for (Op op : {Op::add, Op::sub, Op::mul, Op::div}) {
            double a = some(), b = some();
            if (round % 2) a = std::round(64 * a) / 64, b = std::ldexp(1, static_cast<int>(random() % 5)); // exact
            const Interval operands[] = {{a, a}, {b, b}};
            const Interval found = evaluate(op, operands);
            const Quad exact = truth(op, a, b);
            CAPTURE(op, a, b, found.minimum, found.maximum);
            CHECK((Quad(found.minimum) <= exact && exact <= Quad(found.maximum)));
            CHECK(found.is_point() == (round % 2 == 1 || Quad(static_cast<double>(exact)) == exact));
        }
}

TEST_CASE("intervals: a length holds the exact one and is a few units in the last place wide")
{
    std::mt19937_64 random(5);
    int inexact = 0;
    for (int round = 0; round < 3000; ++round) {
        const Op op = round % 3 == 0 ? Op::length2 : round % 3 == 1 ? Op::length3 : Op::length4;
        const size_t count = op_info(op).operands.size();
        const int scale = static_cast<int>(random() % 1200) - 600; // beyond where squares stay numbers, too
        const double width = round % 2 ? 0 : 0.25;
        Interval parts[4];
        Quad least = 0, most = 0;
        for (size_t i = 0; i < count; ++i) {
            const double low = std::uniform_real_distribution(0.0, 3.0)(random);
            parts[i] = {std::ldexp(low, scale), std::ldexp(low + width, scale)};
            least += Quad(parts[i].minimum) * parts[i].minimum;
            most += Quad(parts[i].maximum) * parts[i].maximum;
            if (random() % 2) parts[i] = {-parts[i].maximum, -parts[i].minimum};
        }
        least = sqrt(least), most = sqrt(most);
        const Interval found = evaluate(op, {parts, count});
        CAPTURE(op, scale, width, found.minimum, found.maximum);
        CHECK((Quad(found.minimum) <= least && most <= Quad(found.maximum)));
        CHECK((Quad(found.minimum) >= least * (1 - 2e-15) && Quad(found.maximum) <= most * (1 + 2e-15)));
        inexact += Quad(static_cast<double>(least)) != least;
    }
    CHECK(inexact > 2900);
}

TEST_CASE("intervals: a wave stays between -1 and 1 beside its crests, too")
{
    const double quarter = std::acos(0.0);
    for (double reach : {1e-3, 1e-9, 1e-15, 0.0}) {
        const Interval before[] = {{quarter - 2 * reach, quarter - reach}};
        CHECK(evaluate(Op::sin, before).maximum <= 1);
        const Interval trough[] = {{-quarter + reach, -quarter + 2 * reach}};
        CHECK(evaluate(Op::sin, trough).minimum >= -1);
    }
}

TEST_CASE("intervals: a tangent is unbounded where an end lies on a pole but for rounding")
{
    const double quarter = std::acos(0.0);
    for (const Interval& angles : {Interval{-quarter, 0}, Interval{0, quarter}, Interval{1, 2}}) {
        const Interval operand[] = {angles};
        CHECK((evaluate(Op::tan, operand).minimum == -infinity && evaluate(Op::tan, operand).maximum == infinity));
    }
    const Interval between[] = {{-1.5, 1.5}};
    CHECK((evaluate(Op::tan, between).minimum > -14.2 && evaluate(Op::tan, between).maximum < 14.2)); // tan(1.5): 14.1
}

TEST_CASE("intervals: results with closed ranges stay within them, and every value within its interval")
{
    struct Range {
        Op op;
        double from, to, minimum, maximum; // of the operand, of the result
    };
    const Range ranges[] = {
        {Op::exp, -800, -700, 0, 1},   {Op::exp2, -1100, -1000, 0, 1}, {Op::sqrt, 0, 1e-300, 0, 1},
        {Op::acos, 1 - 1e-9, 1, 0, 1}, {Op::acosh, 1, 1 + 1e-9, 0, 1}, {Op::cosh, -1e-4, 1e-4, 1, 2},
        {Op::tanh, 10, 30, 0, 1},      {Op::tanh, -30, -10, -1, 0},    {Op::abs, -1e-320, 1e-320, 0, 1},
        {Op::sin, 1.5, 1.6, 0.9, 1},   {Op::fract, 0.9999999, 1, 0, 1}};
    std::mt19937 random(5);
    for (const Range& range : ranges) {
        CAPTURE(op_info(range.op).name);
        for (int i = 0; i < 20000; ++i) {
            const double a = std::uniform_real_distribution(range.from, range.to)(random);
            const Interval operand[] = {{a, std::nextafter(a, range.to)}};
            const Interval claimed = evaluate(range.op, operand);
            Slot<double> in{a, 0}, out, unused;
            execute(range.op, out, in, unused, unused, unused);
            REQUIRE(
                (claimed.contains(out.real) && claimed.minimum >= range.minimum && claimed.maximum <= range.maximum));
        }
    }
}
