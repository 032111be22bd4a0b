// The table of diagnostics: its examples are what they say, and it is the only list there is.
#include "lang/analyse.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <set>

using namespace haptel::lang;

namespace {

// Findings of analyse(), which the examples of others may have as well.
bool is_of_bounds(std::string_view code)
{
    return code == "jump" || code == "kink" || code == "division" || code == "domain" || code == "scale" ||
           code == "false-facts";
}

// A compilation in which imports find the text itself, and nothing else; if wanted with what its bounds show.
CompileResult compiled(std::string_view text, bool with_bounds = false)
{
    CompileOptions options;
    options.load_import = [&](std::string_view path, std::string_view) -> std::optional<SourceFile> {
        if (path != "main.haptel") return std::nullopt;
        return SourceFile{std::string(path), std::string(text)};
    };
    CompileResult result = compile({"main.haptel", std::string(text)}, options);
    if (!result.program || !with_bounds) return result;
    for (const haptel::ir::Texture& texture : result.program->module.textures) {
        std::vector<double> values;
        for (const haptel::ir::Parameter& parameter : texture.parameters) values.push_back(parameter.value);
        analyse(*result.program, texture, values, {}, {}, result.diagnostics);
    }
    return result;
}

std::set<std::string> said(const CompileResult& result)
{
    std::set<std::string> all;
    for (const Diagnostic& diagnostic : result.diagnostics.all())
        all.insert(std::string(name_of(diagnostic.severity)) + " " + diagnostic.code);
    return all;
}

} // namespace

TEST_CASE("diagnostics: every wrong example has its finding, every right one has none")
{
    for (const DiagnosticInfo& info : all_diagnostics) {
        if (info.wrong.empty()) continue;
        CAPTURE(info.code, info.wrong, info.right);
        const std::string finding = std::string(name_of(info.severity)) + " " + std::string(info.code);
        CHECK(said(compiled(info.wrong, is_of_bounds(info.code))) == std::set<std::string>{finding});
        CHECK(said(compiled(info.right, is_of_bounds(info.code))) == std::set<std::string>{});
    }
}

TEST_CASE("diagnostics: the table is complete and tidy")
{
    // What no small text shows: tests of their own have these.
    const std::set<std::string_view> without_example = {
        "bad-value", "coarse-picture", "dimension-limit",   "internal-error",  "no-code",         "not-close-enough",
        "seam",      "too-large",      "unknown-parameter", "unknown-texture", "unreadable-file", "unwritable-file"};
    std::set<std::string_view> codes, shown_nowhere;
    for (const DiagnosticInfo& info : all_diagnostics) {
        CAPTURE(info.code);
        CHECK(codes.insert(info.code).second);
        CHECK(info.code.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string_view::npos);
        CHECK(!info.meaning.empty());
        CHECK(info.meaning.find('\n') == std::string_view::npos);
        CHECK(!info.explanation.empty());
        CHECK(info.wrong.empty() == info.right.empty());
        if (info.wrong.empty()) shown_nowhere.insert(info.code);
        CHECK(find_diagnostic(info.code) == &info);
    }
    CHECK(shown_nowhere == without_example);
    CHECK(!find_diagnostic("no-such-code"));
}

// What the constructors of ErrorCode and its like ask while they compile.
static_assert(is_listed("unknown-name", Severity::error));
static_assert(!is_listed("unknown-nmae", Severity::error));
static_assert(!is_listed("unknown-name", Severity::warning));
static_assert(!is_listed("", Severity::error));

TEST_CASE("diagnostics: ten mistakes of ten kinds are ten findings, each at its place and once")
{
    const std::string text = "float f(flaot x) { return x; }\n"
                             "float g(float x) { if (x > 0) return x; }\n"
                             "texture t(float depth = 3mm in 0mm .. 2mm, int n = 3)\n"
                             "{\n"
                             "    float a = dpeth * 2.0;\n"
                             "    vec2 b = p;\n"
                             "    for (int i = 0; i < n; ++i) a += 1mm;\n"
                             "    int c = 1.5;\n"
                             "    p.x = a + c;\n"
                             "    float e = lenght(b) + b.z;\n"
                             "    return a + b.x + e + f(1.0) + depth;\n"
                             "}\n";
    const CompileResult result = compiled(text);
    std::vector<std::string> found;
    for (const Diagnostic& diagnostic : result.diagnostics.all()) {
        const Position at = result.sources.position(0, diagnostic.span.begin);
        found.push_back(std::to_string(at.line) + ":" + std::to_string(at.column) + " " + diagnostic.code);
    }
    const std::vector<std::string> expected = {"1:9 unknown-type",   "2:7 missing-return", "3:25 default-out-of-range",
                                               "5:15 unknown-name",  "6:14 type-mismatch", "7:25 unbounded-loop",
                                               "8:13 type-mismatch", "9:5 read-only",      "10:15 unknown-function",
                                               "10:29 bad-swizzle"};
    CHECK(found == expected);
}

TEST_CASE("diagnostics: a mistake of grammar hides nothing in the functions beside it")
{
    const CompileResult result = compiled("float f(float x) { return x * ; }\n"
                                          "float g(float x) { return x + y; }\n"
                                          "float h(float x { return x; }\n"
                                          "texture t() { return f(p.x) + g(p.x) + k(p.x); }\n");
    std::vector<std::string> found;
    for (const Diagnostic& diagnostic : result.diagnostics.all())
        found.push_back(std::to_string(result.sources.position(0, diagnostic.span.begin).line) + " " + diagnostic.code);
    CHECK(found ==
          std::vector<std::string>{"1 expected-expression", "2 unknown-name", "3 syntax", "4 unknown-function"});
}

TEST_CASE("diagnostics: what follows from a mistake is not said")
{
    const std::string rest = " return h + k + h; }";
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"texture t() { float = 1mm; float k = 1mm;" + rest, "1:21 syntax"},
        {"texture t() { flaot h = 1mm; float k = 1mm;" + rest, "1:15 unknown-type"},
        {"texture t() { float h max(p.x, p.y); float k = 1mm;" + rest, "1:23 syntax"},
        {"texture t() { float h = 1mm; float k = max(p.x, p.y;" + rest, "1:52 syntax"},
        {"texture t(float h 1mm, float k = 1mm) {" + rest, "1:17 missing-default"},
        {"texture t(float = 1mm, float h = 1mm, float k = 1mm) {" + rest, "1:17 syntax"},
        {"texture t() { float h = 1mm; float k = nothing + nothing;" + rest, "1:40 unknown-name"},
        {"texture t() { float h = 0.0; float k = 0.0; for (int = 0; i < 3; ++i) h += i * 1mm;" + rest, "1:54 syntax"},
        {"texture t(float h = 1mm) { float k = 1mm; if (h > k) return k; } else k = h;" + rest, "1:66 syntax"},
        {"float f(float h { return h; }\ntexture t() { return f(p.x); }", "1:17 syntax"},
        {"const mat2 M = mat2(1.0, 0.5 0.8, 0.6);\nconst mat3 L[2] = {mat3(1.0), mat3(M)};\n"
         "texture t() { return L[0][0][0] * 1mm; }",
         "1:30 syntax"},
        {"const afloat A[1] = {1.0};\nconst int I[2] = {5, A[0] > 0.0 ? 6 : 7};\ntexture t(float h = A[0] > 0.0 ? "
         "1mm : 2mm) { return h * I[0]; }",
         "1:7 unknown-type"},
        {"const afloat A = 1.0;\nconst float B = A > 0.0 ? 1.0 : 2.0;\ntexture t() { return 1mm * B; }",
         "1:7 unknown-type"},
        {"const float A[] = float[3](1.0, 2.0);\ntexture t() { return A[0] * 1mm; }", "1:25 table-size"},
        {"const float A[2] = {{1.0, 2.0}, {3.0, 4.0}};\ntexture t() { return A[0] * 1mm; }", "1:21 nested-table"},
    };
    for (const auto& [text, expected] : cases) {
        CAPTURE(text);
        const CompileResult result = compiled(text);
        std::string found;
        for (const Diagnostic& diagnostic : result.diagnostics.all()) {
            const Position at = result.sources.position(0, diagnostic.span.begin);
            found += (found.empty() ? "" : ", ") + std::to_string(at.line) + ":" + std::to_string(at.column) + " " +
                     diagnostic.code;
        }
        CHECK(found == expected);
    }
}

TEST_CASE("diagnostics: errors stop at the limit, which can be set")
{
    Diagnostics diagnostics;
    diagnostics.error_limit = 3;
    for (uint32_t i = 0; i < 10; ++i) diagnostics.error({0, i, i + 1}, "syntax", "x");
    CHECK(diagnostics.all().size() == 3);
    CHECK(diagnostics.full());
    CHECK(diagnostics.reports() == 10);
}
