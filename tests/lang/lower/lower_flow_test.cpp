// What branches, loops and calls mean.
#include "lang/check/check.h"
#include "lang/compile.h"
#include "lang/ir/print.h"
#include "lang/lower/lower.h"
#include "lang/syntax/parser.h"
#include "tests/lang/lower/evaluation.h"
#include "tests/support/catch.h"

using namespace haptel::lang::test;

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
    check_values({{"sign_of(2.0)", 1},
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
    check_values({{"sum(10)", 55},
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
    check_values({{"area(3.0)", 9},
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

TEST_CASE("lower: a choice branches where a side is work, and selects where both are at hand")
{
    const auto branches = [](const std::string& choice) {
        const auto compiled =
            haptel::lang::compile({"choice.haptel", "texture t() { return 1m * (" + choice + "); }"}, {});
        REQUIRE(compiled.program);
        return haptel::ir::print(compiled.program->module).find(" if ") != std::string::npos;
    };
    for (const char* choice : {"time > 0s ? uv.x : uv.y", "time > 0s ? -uv.x : 1.0", "time > 0s ? 2.0 : -uv.y"}) {
        CAPTURE(choice);
        CHECK(!branches(choice));
    }
    for (const char* choice :
         {"time > 0s ? exp(uv.x) : uv.y", "time > 0s ? -exp(uv.x) : 1.0", "time > 0s ? uv.x : 1.0 / uv.y"}) {
        CAPTURE(choice);
        CHECK(branches(choice));
    }
}

TEST_CASE("lower: a variable without a value is told as a mistake of the compiler's own, and read as 0")
{
    using namespace haptel::lang;
    SourceSet sources;
    Diagnostics diagnostics;
    sources.add({"loop.haptel", "texture t() { float h = 0.0; for (int i = 0; i < 4; ++i) h += 1m; return h; }"});
    std::vector<CheckFile> files;
    files.push_back({parse(sources, 0, diagnostics), {}});
    const CheckedProgram program = check(sources, std::move(files), nullptr, diagnostics);
    REQUIRE_FALSE(diagnostics.has_errors());
    // What the checker refuses: a bound that is the counter.
    const auto& body = std::get<ast::Scope>(program.textures[0].tree->body->node);
    ast::Expression bound{{}, ast::NameExpression{"i"}, int_type};
    LoopPlan& plan = std::get<ast::For>(body.statements[1]->node).plan;
    std::get<ast::NameExpression>(bound.node).symbol = plan.counter;
    plan.bound = &bound;
    lower(program, {}, diagnostics);
    REQUIRE(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].code == "internal-error");
    CHECK(diagnostics.all()[0].message == "the compiler reads 'i' before it has given it a value");
}
