// What reaches a texture from outside, and what it writes.
#include "lang/abi/abi.h"
#include "tests/lang/lower/evaluation.h"
#include "tests/support/catch.h"

using namespace haptel::lang::test;

TEST_CASE("lower: inputs reach functions, and only what is read is marked as read")
{
    Inputs at;
    at.p = {1.0, 2.0, 3.0};
    at.n = {0.0, 0.0, 1.0};
    at.uv = {0.25, 0.5};
    at.center = {10.0, 20.0, 30.0};
    at.extent = {100.0, 200.0, 300.0};
    at.time_s = 7.0;
    at.footprint_m = 0.001;
    const std::string functions =
        "float deep() { return deeper() + time; }\nfloat deeper() { return extent.y + center.z; }\n"
        "float hidden(float time) { return time; }\n";
    check_values({{"deep()", 237}, {"n.z + uv.y + footprint", 1.501}, {"hidden(3.0)", 3}}, functions, at);
}

TEST_CASE("lower: parameters, clamped where they are int with a range")
{
    const std::string source =
        "texture t(float a = 2mm in 1mm .. 3mm, int n = 4 in 1 .. 8, uint u = 2u in 1u .. 3u, bool b = true)"
        "{ float s = 0.0; for (int i = 0; i < n; ++i) s += 1.0; return b ? s + a + 100.0 * u : -1.0; }";
    Inputs set;
    CHECK(evaluate(source).height == 4 + 0.002 + 200);
    set.parameters = {0.5, 6, 3, 1};
    CHECK(evaluate(source, set).height == 6 + 0.5 + 300);
    set.parameters = {0.0, 1e9, 1000, 1};
    CHECK(evaluate(source, set).height == 8 + 0.0 + 300);
    set.parameters = {0.0, -5, 0, 0};
    CHECK(evaluate(source, set).height == -1);
}

TEST_CASE("lower: material outputs are 1 where the path taken does not assign them, and never not finite")
{
    const std::string source = R"(
        texture t(out float friction_scale, out float stiffness_scale)
        {
            if (p.x < 0.0) return p.y; // before any assignment
            friction_scale = 2.0 + p.x;
            for (int i = 0; i < 4; ++i) {
                if (p.x > 2.0) break;
                stiffness_scale *= 2.0;
            }
            if (p.x > 5.0) friction_scale = log(p.y);
            return p.x * p.y;
        })";
    const auto at = [&](double x, double y) {
        Inputs inputs;
        inputs.p = {x, y, 0};
        return evaluate(source, inputs);
    };
    const std::vector<double> untouched{1, 1}, doubled{16, 3}, left{1, 5};
    CHECK(at(-1, 7).outputs == untouched);
    CHECK(at(-1, 7).height == 7);
    CHECK(at(1, 7).outputs == doubled); // stiffness first, whatever the order of declaration
    CHECK(at(1, 7).height == 7);
    CHECK(at(1, 7).gradient == std::array{7.0, 1.0, 0.0});
    CHECK(at(3, 7).outputs == left);
    const Sample faulty = at(6, -1);
    CHECK(faulty.outputs == untouched);
    CHECK(faulty.faults == HAPTEL_FAULT_OUTPUT_NOT_FINITE);
    CHECK(faulty.height == -6);
    CHECK(faulty.gradient == std::array{-1.0, 6.0, 0.0});
}
