// What grad means, and what the gradient passes through.
#include "tests/lang/lower/evaluation.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel::lang::test;

TEST_CASE("lower: grad gives derivatives of any function")
{
    Inputs at;
    at.p = {2.0, 3.0, 5.0};
    const std::string functions = R"(
        float cubic(float x) { return x * x * x; }
        vec2 curve(float x) { return vec2(x * x, 1.0 / x); }
        float bump(vec3 q) { return q.x * q.y + q.z * q.z; }
        float scaled(float f(vec3), vec3 q, float k) { return k * f(q * 2.0); }
        vec3 dbump(vec3 q) { return grad(bump)(q); }
        float reads(vec3 q) { return q.x * p.y; }
        float early(float x) { if (x > 1.0) return x * x; return x; }
        float looped(float x) { float s = 1.0; for (int i = 0; i < 3; ++i) s *= x; return s; }
    )";
    check_values({{"grad(cubic)(p.x)", 12},
                  {"grad(grad(cubic))(p.x)", 12},
                  {"grad(grad(grad(cubic)))(p.x)", 6},
                  {"grad(curve)(p.x).x + grad(curve)(p.x).y", 4 - 0.25},
                  {"grad(grad(curve))(p.x).y", 2.0 / 8},
                  {"dot(grad(bump)(p), vec3(1.0, 10.0, 100.0))", 3 + 20 + 1000},
                  {"dbump(p).z", 10},
                  {"grad(scaled)(bump, p, 3.0).z", 3 * 2 * 20},
                  {"grad(reads)(p).x + 10.0 * grad(reads)(p).y", 3},
                  {"grad(early)(p.x) + 10.0 * grad(early)(0.5)", 14},
                  {"grad(looped)(p.x)", 12},
                  {"grad(detach)(p.x)", 0},
                  {"grad(sqrt)(4.0)", 0.25},
                  {"grad(length)(vec3(0.0, 3.0, 4.0)).z", 0.8},
                  {"grad(length)(vec3(0.0)).x", 0}},
                 functions, at);
    // and the gradient of a texture that uses a derivative: d/dp of 3 x^2 at 2
    const Sample sample = evaluate(functions + "texture t() { return grad(cubic)(p.x); }", at);
    CHECK(sample.height == 12);
    CHECK(sample.gradient[0] == 12);
    CHECK(sample.gradient[1] == 0);
}

TEST_CASE("lower: the gradient passes through calls, loops and hidden inputs")
{
    Inputs at;
    at.p = {2.0, 3.0, 5.0};
    const Sample sample = evaluate(R"(
        float part(float k) { return k * p.y * p.y; }
        texture t() {
            float s = 0.0;
            for (int i = 0; i < 4; ++i) { if (i == 3) break; s += part(p.x) * i; }
            return s + sin(p.z);
        })",
                                   at);
    CHECK(sample.height == 3 * 2.0 * 9.0 + std::sin(5.0));
    CHECK(sample.gradient[0] == 3 * 9.0);
    CHECK(sample.gradient[1] == 3 * 2.0 * 6.0);
    CHECK(sample.gradient[2] == std::cos(5.0));
}

TEST_CASE("lower: stretch is the Frobenius norm of the derivative by p, wherever it is asked for")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    const std::string functions = R"(
        float asks(vec2 q) { return stretch(q); }
        float asks_of(float f(vec2), vec2 q) { return f(q * 4.0); }
    )";
    check_values_near({{"stretch(p)", std::sqrt(3.0)},
                       {"stretch(vec3(p.xy, 1.0))", std::sqrt(2.0)},
                       {"stretch(p.x * p.z)", std::sqrt(9.25)},
                       {"stretch(3.0)", 0.0},
                       {"stretch(detach(p))", 0.0},
                       {"asks(2.0 * p.xy)", std::sqrt(8.0)},
                       {"asks_of(asks, p.yz)", std::sqrt(32.0)},
                       {"asks_of(stretch, p.yz)", std::sqrt(32.0)}},
                      functions, at);
    // the stretch of x^2 / 2 is abs(x)
    const Sample sample = evaluate("texture t() { return stretch(0.5 * p.x * p.x); }", at);
    CHECK(sample.height == 0.5);
    CHECK(sample.gradient[0] == 1.0);
    CHECK(sample.gradient[1] == 0.0);
}
