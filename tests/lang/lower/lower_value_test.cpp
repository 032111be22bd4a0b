// What expressions mean: source in, values out. The truth is arithmetic done by hand or by C++ beside the expectation.
#include "tests/lang/lower/evaluation.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel::lang::test;

namespace {

constexpr double pi = 3.14159265358979323846;

} // namespace

TEST_CASE("lower: arithmetic of reals")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    check_values(
        {{"p.x + p.y", 0.25},
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
    check_values({{"i(big() + 1)", -2147483648.0},
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
    check_values({{"digits(p)", 123},
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
    check_values(
        {{"f()", 987}},
        functions + "float f() { vec3 v = p; v.zx = vec2(7.0, 9.0); v[1] = 4.0; v.y *= 2.0; return digits(v); }", at);
    check_values({{"f(1)", 153}, {"f(7)", 125}},
                 functions + "float f(int k) { vec3 v = p; v[k] = 5.0; return digits(v); }", at);
}

TEST_CASE("lower: built-in functions")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    check_values_near({{"radians(180.0)", pi},
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
    check_values(
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
    check_values({{"at(0)", 1},
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
    check_values({{"sum(powers(2.0))", 15.0},
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
