// Dimensions: their arithmetic, whom a finding blames, and that the work is bounded. What is said about single
// expressions is in golden/dimensions.haptel.
#include "lang/check/dimension/dimension.h"
#include "lang/compile.h"
#include "tests/lang/lower/evaluation.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>

using namespace haptel::lang;

namespace {

using Dimensions = std::vector<Dimension>;

const Dimension length = Dimension::length(), period = Dimension::time(), plain = Dimension::plain();

CompileOptions with_library(std::string text)
{
    CompileOptions options;
    options.library.push_back({"library/all.haptel", std::move(text)});
    return options;
}

// "line:column message", a line each.
std::string said(const CompileResult& result)
{
    std::string all;
    for (const Diagnostic& diagnostic : result.diagnostics.all()) {
        const Position at = result.sources.position(diagnostic.span.file, diagnostic.span.begin);
        all += std::to_string(at.line) + ":" + std::to_string(at.column) + " " + diagnostic.message + "\n";
    }
    return all;
}

double seconds_to_compile(const std::string& text, std::string& messages)
{
    const auto begin = std::chrono::steady_clock::now();
    messages = said(compile({"main.haptel", text}, {}));
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace

TEST_CASE("dimension: products, quotients and powers add, subtract and multiply exponents")
{
    CHECK(length * length == Dimension::of({2, 1}, {}));
    CHECK(length / length == plain);
    CHECK(plain / period == Dimension::frequency());
    CHECK((length * length).power({1, 2}) == length);
    CHECK(length.power({1, 2}) * length.power({1, 2}) == length);
    CHECK(length.power({1, 3}).power({3, 1}) == length);
    CHECK(length.power({1, 2}) != length.power({1, 3}));
    CHECK((length * Dimension::any()).is_any());
    CHECK(join(length, Dimension::any()) == length);
    CHECK(join(Dimension::any(), length) == length);
    CHECK(!join(length, plain));
    // a power that has lost all meaning fits everything instead of overflowing
    Dimension huge = length;
    for (int i = 0; i < 200; ++i) huge = huge * huge;
    CHECK(huge.is_any());
}

TEST_CASE("dimension: exponents are fractions, but for rounding")
{
    CHECK(exponent_near(1.0 / 3.0) == Exponent{1, 3});
    CHECK(exponent_near(-1.5) == Exponent{-3, 2});
    CHECK(exponent_near(0.0) == Exponent{0, 1});
    CHECK(exponent_near(0.37) == Exponent{37, 100});
    CHECK(!exponent_near(3.141592653589793));
    CHECK(!exponent_near(1e300));
    CHECK(!exponent_near(std::numeric_limits<double>::quiet_NaN()));
    CHECK(!exponent_near(std::numeric_limits<double>::infinity()));
}

TEST_CASE("dimension: names that people use")
{
    CHECK(description(length) == "a length");
    CHECK(description(length / period) == "a speed");
    CHECK(description(length * length * length * length / period) == "a quantity in m^4 s^-1");
    CHECK(description(length.power({1, 2})) == "a quantity in m^1/2");
    CHECK(factor_to_plain(length / period) == " / 1m * 1s");
    CHECK(factor_to_plain(length.power({1, 2})).empty());
    CHECK(dimension_of_unit("um") == length);
    CHECK(dimension_of_unit("kHz") == Dimension::frequency());
    CHECK(dimension_of_unit("deg") == plain);
    CHECK(dimension_of_unit("") == plain);
}

TEST_CASE("dimension: a rule knows what comes first, and what comes later tells of what was 0")
{
    const std::vector<Dimension> product{length, period, length * period}, wrong{length, period, length};
    CHECK(apply_rule(BuiltinId::fma, product).fits);
    CHECK(apply_rule(BuiltinId::fma, product).result == length * period);
    CHECK(!apply_rule(BuiltinId::fma, wrong).fits);
    CHECK(apply_rule(BuiltinId::max, std::vector{Dimension::any(), length}).result == length);
    CHECK(apply_rule(BuiltinId::clamp, std::vector{length, Dimension::any(), plain}).argument == 2);
    CHECK(apply_rule(BuiltinId::sqrt, std::vector{Dimension::any()}).result.is_any());
}

// A length in other units is the same length: where a rule accepts lengths and gives a length to the k, the function
// of arguments 4 times as large must be 4^k times as large; where it refuses, there must be no such k.
TEST_CASE("dimension: the rule of every built-in function is how it scales")
{
    constexpr double scale = 4;
    constexpr uint32_t samples = 24;
    const std::set<BuiltinId> angles{BuiltinId::radians, BuiltinId::degrees}; // plain by what they mean, though linear
    uint32_t random = 1;
    const auto next = [&] { // 0.02 .. 3: inside and outside of what acos and acosh take
        random = random * 1664525u + 1013904223u;
        return 0.02 * std::pow(150.0, random / 4294967296.0);
    };
    const auto text_of = [](const std::vector<double>& parts) {
        char number[40];
        std::string text = parts.size() == 1 ? "" : "vec3(";
        for (size_t i = 0; i < parts.size(); ++i) {
            std::snprintf(number, sizeof number, "%s%.17g", i > 0 ? ", " : "", parts[i]);
            text += number;
        }
        return parts.size() == 1 ? "float(" + text + ")" : text + ")";
    };
    size_t functions = 0, refusals = 0;
    for (const auto& [name, overloads] : builtin_overloads()) {
        for (const BuiltinOverload& overload : overloads) {
            const auto fits_here = [](Type type) { return type == float_type || type == vec(3); };
            const auto& parameters = overload.parameters;
            if (!fits_here(overload.result) || overload.builtin->id == BuiltinId::stretch) continue;
            if (!std::ranges::all_of(parameters, [&](const auto& p) { return fits_here(p.type); })) continue;
            ++functions;
            for (uint32_t choice = 0; choice < 1u << parameters.size(); ++choice) {
                Dimensions dimensions;
                for (size_t i = 0; i < parameters.size(); ++i) dimensions.push_back(choice >> i & 1 ? length : plain);
                const DimensionResult rule = apply_rule(overload.builtin->id, dimensions);
                const Exponent power = rule.result.length_exponent();
                std::set<double> ratios;
                for (uint32_t sample = 0; sample < samples; ++sample) {
                    std::string before = std::string(name) + "(", after = before;
                    for (size_t i = 0; i < parameters.size(); ++i) {
                        std::vector<double> parts;
                        for (uint8_t c = 0; c < parameters[i].type.size; ++c) parts.push_back(next());
                        before += (i > 0 ? ", " : "") + text_of(parts);
                        for (double& part : parts) part *= choice >> i & 1 ? scale : 1;
                        after += (i > 0 ? ", " : "") + text_of(parts);
                    }
                    const std::string end = overload.result.is_vector() ? ").x" : ")";
                    const double x = test::value_of(before + end), y = test::value_of(after + end);
                    CAPTURE(before, after, x, y);
                    if (rule.fits) {
                        const double expected = x * std::pow(scale, double(power.numerator) / power.denominator);
                        CHECK(std::fabs(y - expected) <= 1e-12 * std::fabs(expected));
                    } else if (x != 0 || y != 0) { // 0 is also what a fault gives
                        ratios.insert(std::round(y / x * 1e6));
                    }
                }
                CAPTURE(name, choice);
                if (!rule.fits && !angles.contains(overload.builtin->id)) CHECK(ratios.size() > 1);
                refusals += !rule.fits;
            }
        }
    }
    CHECK(functions > 60);
    CHECK(refusals > 100);
}

TEST_CASE("dimension: library code is never blamed, the user's call is, at the argument that is wrong")
{
    const CompileOptions options =
        with_library("float deep(vec3 q) { vec3 cell = floor(q); return length(q - cell); }\n"
                     "float noise(vec3 q) { return deep(q); }\n"
                     "float rounded(float a, float b, float k) { return max(a - b, k) + a / k * k; }\n"
                     "float bumps(vec2 q, float r) { return sin(q.x) + exp(r); }\n"
                     "float over(float basis(vec3), vec3 q) { return basis(q * 2.0 + 1.0); }\n");
    const auto said_of = [&](const std::string& body) {
        const CompileResult result =
            compile({"main.haptel", "texture t(float d = 1mm) { return " + body + "; }"}, options);
        CHECK(result.program);
        return said(result);
    };
    CHECK(said_of("d * noise(p / d)") == "");
    CHECK(said_of("rounded(p.x, 0, d) + d * rounded(1.0, 2.0, 0.5)") == "");
    CHECK(said_of("d * noise(p)") == "1:45 noise() expects a plain number, got a length: divide by a wavelength\n");
    CHECK(said_of("rounded(p.x, 0.5, d)") == "1:48 rounded() expects a length as argument 2, got a plain number\n");
    CHECK(said_of("d + rounded(p.x, p.y, 0.1)") ==
          "1:57 rounded() expects a length as argument 3, got a plain number\n");
    CHECK(said_of("d * bumps(p.xy, d)") == "1:39 bumps() expects plain numbers, got a length and a length\n");
    CHECK(said_of("d * over(noise, p / d)") == "");
    CHECK(said_of("d * over(noise, p)") ==
          "1:51 over() expects a plain number, got a length: divide by a wavelength\n");
}

TEST_CASE("dimension: what the library calls back is the user's own, with the user's call beside it")
{
    const CompileOptions options = with_library("float over(float basis(vec3), vec3 q) { return basis(q); }\n");
    const CompileResult result = compile({"main.haptel", "float mine(vec3 q) { return sin(q.x); }\n"
                                                         "texture t() { return 1mm * over(mine, p); }"},
                                         options);
    CHECK(said(result) == "1:33 sin() expects a plain number, got a length: divide by a wavelength\n");
    const Diagnostic& diagnostic = result.diagnostics.all().front();
    REQUIRE(diagnostic.related.size() == 1);
    CHECK(diagnostic.related[0].message == "'mine' is called here with a length");
    CHECK(result.sources.text(diagnostic.related[0].span) == "over(mine, p)");
}

TEST_CASE("dimension: one warning per expression, however many calls lead to it")
{
    std::string text = "float f(float x) { return sin(x); }\ntexture t() { return 1mm * (0.0";
    for (int i = 0; i < 40; ++i) text += " + f(p.x) + f(p.x * p.x) + f(time)";
    const CompileResult result = compile({"main.haptel", text + "); }"}, {});
    CHECK(result.diagnostics.all().size() == 1);
}

TEST_CASE("dimension: strict makes warnings errors, and then there is no program")
{
    CompileOptions options;
    const SourceFile file{"main.haptel", "texture t() { return sin(p.x); }"};
    CHECK(compile(file, options).program);
    options.strict = true;
    const CompileResult result = compile(file, options);
    CHECK(!result.program);
    REQUIRE(result.diagnostics.all().size() == 2);
    for (const Diagnostic& diagnostic : result.diagnostics.all()) {
        CHECK(diagnostic.severity == Severity::error);
        CHECK(diagnostic.code == "dimension");
    }
    CHECK(compile({"main.haptel", "texture t() { return 1mm * sin(p.x / 1mm); }"}, options).program);
}

TEST_CASE("dimension: what to write is said, and not written unseen: which length is meant is for the author to say")
{
    for (const char* value : {"1mm * sin(p.x)", "1mm * sin(p.x + p.y)", "p.x + 1.0", "max(2, p.x)", "1mm * cos(time)",
                              "p.x > 0.5 ? p.x : 1mm", "1mm * exp(true ? p.x : p.y)", "p.x - (-3e-3)",
                              "1mm * sin(p.x * p.y)", "1mm * log(1.0 / time)", "vec2(p.x, .5).y"}) {
        const std::string text = std::string("texture t() { return ") + value + "; }";
        const CompileResult before = compile({"main.haptel", text}, {});
        INFO(text);
        REQUIRE(before.diagnostics.all().size() == 1);
        CHECK(before.diagnostics.all()[0].hint != "");
        CHECK(!before.diagnostics.all()[0].fix);
    }
}

TEST_CASE("dimension: work is bounded where calls, loops and dimensions multiply")
{
    // 2^60 paths through 60 functions, two dimensions each
    std::string calls = "float f0(float x, float y) { return x / y; }\n";
    for (int i = 1; i < 60; ++i) {
        const std::string callee = "f" + std::to_string(i - 1);
        calls += "float f" + std::to_string(i) + "(float x, float y) { return " + callee + "(x, y) + " + callee +
                 "(x * 1.0, y) + " + callee + "(x, y); }\n";
    }
    calls += "texture t() { return 1mm * (f59(1.0, 2.0) + f59(p.x, p.y)) + f59(p.x, 1.0); }";
    // new dimensions at every level: their number doubles
    std::string dimensions = "float g0(float x, float y) { return 1.0; }\n";
    for (int i = 1; i < 40; ++i) {
        const std::string callee = "g" + std::to_string(i - 1);
        dimensions += "float g" + std::to_string(i) + "(float x, float y) { return " + callee + "(x * p.x, y) + " +
                      callee + "(x, y * time) + " + callee + "(y, x); }\n";
    }
    dimensions += "texture t() { return 1mm * g39(1.0, 2.0); }";
    // loops inside loops, each with a variable that starts from 0
    std::string loops = "texture t() { float s = 0.0;\n";
    for (int i = 0; i < 60; ++i) {
        const std::string n = std::to_string(i);
        loops += "float v" + n + " = 0; for (int i" + n + " = 0; i" + n + " < 1; ++i" + n + ") { v" + n + " += s;\n";
    }
    loops += "s += p.x;" + std::string(60, '}') + " return s; }";
    std::string chain = "texture t() { return p.x";
    for (int i = 0; i < 9'000; ++i) chain += " + p.x";
    chain += " + 1.0; }";

    // 2^20 choices of dimensions for one function: more than anybody's patience
    std::string names, values, choices;
    for (int i = 0; i < 20; ++i) names += (i > 0 ? ", float x" : "float x") + std::to_string(i);
    for (int level = 0; level <= 20; ++level) {
        std::string same, changed;
        for (int i = 0; i < 20; ++i) {
            const std::string x = (i > 0 ? ", x" : "x") + std::to_string(i);
            same += x;
            changed += x + (i + 1 == level ? " * p.x" : "");
        }
        const std::string callee = "h" + std::to_string(level - 1);
        choices += "float h" + std::to_string(level) + "(" + names + ") { return " +
                   (level == 0 ? "1.0" : callee + "(" + same + ") + " + callee + "(" + changed + ")") + "; }\n";
    }
    for (int i = 0; i < 20; ++i) values += i > 0 ? ", 1.0" : "1.0";
    choices += "texture t() { return 1mm * h20(" + values + "); }";

    // blocks inside blocks, and in the innermost a call of a function made likewise
    std::string deep = "float d0(float x) { return x + 1.0; }\n";
    for (int i = 1; i < 120; ++i)
        deep += "float d" + std::to_string(i) + "(float x) { " + std::string(200, '{') + "if (x > 0) { return d" +
                std::to_string(i - 1) + "(x); }" + std::string(200, '}') + " return x; }\n";
    deep += "texture t() { return d119(p.x); }";

    std::string messages;
    CHECK(seconds_to_compile(deep, messages) < 20);
    CHECK(messages.find("nest") != std::string::npos);
    CHECK(seconds_to_compile(choices, messages) < 20);
    CHECK(messages.find("this program is too large for all its dimensions to be checked\n") != std::string::npos);
    CHECK(seconds_to_compile(dimensions, messages) < 20);
    CHECK(messages.find("dimension-limit") == std::string::npos);
    CHECK(seconds_to_compile(loops, messages) < 20);
    CHECK(seconds_to_compile(chain, messages) < 20);
    CHECK(messages == "1:22 cannot add a plain number to a length\n");
    CHECK(seconds_to_compile(calls, messages) < 20);
}

TEST_CASE("a texture that only a function calls which nobody calls is not looked into")
{
    for (const char* text :
         {"float along(float x) { return t(p = vec3(x)); }\ntexture t() { return 1mm * sin(p.x / 1mm); }",
          "float g(float x) { return along(x); }\nfloat along(float x) { return t(w = x); }\n"
          "texture t(float w = 1mm) { return w * sin(p.x / w); }"}) {
        const CompileResult result = compile({"main.haptel", text}, {});
        INFO(said(result));
        CHECK(result.program);
    }
}
