// What the checker says, word for word and to the column.
#include "lang/compile.h"
#include "tests/conformance/case.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

using namespace haptel::lang::test;

TEST_CASE("check: golden files")
{
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(haptel::test::project_path("tests/lang/golden"))) {
        std::ifstream file(entry.path(), std::ios::binary);
        std::stringstream text;
        text << file.rdbuf();
        INFO(entry.path().filename().string());
        CHECK(golden_differences(text.str()) == "");
        ++files;
    }
    CHECK(files >= 10);
}

TEST_CASE("golden: a wrong, a missing and an unexpected finding are all noticed")
{
    const std::string right = "float f(bool b) { return b; } //! 26 error: expected float from 'f', found bool "
                              "[type-mismatch] = write float(b)\n";
    CHECK(golden_differences(right) == "");

    std::string wrong_column = right, wrong_hint = right;
    wrong_column.replace(wrong_column.find("26"), 2, "27");
    wrong_hint.replace(wrong_hint.find("write float(b)"), 14, "write float(c)");
    const std::string both =
        "unexpected: 1:26-27 error: expected float from 'f', found bool [type-mismatch] = write float(b)\n";
    CHECK(golden_differences(wrong_column) == both + "missing: 1:27 error: expected float from 'f', found bool "
                                                     "[type-mismatch] = write float(b)\n");
    CHECK(golden_differences(wrong_hint) == both + "missing: 1:26 error: expected float from 'f', found bool "
                                                   "[type-mismatch] = write float(c)\n");
    CHECK(golden_differences("float f(bool b) { return b; }\n") == both);
    CHECK(golden_differences("texture t() { return 0.0; } //! 1 error: nothing [none]\n") ==
          "missing: 1:1 error: nothing [none] = \n");
}

namespace {

// The text with every fix applied once, as haptel check --fix does.
std::string mended(const std::string& text)
{
    using namespace haptel::lang;
    const CompileResult result = compile({"dialect", text}, {});
    std::vector<FixIt> fixes;
    for (const Diagnostic& said : result.diagnostics.all())
        if (said.fix) fixes.push_back(*said.fix);
    std::ranges::sort(fixes, {}, [](const FixIt& fix) { return fix.span.begin; });
    std::string made;
    uint32_t done = 0;
    for (const FixIt& fix : fixes) {
        if (fix.span.begin < done) continue; // inside of one that is applied
        made += text.substr(done, fix.span.begin - done) + fix.replacement;
        done = fix.span.end;
    }
    made += text.substr(done);
    return made;
}

} // namespace

TEST_CASE("check: fixes turn other dialects into Haptel")
{
    const std::string dialects = R"(#version 450
static const half A = 2.0;
highp float3 f(mat3x3 m, vec3<f32> q) { return m * (q + 1.0) * saturate(q.x) / rcp(1.0 + q.y); }
float g(float x, bool b) { if (x > 0.0 and not b) retrun frac(x); return lerp(sinf(x), atan2(x, A), (float)2); }
texture h(float depth = 1mm) { if (P.x < 0.0) return 0.0; return depth * g(1.0, false) * f(mat3x3(1.0), n).x; }
)";
    const std::string haptel = R"(
const float A = 2.0;
vec3 f(mat3 m, vec3 q) { return m * (q + 1.0) * clamp(q.x, 0.0, 1.0) / (1.0 / (1.0 + q.y)); }
float g(float x, bool b) { if (x > 0.0 && ! b) return fract(x); return mix(sin(x), atan(x, A), float(2)); }
texture h(float depth = 1mm) { if (p.x < 0.0) return 0.0; return depth * g(1.0, false) * f(mat3(1.0), n).x; }
)";
    // What names a function that the parser cannot see is mended in the second round.
    CHECK(mended(mended(dialects)) == haptel);
    const haptel::lang::CompileResult result = haptel::lang::compile({"haptel", haptel}, {});
    INFO(haptel::lang::render(result.diagnostics.all(), result.sources));
    CHECK(result.program);
}

TEST_CASE("check: what only may be meant is proposed and not written")
{
    for (const char* text : {
             "float f(float x, float i) { return modf(x, i); }",             // two results in C and GLSL
             "float f(float a, float b, float k) { return smin(a, b, k); }", // of three arguments
             "float f(float a) { return mxi(a, a); }",                       // mix takes three
             "float f(float x, float y) { return fmod(x, y); }",             // of another sign
             "float f(vec3 q) { return q.length(); }",                       // in GLSL their number
             "vec3 f(float3x3 m, vec3 q) { return m * q; }",                 // made row by row
             "vec3 f(mat3 m, vec3 q) { return mul(m, q); }",                 // of two vectors their dot product
             "float f(vec5 q) { return 0.0; }",                              // three types are as near
             "const float AB = 1.0, AC = 2.0; float f() { return AD; }",     // two constants are
             "int f(float x) { return x; }",                                 // nearest, below or above
             "vec3 f(vec3<i32> q) { return q; }",                            // of whole numbers
             "texture t() { return 1mm * sin(p.x); }",                       // of which wavelength
             "texture t() { return 1.0 + p.x; }",                            // in which unit
             "float shift = 1.0;",                                           // a variable, or a constant
             "texture t() { if (p.x > 0.0) discard; return 0.0; }",          // no height, or a height of 0
             "displacement t(float depth = 1mm) { return depth; }",          // of another result
             "texture t(image bark) { return tex2D(bark, uv) * 1mm; }",      // of four components
         }) {
        INFO(text);
        CHECK(mended(text) == text);
        CHECK(!haptel::lang::compile({"main.haptel", text}, {}).diagnostics.all().empty());
    }
    CHECK(mended("float f(float a) { return mxi(a, a, 0.5); }") == "float f(float a) { return mix(a, a, 0.5); }");
    CHECK(mended("float f(float depth) { return dpeth; }") == "float f(float depth) { return depth; }");
    CHECK(mended("float f(flaot x) { return x; }") == "float f(float x) { return x; }");
}
