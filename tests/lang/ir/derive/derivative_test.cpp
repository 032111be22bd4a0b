// Derivatives against difference quotients of the 113-bit function, and the conventions at kinks, exactly.
#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/op_info.h"
#include "tests/lang/ir/ir_random.h"
#include "tests/lang/ir/ir_support.h"

#include <cmath>

using namespace ir_test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct Derived {
    Module module;
    Derivative derivative;
    std::vector<size_t> reals; // parameters that carry a direction, in order
};

// Unit seeds for every real parameter of the module's last function.
Derived with_jacobian(Module module)
{
    Derived made{std::move(module), {}, {}};
    auto function = static_cast<uint32_t>(made.module.functions.size() - 1);
    const Function& source = made.module.functions[function];
    for (size_t p = 0; p < source.parameters.size(); ++p)
        if (source.type(source.parameters[p]) == Type::real) made.reals.push_back(p);
    Seeds seeds(source.parameters.size(), std::vector<Seed>(made.reals.size(), Seed::none));
    for (size_t d = 0; d < made.reals.size(); ++d) seeds[made.reals[d]][d] = Seed::unit;
    Differentiator differentiator(made.module);
    made.derivative = differentiator.derivative(function, seeds);
    REQUIRE(verify(made.module) == "");
    return made;
}

// The tangent of result r in direction d from the derivative's results; an absent one is 0.
template <typename T>
T tangent(const Derivative& derivative, std::span<const Slot<T>> results, size_t r, size_t d)
{
    size_t at = derivative.exists.size();
    for (size_t i = 0; i < derivative.exists.size(); ++i)
        for (size_t j = 0; j < derivative.exists[i].size(); ++j) {
            if (i == r && j == d) return derivative.exists[i][j] ? results[at].real : T(0);
            at += derivative.exists[i][j];
        }
    return T(0);
}

// Compares all tangents with difference quotients at one point; returns how many were compared.
int compare(const Derived& made, uint32_t original, const std::vector<Slot<double>>& point, double bound)
{
    Interpreter<double> machine(made.module);
    Interpreter<Quad> oracle(made.module);
    std::vector<Slot<Quad>> exact;
    for (const Slot<double>& slot : point) exact.push_back({Quad(slot.real), slot.bits});
    int compared = 0;
    for (size_t d = 0; d < made.reals.size(); ++d) {
        auto truth = difference(oracle, original, exact, made.reals[d]);
        if (!truth) continue;
        std::vector<Slot<double>> results;
        for (const auto& slot : machine.run(made.derivative.function, point, nullptr)) results.push_back(slot);
        for (size_t r = 0; r < truth->size(); ++r) {
            auto expected = static_cast<double>((*truth)[r]);
            if (!(std::fabs(expected) < 1e8)) continue;
            double found = tangent<double>(made.derivative, results, r, d);
            CAPTURE(r, d, expected, found);
            CHECK(std::fabs(found - expected) <= bound * (1 + std::fabs(expected)));
            ++compared;
        }
    }
    return compared;
}

} // namespace

TEST_CASE("derivative: every operation agrees with differences of the 113-bit function")
{
    const double swept[] = {-7.3, -2.6, -1.37, -0.93, -0.51, -0.26, -0.012, 0.013, 0.31, 0.77, 0.96, 1.41, 2.9, 8.1};
    for (const OpInfo& info : all_ops()) {
        const bool is_choice = info.op == Op::select;
        if (!is_choice && (info.result != 'r' || info.operands.find_first_not_of('r') != std::string_view::npos))
            continue;
        if (info.op == Op::detach) continue; // differs from the difference on purpose
        CAPTURE(info.name);
        Module module;
        Builder builder(module, "f");
        std::vector<Value> operands;
        for (char kind : info.operands) operands.push_back(builder.parameter(kind == 'b' ? Type::boolean : Type::real));
        Value result = builder.operation(info.op, operands);
        builder.finish({&result, 1});
        Derived made = with_jacobian(std::move(module));

        int compared = 0;
        for (size_t i = 0; i < std::size(swept); ++i)
            for (size_t j = 0; j < (info.arity > 1 ? std::size(swept) : 1); ++j) {
                std::vector<Slot<double>> point{{swept[i], 0}};
                if (info.arity > 1) point.push_back({swept[j], 0});
                if (info.arity > 2) point.push_back({swept[(3 * i + 5 * j + 1) % std::size(swept)], 0});
                if (info.arity > 3) point.push_back({swept[(5 * i + 3 * j + 2) % std::size(swept)], 0});
                if (is_choice) point[0].bits = i % 2;
                compared += compare(made, 0, point, 4e-14);
            }
        CHECK(compared >= 3);
    }
}

namespace {

// f(a, b) = op(a, b): both partials, exactly.
struct Convention {
    Op op;
    double a, b, da, db;
};

} // namespace

TEST_CASE("derivative: conventions at kinks, ties and where the true derivative is infinite")
{
    const Convention conventions[] = {
        {Op::abs, 0.0, 0, 0, 0},
        {Op::abs, -0.0, 0, 0, 0},
        {Op::min, 2, 2, 0.5, 0.5},
        {Op::max, 2, 2, 0.5, 0.5},
        {Op::min, 0.0, -0.0, 0.5, 0.5},
        {Op::min, 1, 2, 1, 0},
        {Op::max, 1, 2, 0, 1},
        {Op::min, -infinity, 2, 1, 0},
        {Op::sign, 3, 0, 0, 0},
        {Op::floor, 3, 0, 0, 0},
        {Op::ceil, 3.5, 0, 0, 0},
        {Op::round, 0.5, 0, 0, 0},
        {Op::trunc, -0.5, 0, 0, 0},
        {Op::fract, 3, 0, 1, 0},
        {Op::mod, -7, 2, 1, 4}, // -floor(-3.5)
        {Op::mod, 7, -2, 1, 4},
        {Op::mod, 6, 2, 1, -3},
        {Op::sqrt, 0, 0, 0, 0},
        {Op::sqrt, -0.0, 0, 0, 0},
        {Op::length2, 0, 0, 0, 0},
        {Op::length2, 3e200, 4e200, 0.6, 0.8},
        {Op::length2, -3e-200, 4e-200, -0.6, 0.8},
        {Op::length2, 1e308, 1e308, std::sqrt(0.5), std::sqrt(0.5)},
        {Op::asin, 1, 0, 0, 0},
        {Op::asin, -1, 0, 0, 0},
        {Op::acos, 1, 0, 0, 0},
        {Op::acosh, 1, 0, 0, 0},
        {Op::atan2, 0, 0, 0, 0},
        {Op::atan2, -0.0, -0.0, 0, 0},
        {Op::atan2, 0, 2, 0.5, 0},
        {Op::pow, 0, 0.5, 0, 0},
        {Op::pow, 0, 1, 1, 0},
        {Op::pow, 0, 2, 0, 0},
        {Op::pow, 0, 0, 0, 0},
        {Op::pow, 5e-324, 0, 0, std::log(5e-324)}, // 5e-324^-1 overflows, times 0
        {Op::pow, 3, 0, 0, std::log(3.0)},
        {Op::pow, -3, 2, -6, not_a_number}, // a power of a negative number exists at whole exponents only
        {Op::detach, 3, 0, 0, 0},
        {Op::sinturn, 0.25, 0, 0, 0}, // costurn(1/4) is exactly 0
        {Op::costurn, 0.5, 0, 0, 0},
        {Op::tanh, 800, 0, 0, 0},
        {Op::atan, 1e200, 0, 0, 0},
        {Op::exp, -800, 0, 0, 0},
    };
    for (const Convention& c : conventions) {
        CAPTURE(op_info(c.op).name, c.a, c.b);
        Module module;
        Builder builder(module, "f");
        Value a = builder.parameter(Type::real), b = builder.parameter(Type::real);
        const Value operands[] = {a, b};
        Value result = builder.operation(c.op, std::span(operands, op_info(c.op).arity));
        builder.finish({&result, 1});
        Derived made = with_jacobian(std::move(module));
        Interpreter<double> machine(made.module);
        auto results = machine.run(made.derivative.function, slots_of<double>(std::vector{c.a, c.b}), nullptr);
        double da = tangent<double>(made.derivative, results, 0, 0),
               db = tangent<double>(made.derivative, results, 0, 1);
        CAPTURE(da, db);
        CHECK((da == c.da || std::fabs(da - c.da) < 1e-15));
        CHECK((db == c.db || std::fabs(db - c.db) < 1e-15 || (db != db && c.db != c.db)));
    }
}

TEST_CASE("derivative: the arm that is not taken never shows, whatever it holds")
{
    // sqrt(x) is NaN below 0, and so is its derivative
    for (const char* text : {R"(
        function "f" (%x: real) {
          %zero = real 0
          %c = lt %x, %zero
          %s = sqrt %x
          %n = neg %x
          %r = select %c, %n, %s
          return %r
        })",
                             R"(
        function "f" (%x: real) {
          %zero = real 0
          %c = lt %x, %zero
          %r = if %c { %n = neg %x yield %n } else { %s = sqrt %x yield %s }
          return %r
        })"}) {
        Derived made = with_jacobian(parsed(text));
        CHECK(call(made.module, made.derivative.function, {-4}) == std::vector<double>{4, -1});
        CHECK(call(made.module, made.derivative.function, {4}) == std::vector<double>{2, 0.25});
    }
}

TEST_CASE("derivative: loops carry tangents, also those that arise only in a later iteration")
{
    // y = x^n by multiplication; z picks up y one iteration late, w later still; i never has a tangent
    Derived made = with_jacobian(parsed(R"(
        function "f" (%x: real, %n: i32) {
          %limit = i32 20
          %trips = imin %n, %limit
          %one = real 1
          %zero = real 0
          %start = i32 0
          %y, %z, %w, %k = for %trips max 20 (%i, %a, %b, %c, %j) from (%one, %zero, %zero, %start) {
            %next = mul %a, %x
            %ten = i32 10
            %more = iadd %j, %ten
            yield %next, %a, %b, %more
          }
          return %y, %z, %w, %k
        })"));
    Interpreter<double> machine(made.module);
    for (uint32_t n : {0u, 1u, 2u, 5u, static_cast<uint32_t>(-3)}) {
        const std::vector<Slot<double>> point{{3, 0}, {0, n}};
        auto results = machine.run(made.derivative.function, point, nullptr);
        const int trips = static_cast<int32_t>(n) < 0 ? 0 : static_cast<int>(n);
        auto power_slope = [](int k) { return k < 1 ? 0.0 : k * std::pow(3.0, k - 1); };
        CHECK(results[0].real == std::pow(3.0, trips));
        CHECK(results[3].bits == static_cast<uint32_t>(10 * trips));
        CHECK(tangent<double>(made.derivative, results, 0, 0) == power_slope(trips));
        CHECK(tangent<double>(made.derivative, results, 1, 0) == power_slope(trips - 1));
        CHECK(tangent<double>(made.derivative, results, 2, 0) == power_slope(trips - 2));
        CHECK(tangent<double>(made.derivative, results, 3, 0) == 0);
    }
}

TEST_CASE("derivative: calls take the Jacobian or pass tangents on, with equal results")
{
    const char* callee = R"(
        function "f" (%a: real, %b: real, %c: real, %d: real) first 2 {
          %p = mul %a, %b
          %s = sin %c
          %q = mul %s, %d
          %r = add %p, %q
          return %r, %q
        })";
    // one direction, four active arguments: tangents are passed; four directions: Jacobian
    Derived one = with_jacobian(parsed(std::string(callee) + R"(
        function "g" (%x: real) {
          %two = real 2
          %x2 = mul %x, %two
          %x3 = mul %x, %x
          %x4 = neg %x
          %r, %q = call "f" (%x, %x2, %x3, %x4)
          return %r, %q
        })"));
    CHECK(one.module.functions[2].name == "d f [t,t,t,t]");
    Derived four = with_jacobian(parsed(std::string(callee) + R"(
        function "g" (%x: real, %y: real, %z: real, %w: real) {
          %r, %q = call "f" (%x, %y, %z, %w)
          return %r, %q
        })"));
    CHECK(four.module.functions[2].name == "d f [1...,.1..,..1.,...1]");
    for (double x : {-1.7, 0.3, 2.2}) {
        CHECK(compare(one, 1, {{x, 0}}, 1e-14) == 2);
        CHECK(compare(four, 1, {{x, 0}, {2 * x, 0}, {x * x, 0}, {-x, 0}}, 1e-14) == 8);
    }
    // the Jacobian in the first argument keeps the plain name, and only what exists is returned
    Module module = parsed(callee);
    Differentiator differentiator(module);
    Derivative jacobian = differentiator.jacobian(0);
    CHECK(module.functions[jacobian.function].name == "d f");
    CHECK(jacobian.exists == std::vector<std::vector<bool>>{{true, true}, {false, false}});
    CHECK(differentiator.jacobian(0).function == jacobian.function);
    CHECK(call(module, jacobian.function, {3, 5, 0.0, 1}) == std::vector<double>{15, 0, 5, 3});
}

TEST_CASE("derivative: a derivative can be differentiated again")
{
    Module module = parsed(R"(
        function "f" (%x: real, %y: real) first 2 {
          %s = sin %x
          %p = mul %s, %y
          %n = i32 3
          %r = for %n max 3 (%i, %a) from (%p) {
            %q = mul %a, %y
            %t = sinturn %q
            yield %t
          }
          %l = length2 %r, %x
          %c = pow %l, %y
          return %c
        })");
    Differentiator differentiator(module);
    Derivative first = differentiator.jacobian(0);
    Derivative second = differentiator.jacobian(first.function);
    REQUIRE(verify(module) == "");
    CHECK(module.functions[second.function].name == "d d f");
    REQUIRE(second.exists.size() == 3);
    Interpreter<Quad> oracle(module);
    for (double x : {0.2, 0.9})
        for (double y : {0.3, 1.1}) {
            std::vector<double> results = call(module, second.function, {x, y});
            std::vector<Slot<Quad>> point{{Quad(x), 0}, {Quad(y), 0}};
            for (size_t d = 0; d < 2; ++d) {
                auto truth = difference(oracle, first.function, point, d);
                REQUIRE(truth);
                for (size_t r = 0; r < 3; ++r) {
                    auto expected = static_cast<double>((*truth)[r]);
                    double found = results[3 + 2 * r + d];
                    CAPTURE(x, y, r, d, expected, found);
                    CHECK(std::fabs(found - expected) <= 1e-12 * (1 + std::fabs(expected)));
                }
            }
        }
    // x^3 twice: the rules as written, no rounding here
    Module cube = parsed(R"(
        function "f" (%x: real) first 1 {
          %three = real 3
          %r = pow %x, %three
          return %r
        })");
    Differentiator of_cube(cube);
    Derivative twice = of_cube.jacobian(of_cube.jacobian(0).function);
    CHECK(call(cube, twice.function, {2}) == std::vector<double>{8, 12, 12, 12});
}

TEST_CASE("derivative: random programs keep their values bit for bit and have the right tangents")
{
    int compared = 0;
    for (uint32_t seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        Module module = random_module(seed, Flavour::tame);
        REQUIRE(verify(module) == "");
        const auto original = static_cast<uint32_t>(module.functions.size() - 1);
        Derived made = with_jacobian(std::move(module));
        Interpreter<double> machine(made.module);
        for (uint32_t sample = 0; sample < 4; ++sample) {
            std::vector<Slot<double>> point = random_arguments(made.module.functions[original], 31 * seed + sample);
            std::vector<Slot<double>> before, after;
            for (const auto& slot : machine.run(original, point, nullptr)) before.push_back(slot);
            for (const auto& slot : machine.run(made.derivative.function, point, nullptr)) after.push_back(slot);
            for (size_t i = 0; i < before.size(); ++i)
                CHECK(same(made.module.functions[original], i, before[i], after[i]));
            compared += compare(made, original, point, 1e-9);
        }
    }
    CHECK(compared > 2000);
}
