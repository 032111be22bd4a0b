// Intervals hold every value, and are not needlessly wide.
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/op_info.h"
#include "tests/lang/ir/ir_random.h"
#include "tests/lang/ir/ir_support.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace ir_test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

Interval height(const std::string& functions, const std::string& body, Interval p, Interval k = {1, 4})
{
    Module module = parsed(functions + "function \"body\" () {\n" + body + R"(
        }
        texture "t" {
          parameter "k" i32 2 in 1 .. 4 unit "" offset 56
          block 64 reads 0 writes 0
          body "body"
        })");
    REQUIRE(verify(module) == "");
    BoundsBox box;
    for (size_t i = 0; i < 3; ++i) box.input[i] = p;
    box.parameters = {k};
    return height_bounds(module, module.textures[0], box);
}

} // namespace

TEST_CASE("intervals: every operation stays inside, whatever the operands hold")
{
    Sampler sampler(11);
    for (const OpInfo& info : all_ops()) {
        CAPTURE(info.name);
        if (info.operands[0] == 'm') continue; // of images: ir_spline_test.cpp
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
        const std::vector<Interval> claimed = function_bounds(module, last, arguments);
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

TEST_CASE("bounds: exact where the operations are")
{
    Interval square = height("", "%x = input p_x %h = mul %x, %x return %h", {-0.5, 0.25});
    CHECK((square.minimum == 0 && square.maximum == 0.25 && !square.may_be_nan));
    // x - x^2 on [0, 1]: natural evaluation says [-1, 1]; cutting tells [0, 1/4]
    Interval hill = height("", "%x = input p_x %s = mul %x, %x %h = sub %x, %s return %h", {0, 1});
    CHECK((hill.minimum <= 0 && hill.minimum > -0.02));
    CHECK((hill.maximum >= 0.25 && hill.maximum < 0.26));
    // the entry turns what is not finite into 0
    Interval log = height("", "%x = input p_x %h = log %x return %h", {2, 3});
    CHECK((!log.may_be_nan && log.minimum > 0.69 && log.maximum < 1.1));
    Interval edge =
        height("", "%x = input p_x %t = real 3 %y = add %x, %t %l = log %y %h = add %l, %t return %h", {-4, -1});
    CHECK((edge.may_be_nan && edge.minimum == -infinity && edge.maximum >= 3.69));
}

TEST_CASE("bounds: a condition narrows what it compares, and a decided one leaves out an arm")
{
    const char* guarded = R"(
        %x = input p_x
        %tenth = real 0.1
        %c = lt %x, %tenth
        %h = if %c { %zero = real 0 yield %zero } else { %one = real 1 %q = div %one, %x yield %q }
        return %h)";
    Interval whole = height("", guarded, {-1, 1});
    CHECK((!whole.may_be_nan && whole.minimum == 0 && whole.maximum >= 10 && whole.maximum < 10.001));
    Interval left = height("", guarded, {-1, 0.05});
    CHECK((left.minimum == 0 && left.maximum == 0));
}

TEST_CASE("bounds: facts bound each octave of a sum over a parameter's range")
{
    // facts that the body alone would not give: the callee is a wave of height 1 that says 0.5, over many periods
    const std::string noise = R"(
        function "noise" (%a: real, %b: real, %c: real) first 3 facts minimum -0.5 maximum 0.5 slope 3 proven {
          %s = add %a, %b
          %t = add %s, %c
          %w = sin %t
          %half = real 0.5
          %r = mul %w, %half
          return %r
        })";
    const std::string fbm = R"(
        %x = input p_x  %y = input p_y  %z = input p_z
        %n = parameter 0 i32
        %four = i32 4
        %trips = imin %n, %four
        %one = real 1  %zero = real 0  %two = real 2  %half = real 0.5
        %sum, %amplitude, %frequency = for %trips max 4 (%i, %s, %a, %f) from (%zero, %one, %one) {
          %u = mul %x, %f  %v = mul %y, %f  %w = mul %z, %f
          %h = call "noise" (%u, %v, %w)
          %d = mul %h, %a
          %t = add %s, %d
          %b = mul %a, %half  %g = mul %f, %two
          yield %t, %b, %g
        }
        return %sum)";
    Interval all = height(noise, fbm, {-100, 100});
    CHECK((!all.may_be_nan && all.maximum >= 0.5 * 1.875 && all.maximum < 0.5 * 1.875 + 1e-12));
    Interval two = height(noise, fbm, {-100, 100}, {1, 2});
    CHECK((two.maximum >= 0.75 && two.maximum < 0.75 + 1e-12));
    Interval unbounded = height(noise, fbm, {-infinity, infinity});
    CHECK((unbounded.maximum >= 0.9375 && unbounded.maximum < 0.9376 && unbounded.minimum > -0.9376));
    // near one point the slope says more than the range does: sin is close to 0 there
    Interval near = height(noise, fbm, {-1e-4, 1e-4});
    CHECK((near.maximum < 0.01 && near.minimum > -0.01));
}

TEST_CASE("bounds: the range of a table's cells within the index")
{
    Module module = parsed(R"(
        table "T" real [5, 1, 2, 9]
        function "f" (%i: i32) {
          %low = i32 0  %high = i32 3
          %a = imax %i, %low
          %b = imin %a, %high
          %r = table 0 %b
          return %r
        })");
    const Interval middle{1, 2}, all{-5, 100};
    Interval some = function_bounds(module, 0, {&middle, 1})[0];
    CHECK((some.minimum == 1 && some.maximum == 2));
    Interval every = function_bounds(module, 0, {&all, 1})[0];
    CHECK((every.minimum == 1 && every.maximum == 9));
}

TEST_CASE("bounds: work is limited, whatever the program asks for")
{
    Interval costly = height("", R"(
        %x = input p_x
        %n = i32 2000
        %r = for %n max 2000 (%i, %a) from (%x) {
          %s = for %n max 2000 (%j, %b) from (%a) { %t = sin %b yield %t }
          yield %s
        }
        return %r)",
                             {-1, 1});
    CHECK((costly.may_be_nan && costly.minimum == -infinity && costly.maximum == infinity));
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

// sin(x / 10) written so that its body says nothing: only the declared slope does, from the middle of the box.
TEST_CASE("bounds: the slope that is declared bounds the value about the middle of a box")
{
    const Module module = parsed(R"(
        function "wave" (%x: real) first 1 facts minimum -1 maximum 1 slope 0.1 proven {
          %tenth = real 0.1 %a = mul %x, %tenth %big = real 100 %c = mul %x, %big %d = add %a, %c %e = sub %d, %c
          %h = sin %e
          return %h
        }
        function "body" () { %x = input p_x %h = call "wave" (%x) return %h }
        texture "t" { block 56 reads 0 writes 0 body "body" })");
    REQUIRE(verify(module) == "");
    BoundsBox box;
    box.input[0] = {2, 6};
    const Interval found = height_bounds(module, module.textures[0], box, 1);
    CAPTURE(found.minimum, found.maximum);
    CHECK((found.minimum <= std::sin(0.2) && found.maximum >= std::sin(0.6)));
    CHECK((found.minimum > std::sin(0.4) - 0.2001 && found.maximum < std::sin(0.4) + 0.2001));
}

TEST_CASE("bounds: what may fault is told with the reason, and nothing of what cannot")
{
    using Why = Undefined::Why;
    struct {
        const char* body; // of x in -2 .. 2, u without bounds
        std::optional<Why> why;
    } const cases[] = {
        {"%h = log %x", Why::domain},
        {"%a = abs %x %h = log %a", Why::pole},
        {"%one = real 1 %d = div %one, %x %h = atan %d", Why::pole},
        {"%one = real 1 %a = abs %x %b = add %a, %one %h = div %one, %b", std::nullopt},
        {"%big = real 1000 %a = mul %x, %big %h = exp %a", Why::overflow},
        {"%big = real 1000 %a = mul %x, %big %e = exp %a %h = tanh %e", Why::overflow}, // the gradient's
        {"%big = real 1000 %a = mul %x, %big %e = exp %a %two = real 2 %h = min %e, %two", std::nullopt},
        {"%big = real 1e200 %a = mul %x, %big %s = sin %a %h = mul %s, %big", Why::derivative},
        {"%s = sin %u %v = mul %u, %u %h = mul %s, %v", std::nullopt},
        // the way on which x comes in is never taken, which the code of the gradient does not know: 0 times infinity
        {"%one = real 1 %zero = real 0 %c = lt %one, %zero %v = if %c { yield %x } else { yield %one } "
         "%d = div %v, %zero %h = atan %d",
         Why::pole},
        {"%one = real 1 %zero = real 0 %d = div %one, %zero %h = atan %d", std::nullopt}, // no gradient at all
        {"%s = sqrt %x %b = real 100 %h = max %s, %b", Why::domain}, // beside NaN, the mean of both gradients
        {"%one = real 1 %zero = real 0 %big = div %one, %zero %a = abs %x %y = add %a, %one %h = call \"turn\" (%y, "
         "%big)",
         Why::pole}, // a slope is promised of finite arguments alone: infinity times 0
        {"%one = real 1 %zero = real 0 %a = abs %x %y = add %a, %one %d = div %y, %zero %t = atan %d %h = call "
         "\"flat\" (%t)",
         Why::pole}, // beyond 1 a constant, and yet its derivative times a gradient that is no number
        {"%n = i32 2000 %h = for %n max 2000 (%i, %a) from (%x) { %s = for %n max 2000 (%j, %b) from (%a) "
         "{ %t = sin %b yield %t } yield %s }",
         Why::not_looked_at},
        // 0 by convention where they have no bound, and a number beside it
        {"%a = abs %x %h = sqrt %a", std::nullopt},
        {"%a = abs %x %b = real 0.3 %h = pow %a, %b", std::nullopt},
        {"%half = real 0.5 %a = mul %x, %half %h = asin %a", std::nullopt},
        {"%h = length2 %x, %x", std::nullopt},
        {"%h = atan2 %x, %x", std::nullopt},
    };
    for (const auto& one : cases) {
        CAPTURE(one.body);
        Module module = parsed(std::string("function \"turn\" (%x: real, %by: real) first 1 facts minimum -2 maximum 2 "
                                           "slope 1 proven { %a = mul %x, %by %h = atan %a return %h } "
                                           "function \"flat\" (%x: real) { %one = real 1 %h = min %x, %one return %h } "
                                           "function \"body\" () { %x = input p_x %u = input uv_x ") +
                               one.body + " return %h } texture \"t\" { block 56 reads 0 writes 0 body \"body\" }");
        REQUIRE(verify(module) == "");
        BoundsBox box;
        std::fill(std::begin(box.input), std::end(box.input), Interval{-infinity, infinity});
        box.input[0] = {-2, 2};
        const std::vector<Undefined> found = undefined_in(module, module.textures[0], box);
        CHECK(found.empty() == !one.why.has_value());
        if (one.why && !found.empty()) CHECK(found[0].why == *one.why);
    }
}
