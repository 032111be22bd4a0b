// The entries of a texture: never a value that is not finite, equal heights, gradient with respect to the surface
// point.
#include "lang/abi/abi.h"
#include "lang/ir/derive/differentiate.h"
#include "tests/lang/ir/ir_support.h"

#include <cmath>

using namespace ir_test;

namespace {

Module texture_of(const std::string& body)
{
    Module module = parsed("function \"body\" () {\n" + body + R"(
        }
        texture "t" {
          parameter "k" real 2 in 0 .. 4 unit "" offset 56
          block 64 reads 0 writes 0
          body "body"
        })");
    Differentiator(module).make_entries(module.textures[0]);
    REQUIRE(verify(module) == "");
    return module;
}

struct Sample {
    double height, gradient[3];
    uint32_t faults;
};

Sample sample(const Module& module, const EntryInputs<double>& inputs)
{
    Interpreter<double> machine(module);
    auto alone = machine.run(module.textures[0].height, {}, &inputs);
    const double height = alone[0].real;
    const uint32_t faults = alone[1].bits;
    auto both = machine.run(module.textures[0].height_gradient, {}, &inputs);
    CHECK(same(height, both[0].real));
    CHECK((both[4].bits & HAPTEL_FAULT_HEIGHT_NOT_FINITE) == faults);
    return {both[0].real, {both[1].real, both[2].real, both[3].real}, both[4].bits};
}

double& at(EntryInputs<double>& inputs, Input input)
{
    return inputs.input[static_cast<size_t>(input)];
}

} // namespace

TEST_CASE("entries: the gradient follows p, and n and uv by their Jacobians on the facet")
{
    Module module = texture_of(R"(
          %x = input p_x
          %n = input n_y
          %v = input uv_y
          %k = parameter 0 real
          %a = mul %x, %x
          %b = mul %n, %v
          %c = mul %b, %k
          %h = add %a, %c
          return %h)");
    CHECK(module.textures[0].reads == (HAPTEL_READS_POINT | HAPTEL_READS_NORMAL | HAPTEL_READS_UV));
    EntryInputs<double> inputs;
    inputs.parameters = {{2.0}};
    at(inputs, Input::p_x) = 3;
    at(inputs, Input::n_y) = 5;
    at(inputs, Input::uv_y) = 7;
    at(inputs, Input::n_dp_10) = 0.25; // dn_y/dp_x
    at(inputs, Input::n_dp_12) = 0.5;
    at(inputs, Input::uv_dp_11) = 2; // dv/dp_y
    // h = x^2 + k n v: dh = 2x dx + k (v dn + n dv)
    Sample s = sample(module, inputs);
    CHECK(s.height == 9 + 2 * 35);
    CHECK(s.gradient[0] == 6 + 2 * 7 * 0.25);
    CHECK(s.gradient[1] == 2 * 5 * 2.0);
    CHECK(s.gradient[2] == 2 * 7 * 0.5);
    CHECK(s.faults == 0);
}

TEST_CASE("entries: what is not finite becomes zero and a fault bit")
{
    Module root = texture_of("%x = input p_x\n %h = log %x\n return %h");
    EntryInputs<double> inputs;
    inputs.parameters = {{2.0}};
    for (double x : {-1.0, 0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        at(inputs, Input::p_x) = x;
        Sample s = sample(root, inputs);
        CAPTURE(x);
        CHECK(s.height == 0);
        CHECK(s.gradient[0] == 0);
        CHECK((s.faults & HAPTEL_FAULT_HEIGHT_NOT_FINITE) != 0);
    }
    at(inputs, Input::p_x) = 2;
    CHECK(sample(root, inputs).faults == 0);

    // a height of 1e300 at most, whose slope of 1e600 is no number
    Module steep = texture_of(R"(
          %x = input p_x
          %big = real 1e300
          %y = mul %x, %big
          %s = sinturn %y
          %h = mul %s, %big
          return %h)");
    at(inputs, Input::p_x) = 1e-300;
    Sample s = sample(steep, inputs);
    CHECK(s.gradient[0] == 0);
    CHECK(s.faults == HAPTEL_FAULT_GRADIENT_NOT_FINITE);
}

TEST_CASE("entries: a texture that reads nothing is flat")
{
    Module module = texture_of("%h = real 0.001\n return %h");
    CHECK(module.textures[0].reads == 0);
    EntryInputs<double> inputs;
    inputs.parameters = {{2.0}};
    Sample s = sample(module, inputs);
    CHECK(s.height == 0.001);
    CHECK((s.gradient[0] == 0 && s.gradient[1] == 0 && s.gradient[2] == 0 && s.faults == 0));
}
