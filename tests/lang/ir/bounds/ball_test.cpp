// Balls (support/ball.h) hold what double may have, and hardly more.
#include "lang/ir/builder.h"
#include "lang/ir/op_info.h"
#include "tests/lang/ir/ir_support.h"
#include "tests/support/ball.h"

#include <cmath>
#include <random>

using namespace ir_test;
using haptel::test::Ball;

namespace {

Module module_of(Op op, uint32_t arity)
{
    Module module;
    Builder builder(module, "f");
    std::vector<Value> parameters;
    for (uint32_t i = 0; i < arity; ++i) parameters.push_back(builder.parameter(Type::real));
    const Value result = builder.operation(op, parameters);
    builder.finish({&result, 1});
    return module;
}

bool is_of_reals(const OpInfo& info)
{
    return info.result == 'r' && info.operands.find_first_not_of('r') == std::string_view::npos;
}

} // namespace

TEST_CASE("balls: every operation on numbers that are off by as much as they may stays inside")
{
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    for (const OpInfo& info : all_ops()) {
        if (!is_of_reals(info)) continue;
        CAPTURE(info.name);
        const Module module = module_of(info.op, info.arity);
        Interpreter<double> interpreter(module);
        Interpreter<Ball> exact(module);
        interpreter.watch_decisions(true);
        exact.watch_decisions(true);
        int compared = 0;
        for (int round = 0; round < 4000; ++round) {
            std::vector<Slot<double>> found;
            std::vector<Slot<Ball>> balls;
            for (uint32_t i = 0; i < info.arity; ++i) {
                const double sizes[] = {1, 1, 1, 3, 40, 1e9, 1e-3, 1e-9, 1e-310};
                const double size = sizes[random() % std::size(sizes)];
                double middle = uniform(-size, size), radius = std::fabs(middle) * std::exp2(uniform(-60, -3));
                if (round % 7 == 0) middle = std::round(middle);
                if (round % 5 == 0) radius = 0;
                const double sides[] = {-1, 1, uniform(-1, 1)};
                double inside = middle + sides[random() % 3] * radius;
                if (radius == 0 || !(std::fabs(inside - middle) <= radius)) inside = middle;
                found.push_back({inside});
                Slot<Ball> ball;
                ball.real = {Quad(middle), Quad(radius)};
                balls.push_back(ball);
            }
            Ball::undecided = false;
            const double value = interpreter.run(0, found, nullptr)[0].real;
            const Ball ball = exact.run(0, balls, nullptr)[0].real;
            const auto middle = static_cast<double>(ball.middle), radius = static_cast<double>(ball.radius);
            CAPTURE(round, found[0].real, found.back().real, value, middle, radius);
            if (interpreter.decisions() != exact.decisions()) {
                CHECK(Ball::undecided);
                continue;
            }
            if (std::isinf(radius)) continue;
            ++compared;
            if (!ball.may_be(value)) FAIL("outside");
        }
        CHECK(compared > 500);
    }
}

TEST_CASE("balls: of exact operands they are a few units in the last place wide")
{
    std::mt19937_64 random(8);
    for (const OpInfo& info : all_ops()) {
        if (!is_of_reals(info) || info.op == Op::mod) continue; // its product cancels
        CAPTURE(info.name);
        const Module module = module_of(info.op, info.arity);
        Interpreter<Ball> exact(module);
        for (int round = 0; round < 200; ++round) {
            std::vector<double> operands;
            for (uint32_t i = 0; i < info.arity; ++i)
                operands.push_back((info.op == Op::acosh) + std::uniform_real_distribution(0.01, 0.99)(random));
            const Ball ball = exact.run(0, slots_of<Ball>(operands), nullptr)[0].real;
            CHECK(ball.radius <= 12 * Quad(0x1p-53) * fabs(ball.middle)); // atan2pi: an angle and a quotient
        }
    }
}

// (1e8 + x) - 1e8 keeps x to half a unit in the last place of 1e8, 2^-27, and there is an x that loses as much.
TEST_CASE("balls: what cancels is known to be lost, and not more than is lost")
{
    const Module module = parsed(R"(function "f" (%x: real) {
        %big = real 1e8 %sum = add %big, %x %rest = sub %sum, %big return %rest })");
    Interpreter<Ball> exact(module);
    Interpreter<double> interpreter(module);
    std::mt19937_64 random(9);
    double worst = 0;
    for (int round = 0; round < 1000; ++round) {
        const double x[] = {std::uniform_real_distribution(0.0, 1.0)(random)};
        const Ball ball = exact.run(0, slots_of<Ball>(x), nullptr)[0].real;
        const double found = interpreter.run(0, slots_of<double>(x), nullptr)[0].real;
        CHECK(ball.may_be(found));
        CHECK(ball.radius < Quad(0x1p-26));
        worst = std::fmax(worst, std::fabs(found - x[0]));
        CHECK_FALSE(ball.may_be(found + 0x1p-24));
    }
    CHECK(worst > 0x1p-28);
}
