// What programs mean: source in, values out. The truth is arithmetic done by hand or by C++ beside the expectation.
#include "lang/abi.h"
#include "tests/lang/evaluation.h"
#include "tests/support/catch.h"

#include <cmath>
#include <glm/glm.hpp>
#include <limits>

using namespace haptel::lang::test;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Case {
    std::string expression;
    double value;
};

void check_all(const std::vector<Case>& cases, const std::string& declarations = {}, const Inputs& inputs = {})
{
    for (const Case& c : cases) {
        INFO(c.expression);
        CHECK(value_of(c.expression, declarations, inputs) == c.value);
    }
}

// Within a few roundings.
void check_near(const std::vector<Case>& cases, const std::string& declarations = {}, const Inputs& inputs = {})
{
    for (const Case& c : cases) {
        INFO(c.expression);
        CHECK(std::fabs(value_of(c.expression, declarations, inputs) - c.value) <= 4e-16 * std::fabs(c.value));
    }
}

} // namespace

TEST_CASE("lower: arithmetic of reals")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    check_all({{"p.x + p.y", 0.25},
               {"p.x - p.y - p.z", -2.25},
               {"p.z - (p.x - p.y)", 2.25},
               {"p.x * p.y * 8.0", -1.0},
               {"p.z / p.x / 2.0", 3.0},
               {"-p.z", -3.0},
               {"+p.z", 3.0},
               {"2.0 + 3.0 * p.z", 11.0},
               {"1mm + 1um + 1nm + 1cm + 1m", 0.001 + 1e-6 + 1e-9 + 0.01 + 1.0},
               {"float(p.x < p.z) + 2.0 * float(p.x <= 0.5) + 4.0 * float(p.x > p.z) + 8.0 * float(p.x >= 0.5)", 11.0},
               {"float(p.x == 0.5) + 2.0 * float(p.x != 0.5)", 1.0},
               {"p.x > 0.0 ? 1.0 : 2.0", 1.0},
               {"p.x > 0.0 && p.y > 0.0 ? 1.0 : 2.0", 2.0},
               {"p.x > 0.0 || p.y > 0.0 ? 1.0 : 2.0", 1.0},
               {"p.x > 0.0 ^^ p.z > 0.0 ? 1.0 : 2.0", 2.0},
               {"!(p.x > 0.0) ? 1.0 : 2.0", 2.0},
               {"(p.x > 0.0) == (p.y < 0.0) ? 1.0 : 2.0", 1.0}},
              {}, at);
}

TEST_CASE("lower: integers wrap, divide toward zero and never trap")
{
    const std::string functions = R"(
        float i(int x) { return x; }
        float u(uint x) { return x; }
        int big() { return 2147483647; }
        uint ubig() { return 4294967295u; }
        int zero() { return int(p.x); }
    )";
    check_all({{"i(big() + 1)", -2147483648.0},
               {"i(-big() - 2)", 2147483647.0},
               {"i(big() * 2)", -2.0},
               {"i(7 / 2) + 10 * i(-7 / 2)", 3.0 - 30.0},
               {"i(7 % 3) + 10 * i(-7 % 3)", 1.0 - 10.0},
               {"i(7 / zero()) + i(7 % zero())", 0.0},
               {"i((-big() - 1) / (zero() - 1))", -2147483648.0},
               {"i(6 & 3) + 10 * i(6 | 3) + 100 * i(6 ^ 3) + 1000 * i(~6)", 2 + 70 + 500 - 7000},
               {"i(1 << 4) + i(-16 >> 2) + i(1 << 33)", 16 - 4 + 2},
               {"u(ubig() + 1u)", 0.0},
               {"u(0u - 1u)", 4294967295.0},
               {"u(ubig() * ubig())", 1.0},
               {"u(ubig() / 2u) + u(ubig() % 10u)", 2147483647.0 + 5.0},
               {"u(ubig() >> 28) + u(~0u & 15u) + u(3u ^ 1u) + u(4u | 1u) + u(1u << 3)", 15 + 15 + 2 + 5 + 8},
               {"u(uint(-1)) - i(int(ubig()))", 4294967295.0 + 1.0},
               {"ubig() > 1u && big() > -1 && -1 < 0 ? 1.0 : 0.0", 1.0},
               {"i(int(2.9)) + 10 * i(int(-2.9)) + i(int(true))", 2 - 20 + 1},
               {"i(int(1e30))", 2147483647.0},
               {"i(int(0.0 / p.x))", 0.0},
               {"u(uint(-3.0)) + u(uint(1e30))", 4294967295.0},
               {"-i(-5) + i(-(3)) + u(-1u)", 5 - 3 + 4294967295.0},
               {"i(abs(-3)) + i(sign(-9)) + i(min(2, -2)) + i(max(2, -2)) + i(clamp(9, 1, 4))", 3 - 1 - 2 + 2 + 4},
               {"u(min(2u, 5u)) + u(max(2u, 5u)) + u(clamp(9u, 1u, 4u))", 2 + 5 + 4},
               {"7 / 2", 3.0},
               {"7 / 2.0", 3.5}},
              functions);
}

TEST_CASE("lower: vectors, swizzles, constructors")
{
    Inputs at;
    at.p = {1.0, 2.0, 3.0};
    const std::string functions = "float digits(vec3 v) { return v.x * 100.0 + v.y * 10.0 + v.z; }\n"
                                  "float digits(vec2 v) { return v.x * 10.0 + v.y; }\n"
                                  "float digits(vec4 v) { return v.x * 1000.0 + digits(v.yzw); }\n";
    check_all({{"digits(p)", 123},
               {"digits(p.zyx)", 321},
               {"digits(p.bgr)", 321},
               {"digits(p.ts)", 21},
               {"digits(p.xxzz)", 1133},
               {"digits(vec3(7.0))", 777},
               {"digits(vec3(p.xy, 9))", 129},
               {"digits(vec4(p.z, p.yx, 4.0))", 3214},
               {"digits(vec2(p))", 12},
               {"digits(vec3(true, 2, 3u))", 123},
               {"float(p.yz)", 2},
               {"digits(p + p)", 246},
               {"digits(p * 2.0)", 246},
               {"digits(2.0 * p)", 246},
               {"digits(2 * p - vec3(1.0))", 135},
               {"digits(p * p)", 149},
               {"digits(-p)", -123},
               {"digits(6.0 / p)", 632},
               {"p == vec3(1.0, 2.0, 3.0) ? 1.0 : 0.0", 1},
               {"p != vec3(1.0, 2.0, 4.0) ? 1.0 : 0.0", 1},
               {"p == vec3(1.0, 2.0, 4.0) ? 1.0 : 0.0", 0},
               {"p[0] + 10.0 * p[2]", 31},
               {"p[int(p.y)]", 3},
               {"p[int(p.y) + 5] + 10.0 * p[int(-p.y)]", 13},
               {"p[uint(p.x)]", 2},
               {"digits(p.x > 0.0 ? p : p.zyx)", 123},
               {"digits(p.x < 0.0 ? p + p : p.zyx * 1.0)", 321}},
              functions, at);
    check_all({{"f()", 987}},
              functions + "float f() { vec3 v = p; v.zx = vec2(7.0, 9.0); v[1] = 4.0; v.y *= 2.0; return digits(v); }",
              at);
    check_all({{"f(1)", 153}, {"f(7)", 125}},
              functions + "float f(int k) { vec3 v = p; v[k] = 5.0; return digits(v); }", at);
}

TEST_CASE("lower: built-in functions")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    check_near({{"radians(180.0)", pi},
                {"degrees(1.0)", 180 / pi},
                {"sin(p.x) + cos(p.x) + tan(p.x)", std::sin(0.5) + std::cos(0.5) + std::tan(0.5)},
                {"asin(p.x)", std::asin(0.5)},
                {"acos(p.x)", std::acos(0.5)},
                {"atan(p.z)", std::atan(3.0)},
                {"atan(p.y, -p.x)", std::atan2(-0.25, -0.5)},
                {"sinh(p.x)", std::sinh(0.5)},
                {"cosh(p.x)", std::cosh(0.5)},
                {"tanh(p.x)", std::tanh(0.5)},
                {"asinh(p.x)", std::asinh(0.5)},
                {"acosh(p.z)", std::acosh(3.0)},
                {"atanh(p.x)", std::atanh(0.5)},
                {"pow(p.z, p.x)", std::sqrt(3.0)},
                {"exp(p.x)", std::exp(0.5)},
                {"exp2(p.z)", 8.0},
                {"log(p.z)", std::log(3.0)},
                {"log2(p.x)", -1.0},
                {"sqrt(p.z)", std::sqrt(3.0)},
                {"inversesqrt(p.z)", 1 / std::sqrt(3.0)},
                {"sinturn(0.125)", std::sqrt(0.5)},
                {"costurn(p.y)", 0.0},
                {"sinturn(p.y)", -1.0}},
               {}, at);
    check_all(
        {{"abs(p.y) + sign(p.y) + floor(p.y) + ceil(p.x) + trunc(-1.5) + fract(p.y)", 0.25 - 1 - 1 + 1 - 1 + 0.75},
         {"round(0.5) + 10.0 * round(1.5) + 100.0 * roundEven(2.5) + 1000.0 * round(-0.6)", 0 + 20 + 200 - 1000},
         {"mod(5.5, 2.0) + mod(p.y, 1.0)", 1.5 + 0.75},
         {"min(p.x, p.y) + max(p.x, p.y) + clamp(p.z, 0.0, 1.0)", -0.25 + 0.5 + 1.0},
         {"mix(2.0, 4.0, p.x) + step(p.x, 0.5) + step(p.z, 0.5)", 3.0 + 1.0 + 0.0},
         {"smoothstep(0.0, 1.0, p.x) + smoothstep(0.0, 1.0, -1.0) + smoothstep(0.0, 1.0, p.z)", 0.5 + 0.0 + 1.0},
         {"smoothstep(0.0, 1.0, 0.25)", 0.15625},
         {"fma(p.x, 4.0, 1.0)", 3.0},
         {"length(vec2(3.0, 4.0)) + length(vec3(1.0, 2.0, 2.0)) + length(vec4(2.0)) + length(-7.0)", 5 + 3 + 4 + 7},
         {"distance(p, p + vec3(1.0, 2.0, 2.0)) + distance(1.0, 3.0)", 5},
         {"dot(vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0)) + dot(2.0, 3.0)", 38},
         {"dot(cross(vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0)), vec3(1.0, 10.0, 100.0))", -3 + 60 - 300},
         {"normalize(vec3(0.0, 3.0, 4.0)).y + length(normalize(vec3(0.0))) + normalize(-2.0)", 0.6 - 1},
         {"faceforward(p, vec3(1.0, 0.0, 0.0), vec3(-1.0, 0.0, 0.0)).z", 3},
         {"faceforward(p, vec3(1.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0)).z", -3},
         {"reflect(vec2(1.0, -1.0), vec2(0.0, 1.0)).y", 1},
         {"refract(vec2(0.0, -1.0), vec2(0.0, 1.0), 0.5).y", -1},
         {"length(refract(vec2(0.8, -0.6), vec2(0.0, 1.0), 2.0))", 0},
         {"isnan(0.0 / (p.z - 3.0)) && !isnan(p.x) && isinf(1.0 / (p.z - 3.0)) && !isinf(p.x) ? 1.0 : 0.0", 1},
         {"detach(p.z)", 3},
         {"mod(vec2(5.5, 7.0), 2.0).x + min(vec2(1.0, 5.0), 2.0).y + mix(vec2(0.0), vec2(2.0), 0.5).x", 1.5 + 2 + 1},
         {"step(0.5, vec2(0.0, 1.0)).y + smoothstep(0.0, 1.0, vec2(0.0, 0.5)).y + clamp(vec2(3.0), 0.0, 1.0).x", 2.5}},
        {}, at);
}

TEST_CASE("lower: branches and early returns")
{
    const std::string functions = R"(
        float sign_of(float x) { if (x > 0.0) return 1.0; if (x < 0.0) { return -1.0; } return 0.0; }
        float grade(int n)
        {
            float s = 0.0;
            if (n == 0) s = 1.0;
            else if (n == 1) { s = 2.0; if (n > 0) return s * 10.0; s = 3.0; }
            else if (n == 2) s += 4.0;
            else { s = 5.0; if (n == 3) s = 6.0; else if (n == 4) return 7.0; s += 0.5; }
            s += 100.0;
            return s;
        }
        float nested(float x, float y)
        {
            float s = 1.0;
            if (x > 0.0) { if (y > 0.0) return 2.0; s = 3.0; } else { if (y > 0.0) s = 4.0; else return 5.0; }
            s *= 10.0;
            if (x > 1.0) return s;
            s += 1.0;
            return s;
        }
        float scoped(float x) { float s = x; { float t = s; s = t + 1.0; { float s = 100.0; t = s; } s += t; } return s; }
        float all_leave(float x) { if (x > 0.0) { return 1.0; } else { return 2.0; } }
    )";
    check_all({{"sign_of(2.0)", 1},
               {"sign_of(-2.0)", -1},
               {"sign_of(0.0)", 0},
               {"grade(0)", 101},
               {"grade(1)", 20},
               {"grade(2)", 104},
               {"grade(3)", 106.5},
               {"grade(4)", 7},
               {"grade(5)", 105.5},
               {"nested(1.0, 1.0)", 2},
               {"nested(1.0, -1.0)", 31},
               {"nested(2.0, -1.0)", 30},
               {"nested(-1.0, 1.0)", 41},
               {"nested(-1.0, -1.0)", 5},
               {"scoped(1.0)", 102},
               {"all_leave(1.0) + 10.0 * all_leave(-1.0)", 21}},
              functions);
}

TEST_CASE("lower: loops, break and return inside them")
{
    const std::string functions = R"(
        float sum(int n) { float s = 0.0; for (int i = 1; i <= min(n, 100); ++i) s += i; return s; }
        float down(int n) { float s = 0.0; for (int i = min(n, 9); i >= 0; i -= 2) s = s * 10.0 + i; return s; }
        float strides() { float s = 0.0; for (int i = 1; i < 10; i += 4) s = s * 10.0 + i; return s; }
        float wide(int a, int b) { float s = 0.0; for (int i = max(a, -2000000000); i < min(b, -1999999990); ++i) s += 1.0; return s; }
        float first_above(float x)
        {
            float found = -1.0;
            for (int i = 0; i < 10; ++i) {
                if (i * i > x) { found = i; break; }
                found = -2.0;
            }
            return found;
        }
        float leave(int n)
        {
            float s = 0.0;
            for (int i = 0; i < 5; ++i) {
                for (int j = 0; j < 5; ++j) {
                    if (j == 3) break;
                    if (i * 10 + j == n) return 1000.0 + s;
                    s += 1.0;
                }
                if (i == 3) break;
            }
            return s;
        }
        float unsigned_loop(uint n) { float s = 0.0; for (uint i = 1u; i < min(n, 10u); i += 2u) s = s * 10.0 + i; return s; }
        float unsigned_down() { float s = 0.0; for (uint i = 5u; i > 2u; --i) s = s * 10.0 + i; return s; }
        float swap(int n) { float a = 0.0, b = 1.0; for (int i = 0; i < min(n, 40); ++i) { float c = a + b; a = b; b = c; } return a; }
        float never() { float s = 7.0; for (int i = 3; i < 3; ++i) s = 0.0; for (int i = 5; i < 2; ++i) s = 0.0; return s; }
        float once() { float s = 0.0; for (int i = 4; i < 5; ++i) { if (s > 0.0) break; s += i; } return s; }
    )";
    check_all({{"sum(10)", 55},
               {"sum(0)", 0},
               {"sum(-2147483647)", 0},
               {"sum(1000)", 5050},
               {"down(7)", 7531},
               {"down(100)", 97531},
               {"down(-5)", 0},
               {"strides()", 159},
               {"wide(2147483647, -2147483647)", 0},
               {"wide(-2000000000, 5)", 10},
               {"first_above(20.0)", 5},
               {"first_above(1000.0)", -2},
               {"leave(12)", 1005},
               {"leave(99)", 12},
               {"leave(31)", 1010},
               {"leave(13)", 12},
               {"unsigned_loop(8u)", 1357},
               {"unsigned_loop(0u)", 0},
               {"unsigned_down()", 543},
               {"swap(10)", 55},
               {"never()", 7},
               {"once()", 4}},
              functions);
}

TEST_CASE("lower: constants and tables; an index outside is clamped")
{
    const std::string declarations = R"(
        const int N = 3;
        const float A[N] = {1.0, 2, -0.5 * N};
        const vec2 V[] = {vec2(1.0, 2.0), vec2(3.0, 4.0)};
        const int I[2] = {-7, 2147483647};
        const uint U[2] = {7u, 4294967295u};
        const vec2 K = vec2(A[0], N) * 2.0;
        const float TURN = 2.0 * radians(180.0);
        float at(int k) { return A[k]; }
        float local(int k) { const float S = 2.0; const float B[2] = {S, S * S}; const float c = B[k] + 1.0; return c; }
    )";
    check_all({{"at(0)", 1},
               {"at(2)", -1.5},
               {"at(3)", -1.5},
               {"at(-1)", 1},
               {"at(2147483647)", -1.5},
               {"V[1].x * 10.0 + V[0].y", 32},
               {"I[0] + I[1]", 2147483640.0},
               {"U[1]", 4294967295.0},
               {"A[uint(5.0)]", -1.5},
               {"K.x + K.y", 8},
               {"TURN", 2 * pi},
               {"local(0) + 10.0 * local(1)", 53}},
              declarations);
}

TEST_CASE("lower: overloads and functions as arguments")
{
    Inputs at;
    at.p = {2.0, 3.0, 5.0};
    const std::string functions = R"(
        float area(float r) { return r * r; }
        float area(vec2 v) { return v.x * v.y; }
        float area(vec3 v) { return area(v.xy) + area(v.yz); }
        float area(int n) { return -n; }
        float twice(float f(float), float x) { return f(f(x)); }
        float sum(float f(vec3), vec3 q, int n) { float s = 0.0; for (int i = 0; i < min(n, 8); ++i) s += f(q * i); return s; }
        float compose(float f(float), float g(float), float x) { return twice(f, x) + 100.0 * g(x); }
        float shift(float x) { return x + p.z; }
        float late(float x) { return later(x) + 1.0; }
        float later(float x) { return x * 10.0; }
        float square(float x) { return x * x; }
    )";
    check_all({{"area(3.0)", 9},
               {"area(p.xy)", 6},
               {"area(p)", 21},
               {"area(4)", -4},
               {"twice(square, p.x)", 16},
               {"twice(abs, -p.x)", 2},
               {"twice(shift, 1.0)", 11},
               {"sum(area, p, 3)", 21 + 84},
               {"compose(square, shift, 2.0)", 16 + 700},
               {"compose(shift, square, 2.0)", 12 + 400},
               {"late(2.0)", 21}},
              functions, at);
}

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
    check_all({{"deep()", 237}, {"n.z + uv.y + footprint", 1.501}, {"hidden(3.0)", 3}}, functions, at);
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
    check_all({{"grad(cubic)(p.x)", 12},
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

TEST_CASE("lower: stretch is the Frobenius norm of the derivative by p, wherever it is asked for")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    const std::string functions = R"(
        float asks(vec2 q) { return stretch(q); }
        float asks_of(float f(vec2), vec2 q) { return f(q * 4.0); }
    )";
    check_near({{"stretch(p)", std::sqrt(3.0)},
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

TEST_CASE("lower: matrices are GLSL's, as GLM computes them")
{
    const glm::dvec3 q(0.5, -0.25, 3.0), r(2.0, 1.5, -1.0);
    Inputs at;
    at.p = {q.x, q.y, q.z};
    const std::string functions = R"(
        vec3 r() { return vec3(2.0, 1.5, -1.0); }
        mat3 a() { return mat3(p, p.yzx, 1.0, 2.0, p.x); }
        mat3 b() { return mat3(2.0) + outerProduct(r(), p); }
        mat2 c() { return mat2(p.x, 2.0, p.yz); }
        mat4 d() { return mat4(vec4(p, 1.0), vec4(1.0, r()), 5.0, p.zxy, vec4(0.25, -2.0, p.xz)); }
        mat3 stored(int i)
        {
            mat3 m = a();
            m[1] = r();
            m[i][2] = 7.0;
            m[2].yx += p.xy;
            m *= b();
            return m;
        })";
    const glm::dmat3 a(q, glm::dvec3(q.y, q.z, q.x), glm::dvec3(1, 2, q.x)),
        b = glm::dmat3(2.0) + glm::outerProduct(r, q);
    const glm::dmat2 c(q.x, 2.0, q.y, q.z);
    const glm::dmat4 d(glm::dvec4(q, 1), glm::dvec4(1, r), glm::dvec4(5, q.z, q.x, q.y),
                       glm::dvec4(0.25, -2, q.x, q.z));
    glm::dmat3 stored = a;
    stored[1] = r;
    stored[0][2] = 7;
    stored[2] += glm::dvec3(q.y, q.x, 0);
    stored *= b;

    const auto check = [&](const std::string& expression, const auto& expected) {
        for (int column = 0; column < expected.length(); ++column)
            for (int row = 0; row < expected.length(); ++row) {
                const std::string part =
                    "(" + expression + ")[" + std::to_string(column) + "][" + std::to_string(row) + "]";
                INFO(part);
                CHECK(std::fabs(value_of(part, functions, at) - expected[column][row]) <=
                      1e-14 * std::fmax(1.0, std::fabs(expected[column][row])));
            }
    };
    const auto check_vector = [&](const std::string& expression, const glm::dvec3& expected) {
        for (int row = 0; row < 3; ++row)
            CHECK(std::fabs(value_of("(" + expression + ")[" + std::to_string(row) + "]", functions, at) -
                            expected[row]) <= 1e-14);
    };
    check("a()", a);
    check("a() * b()", a * b);
    check("a() + b() - 2.0 * a() / 4.0", a + b - 2.0 * a / 4.0);
    check("a() / b()", glm::dmat3(a[0] / b[0], a[1] / b[1], a[2] / b[2]));
    check("-a()", -a);
    check("1.0 - a()", 1.0 - a);
    check("transpose(a())", glm::transpose(a));
    check("matrixCompMult(a(), b())", glm::matrixCompMult(a, b));
    check("outerProduct(p, r())", glm::outerProduct(q, r));
    check("inverse(c())", glm::inverse(c));
    check("inverse(a())", glm::inverse(a));
    check("inverse(d())", glm::inverse(d));
    check("mat3(d())", glm::dmat3(d));
    check("mat4(a())", glm::dmat4(a));
    check("mat2(3.0)", glm::dmat2(3.0));
    check("stored(0)", stored);
    check_vector("a() * r()", a * r);
    check_vector("r() * a()", r * a);
    check_near({{"determinant(c())", glm::determinant(c)},
                {"determinant(a())", glm::determinant(a)},
                {"a() == a() && a() != b() ? 1.0 : 0.0", 1.0},
                {"a()[int(p.z) - 2][int(p.z) - 3]", a[1][0]},
                {"a()[int(p.z)].y", a[2].y}}, // clamped to the last column
               functions, at);
    CHECK(std::fabs(value_of("determinant(d())", functions, at) - glm::determinant(d)) <=
          1e-14 * std::fabs(glm::determinant(d)));
}

TEST_CASE("lower: derivatives of matrices, and matrices of derivatives")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    const double x = 0.5, y = -0.25, z = 3.0;
    const std::string functions = R"(
        vec3 f(vec3 q) { return vec3(q.x * q.y, sin(q.z) * q.x, q.y); }
        float g(vec3 q) { return q.x * q.x * q.y + exp(q.z * q.x); }
        vec2 h(vec2 q) { return vec2(q.x * q.x, q.x * q.y); }
        float entry(float basis(vec3), vec3 q, int i, int j) { return grad(grad(basis))(q)[i][j]; }
        mat2 turn(float a) { return mat2(cos(a), sin(a), -sin(a), cos(a)); }
    )";
    // column j is the derivative by component j
    check_near({{"grad(f)(p)[0][0]", y},
                {"grad(f)(p)[0][1]", std::sin(z)},
                {"grad(f)(p)[0][2]", 0.0},
                {"grad(f)(p)[1][0]", x},
                {"grad(f)(p)[1][2]", 1.0},
                {"grad(f)(p)[2][1]", x * std::cos(z)},
                {"grad(h)(p.xy)[0].x", 2 * x},
                {"grad(h)(p.xy)[0].y", y},
                {"grad(h)(p.xy)[1].x", 0.0},
                {"grad(h)(p.xy)[1].y", x},
                {"(grad(h)(p.xy) * vec2(1.0, 0.0)).y", y},
                {"grad(turn)(p.x)[0][1]", std::cos(x)},
                {"grad(grad(turn))(p.x)[1][0]", std::sin(x)}},
               functions, at);
    const double e = std::exp(z * x);
    const double hessian[3][3] = {
        {2 * y + z * z * e, 2 * x, e + x * z * e}, {2 * x, 0, 0}, {e + x * z * e, 0, x * x * e}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const std::string index = std::to_string(i) + ", " + std::to_string(j);
            INFO(index);
            CHECK(std::fabs(value_of("entry(g, p, " + index + ")", functions, at) - hessian[i][j]) <= 1e-14);
        }
    // d(inverse) = -inverse dm inverse: the derivative of the inverse by the matrix, checked through the gradient
    const Sample sample = evaluate("texture t() { mat3 m = mat3(2.0) + outerProduct(p, vec3(1.0, 2.0, 3.0)); "
                                   "return inverse(m)[1][0]; }",
                                   at);
    const glm::dvec3 u(1, 2, 3);
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(2.0) + glm::outerProduct(glm::dvec3(x, y, z), u));
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 along(0);
        along[axis] = 1;
        const glm::dmat3 derivative = -inverse * glm::outerProduct(along, u) * inverse;
        CHECK(std::fabs(sample.gradient[static_cast<size_t>(axis)] - derivative[1][0]) <= 1e-15);
    }
}

TEST_CASE("lower: arrays of a body, their elements by constant and by run-time indices")
{
    const std::string functions = R"(
        float sum(float a[4]) { float s = 0.0; for (int i = 0; i < 4; ++i) s += a[i]; return s; }
        float[4] powers(float x) { float a[4]; float y = 1.0; for (int i = 0; i < 4; ++i) { a[i] = y; y *= x; } return a; }
        float[4] swapped(float a[4], int i, int j) { float t = a[i]; a[i] = a[j]; a[j] = t; return a; }
        float sorted(vec3 q, int k) // bubble sort
        {
            float a[3] = {q.x, q.y, q.z};
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j)
                    if (a[j] > a[j + 1]) { float t = a[j]; a[j] = a[j + 1]; a[j + 1] = t; }
            return a[k];
        }
        float parts(int k)
        {
            vec2 a[3] = {vec2(1.0, 2.0), vec2(3.0, 4.0), vec2(5.0, 6.0)};
            a[k].y = 40.0;
            a[2].x += 100.0;
            a[k + 1][0] = 7.0;
            return a[0].x + a[0].y + a[1].x + a[1].y + a[2].x + a[2].y;
        }
        int counted() { int n[2] = {1, 2}; n[1] += n[0]; bool b[2]; b[0] = n[1] == 3; b[1] = false; return b[0] ? n[1] : 0; }
    )";
    Inputs at;
    at.p = {3.0, -1.0, 2.0};
    check_all({{"sum(powers(2.0))", 15.0},
               {"powers(3.0)[int(p.z)]", 9.0},
               {"swapped(powers(2.0), 0, int(p.x))[0]", 8.0},
               {"swapped(powers(2.0), 0, int(p.x))[3]", 1.0},
               {"sorted(p, 0)", -1.0},
               {"sorted(p, 1)", 2.0},
               {"sorted(p, 2)", 3.0},
               {"sorted(p, 9)", 3.0},                   // clamped
               {"parts(1)", 1 + 2 + 3 + 40 + 7 + 6},    // a[2].x is overwritten
               {"parts(-5)", 7 + 40 + 3 + 4 + 105 + 6}, // both indices clamped to 0
               {"counted()", 3.0}},
              functions, at);
    // the derivative follows the elements: the median is p.z here
    const Sample sample = evaluate(functions + "texture t() { return sorted(p, 1) * powers(p.x)[2]; }", at);
    CHECK(sample.height == 18);
    CHECK(sample.gradient == std::array{2.0 * 2 * 3, 0.0, 9.0});
}
