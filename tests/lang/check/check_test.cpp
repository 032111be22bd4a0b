// What the checker says, word for word and to the column.
#include "lang/compile.h"
#include "tests/conformance/case.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

using namespace haptel::lang::test;

TEST_CASE("check: golden files")
{
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(HAPTEL_SOURCE_DIR "/tests/lang/golden")) {
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
highp float3 f(float3x3 m, vec3<f32> q) { return mul(m, q + 1.0) * saturate(q.x) / rcp(1.0 + q.y); }
float g(float x) { if (x > 0.0 and not (x > 1.0)) retrun frac(x); return lerp(sinf(x), fmod(x, A), atan2(x, (float)2)); }
displacement h(float depth = 1mm) { if (P.x < 0.0) discard; return depth * (g(1.0) + f(float3x3(1.0), n).length()); }
)";
    const std::string haptel = R"(
const float A = 2.0;
vec3 f(mat3 m, vec3 q) { return (m * (q + 1.0)) * clamp(q.x, 0.0, 1.0) / (1.0 / (1.0 + q.y)); }
float g(float x) { if (x > 0.0 && ! (x > 1.0)) return fract(x); return mix(sin(x), mod(x, A), atan(x, float(2))); }
texture h(float depth = 1mm) { if (p.x < 0.0) return 0.0; return depth * (g(1.0) + length(f(mat3(1.0), n))); }
)";
    // What names a function that the parser cannot see is mended in the second round.
    CHECK(mended(mended(dialects)) == haptel);
    const haptel::lang::CompileResult result = haptel::lang::compile({"haptel", haptel}, {});
    INFO(haptel::lang::render(result.diagnostics.all(), result.sources));
    CHECK(result.program);
}
