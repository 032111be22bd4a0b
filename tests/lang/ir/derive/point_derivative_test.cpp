// Derivatives with respect to the surface point inside of a body: they become values, the entries' gradients are exact,
// and nothing is left that an engine could not run.
#include "lang/abi/abi.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/derive/point_derivative.h"
#include "tests/lang/ir/ir_support.h"

#include <cmath>

using namespace ir_test;

namespace {

constexpr const char* texture_text = R"(
    texture "t" {
      block 56 reads 0 writes 0
      body "body"
    })";

Module with_entries(const std::string& functions)
{
    Module module = parsed(functions + texture_text);
    Differentiator(module).make_entries(module.textures[0]);
    remove_unresolved(module);
    REQUIRE(verify(module) == "");
    return module;
}

struct PointSample {
    double height, gradient[3];
};

PointSample point_sample(const Module& module, const EntryInputs<double>& inputs)
{
    Interpreter<double> machine(module);
    const double alone = machine.run(module.textures[0].height, {}, &inputs)[0].real;
    const auto both = machine.run(module.textures[0].height_gradient, {}, &inputs);
    CHECK(same(alone, both[0].real));
    CHECK(both[4].bits == 0);
    return {both[0].real, {both[1].real, both[2].real, both[3].real}};
}

EntryInputs<double> at(double x, double y, double z)
{
    EntryInputs<double> inputs;
    inputs.input[static_cast<size_t>(Input::p_x)] = x;
    inputs.input[static_cast<size_t>(Input::p_y)] = y;
    inputs.input[static_cast<size_t>(Input::p_z)] = z;
    return inputs;
}

// dq/dx of its argument, times its argument
const std::string asking = R"(
    function "asking" (%q: real) first 1 {
      %dx = d_dp 0 %q
      %r = mul %dx, %q
      return %r
    })";

} // namespace

TEST_CASE("point derivatives: a callee is told how its argument moves, and the gradient has second derivatives")
{
    Module module = with_entries(asking + R"(
    function "body" () {
      %x = input p_x
      %y = input p_y
      %s = sin %x
      %q = mul %s, %y
      %h = call "asking" (%q)
      return %h
    })");
    // h = y cos x * y sin x
    const double x = 0.7, y = 1.3, c = std::cos(x), s = std::sin(x);
    const PointSample made = point_sample(module, at(x, y, 5));
    CHECK(made.height == (c * y) * (s * y));
    CHECK(std::fabs(made.gradient[0] - y * y * (c * c - s * s)) < 1e-15);
    CHECK(std::fabs(made.gradient[1] - 2 * y * s * c) < 1e-15);
    CHECK(made.gradient[2] == 0);
}

TEST_CASE("point derivatives: through functions that do not ask, ifs and loops")
{
    Module module = with_entries(asking + R"(
    function "cube" (%q: real) first 1 {
      %a = mul %q, %q
      %b = mul %a, %q
      return %b
    }
    function "body" () {
      %x = input p_x
      %zero = real 0
      %c = lt %zero, %x
      %q = if %c {
        %a = call "cube" (%x)
        yield %a
      } else {
        %b = neg %x
        yield %b
      }
      %three = i32 3
      %two = real 2
      %r = for %three max 3 (%i, %t) from (%q) {
        %u = mul %t, %two
        yield %u
      }
      %h = call "asking" (%r)
      return %h
    })");
    // x > 0: r = 8 x^3, h = 24 x^2 8 x^3 = 192 x^5; else r = -8 x, h = 64 x
    const PointSample right = point_sample(module, at(0.5, 0, 0)), left = point_sample(module, at(-0.5, 0, 0));
    CHECK(right.height == 6.0);
    CHECK(right.gradient[0] == 60.0);
    CHECK(left.height == -32.0);
    CHECK(left.gradient[0] == 64.0);
}

TEST_CASE("point derivatives: n and uv move by their Jacobians on the facet")
{
    Module module = with_entries(R"(
    function "body" () {
      %n = input n_y
      %v = input uv_x
      %a = d_dp 2 %n
      %b = d_dp 1 %v
      %h = add %a, %b
      return %h
    })");
    CHECK(module.textures[0].reads == (HAPTEL_READS_NORMAL | HAPTEL_READS_UV));
    EntryInputs<double> inputs;
    inputs.input[static_cast<size_t>(Input::n_dp_12)] = 0.5;
    inputs.input[static_cast<size_t>(Input::uv_dp_01)] = 3;
    CHECK(point_sample(module, inputs).height == 3.5);
}

TEST_CASE("point derivatives: the derivative of a function that asks has both derivatives, in either order")
{
    const std::string graded = asking + R"(
    function "inner" (%q: real) first 1 {
      %a = mul %q, %q
      %h = call "asking" (%a)
      return %h
    })";
    Module module = parsed(graded);
    Differentiator differentiator(module);
    const Derivative derivative = differentiator.jacobian(1);
    REQUIRE(derivative.exists == std::vector<std::vector<bool>>{{true}});
    module = parsed(print(module) + R"(
    function "body" () {
      %x = input p_x
      %q = sin %x
      %r, %t = call ")" +
                    module.functions[derivative.function].name + R"(" (%q)
      return %t
    })" + texture_text);
    Differentiator(module).make_entries(module.textures[0]);
    remove_unresolved(module);
    REQUIRE(verify(module) == "");
    // inner(q) = (2 q q') q^2 = 2 q^3 q' with q' = dq/dx given: its derivative by q, at q = sin x, is
    // 6 q^2 q' + 2 q^3 dq'/dq, where q' itself is held: 6 sin^2 cos
    const double x = 0.4, s = std::sin(x), c = std::cos(x);
    const PointSample made = point_sample(module, at(x, 0, 0));
    CHECK(std::fabs(made.height - 6 * s * s * c) < 1e-15);
    CHECK(std::fabs(made.gradient[0] - (12 * s * c * c - 6 * s * s * s)) < 4e-15);
}

TEST_CASE("point derivatives: inside of what is measured, other measurements count as constants")
{
    // a warp in a loop: q = q (2 + dq/dx), three times
    Module module = with_entries(R"(
    function "body" () {
      %x = input p_x
      %s = mul %x, %x
      %three = i32 3
      %two = real 2
      %h, %dh = for %three max 3 (%i, %q, %unused) from (%s, %two) {
        %d = d_dp 0 %q
        %f = add %two, %d
        %r = mul %q, %f
        yield %r, %d
      }
      %r = add %h, %dh
      return %r
    })");
    const double x = 0.3;
    double q = x * x, measured = 2 * x, last = 0;   // as defined
    double slope = 2 * x, bend = 2, last_slope = 0; // d/dx of q and of `measured`
    for (int i = 0; i < 3; ++i) {
        const double factor = 2 + measured;
        last = measured;
        last_slope = bend;
        const double next_slope = slope * factor + q * bend;
        const double next_bend = bend * factor + measured * bend;
        q *= factor;
        measured *= factor; // the factor held
        slope = next_slope;
        bend = next_bend;
    }
    const PointSample made = point_sample(module, at(x, 0, 0));
    CHECK(std::fabs(made.height - (q + last)) < 1e-15);
    CHECK(std::fabs(made.gradient[0] - (slope + last_slope)) < 4e-14);
}

TEST_CASE("point derivatives: what was measured has no tangent that a loop would have to carry")
{
    Module module = with_entries(R"(
    function "body" () {
      %x = input p_x
      %s = mul %x, %x
      %three = i32 3
      %two = real 2
      %h, %sum = for %three max 3 (%i, %q, %t) from (%s, %two) {
        %d = d_dp 0 %q
        %r = mul %q, %q
        %u = add %t, %d
        yield %r, %u
      }
      %m = d_dp 0 %sum
      %n = add %m, %sum
      %r = add %h, %n
      return %r
    })");
    for (const Instruction& made : module.functions[module.textures[0].body].body.instructions)
        if (std::holds_alternative<For>(made.kind)) CHECK(made.results.size() == 3); // q, its tangent, the sum
    // x^16 + 2 + 2 x + 4 x^3 + 8 x^7, whose last three terms were measured
    CHECK(point_sample(module, at(0.5, 0, 0)).height == 0x1p-16 + 2 + 1 + 0.5 + 0.0625);
}

TEST_CASE("point derivatives: only tangents that are asked for are made")
{
    Module module = with_entries(asking + R"(
    function "wave" (%q: real) first 1 {
      %s = sin %q
      return %s
    }
    function "body" () {
      %x = input p_x
      %two = real 2
      %q = mul %x, %two
      %a = call "wave" (%q)
      %b = call "asking" (%q)
      %h = add %a, %b
      return %h
    })");
    const Function& body = module.functions[module.textures[0].body];
    for (const Instruction& made : body.body.instructions) {
        if (auto* call = std::get_if<Call>(&made.kind)) CHECK(module.functions[call->function].body.yields.size() == 1);
    }
    CHECK(print(module, body).find("call \"wave\"") != std::string::npos);
    CHECK(print(module, body).find("cos") == std::string::npos);
}

TEST_CASE("point derivatives: a body that does not ask stays as it is")
{
    const std::string plain = R"(
    function "body" () {
      %x = input p_x
      %h = sin %x
      return %h
    })";
    Module module = parsed(plain + texture_text);
    Differentiator(module).make_entries(module.textures[0]);
    CHECK(module.textures[0].body == 0);
    CHECK(module.functions.size() == 3);
    const std::string before = print(module);
    remove_unresolved(module);
    CHECK(print(module) == before);
}

TEST_CASE("point derivatives: a program that still asks is refused, and nothing runs it")
{
    Module module = parsed(asking);
    CHECK(verify(module).find("respect to the point") != std::string::npos);
    CHECK(print(parsed(print(module))) == print(module));
    const double result = call(module, 0, {1.0})[0];
    CHECK(result != result);
    remove_unresolved(module);
    CHECK(module.functions.empty());

    CHECK(parse("function \"f\" (%q: real) { %a = d_dp 3 %q\n return %a }").error.find("axis") != std::string::npos);
    CHECK(parse("function \"f\" (%q: i32) { %a = d_dp 0 %q\n return %a }").error.find("real") != std::string::npos);
}
