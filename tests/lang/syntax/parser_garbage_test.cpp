// Whatever the bytes: an answer, soon, in bounded memory and stack.
#include "lang/text/lexer.h"
#include "tests/lang/syntax/tree_text.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <functional>
#include <random>

using namespace haptel::lang;

namespace {

std::string repeated(std::string_view text, size_t times)
{
    std::string result;
    result.reserve(text.size() * times);
    for (size_t i = 0; i < times; ++i) result += text;
    return result;
}

std::string only_code(const Parsed& parsed)
{
    return parsed.diagnostics.all().size() == 1 ? parsed.diagnostics.all()[0].code : parsed.messages().substr(0, 500);
}

// What must hold for any text: the answer is bounded, lies within the text, and can be shown.
void check_sane(std::string_view text)
{
    const Parsed parsed = parse_text(text);
    REQUIRE(parsed.diagnostics.all().size() <= 250);
    for (const Diagnostic& d : parsed.diagnostics.all()) {
        REQUIRE(d.span.begin <= d.span.end);
        REQUIRE(d.span.end <= text.size());
        REQUIRE_FALSE(d.code.empty());
        REQUIRE_FALSE(d.message.empty());
    }
    REQUIRE(render(parsed.diagnostics.all(), parsed.sources).size() < 250 * 5000);
    tree_text(parsed.file);
}

const char* const valid = R"(import "wood/oak.haptel";
const float A[3] = {1.0, 2.0, 3.0};
/// @facts value -1 .. 1, slope 2, class C1
float f(float basis(vec3), vec3 q, int n) {
    float s = 0.0, a = 1.0;
    for (int i = 0; i < n; i++) { s += a * basis(q); if (s > 2.0) break; else if (s < -2.0) s = 0.0; else a *= 0.5; }
    return s > 0.0 ? s : -s * A[n % 3] + grad(g)(q).x;
}
/// A texture.
texture t(float pitch = 0.8mm in 0.2mm .. 5mm, int octaves = 4 in 1 .. 8, out float stiffness_scale) {
    vec3 q = vec3(p.x, 0.08 * p.yz) / pitch;
    if (q.x < 0.0 || !(q.y >= 1e-3)) { q.xy = q.yx; ++octaves; }
    return 60um * f(noise, q, octaves); // done
}
)";

} // namespace

TEST_CASE("nesting above 256 is one error, found at once; 256 is none")
{
    const auto nested = [](std::string_view open, std::string_view inner, std::string_view close, size_t times) {
        return parse_text("float f() { return " + repeated(open, times) + std::string(inner) + repeated(close, times) +
                          "; }");
    };
    CHECK(nested("(", "1", ")", 256).messages() == "");
    CHECK(only_code(nested("(", "1", ")", 257)) == "too-deep");
    CHECK(only_code(nested("(", "1", ")", 20'000)) == "too-deep");
    CHECK(only_code(nested("f(", "1", ")", 20'000)) == "too-deep");
    CHECK(only_code(nested("a[", "1", "]", 20'000)) == "too-deep");
    CHECK(nested("float[", "1", "](1)", 256).messages() == "");
    CHECK(only_code(nested("float[", "1", "](1)", 20'000)) == "too-deep");
    CHECK(only_code(parse_text(repeated("float[", 20'000) + "1" + repeated("]", 20'000) + " f() { return 1; }")) ==
          "too-deep");
    CHECK(only_code(nested("- ", "1", "", 20'000)) == "too-deep");
    CHECK(only_code(nested("a ? b : ", "1", "", 20'000)) == "too-deep");
    CHECK(only_code(nested("a ? ", "1", " : b", 20'000)) == "too-deep");
    CHECK(only_code(nested("", "a", ".x", 20'000)) == "too-deep");
    CHECK(only_code(nested("1 + (2 * (", "1", "))", 20'000)) == "too-deep");
    CHECK(nested("grad(", "f", ")", 20'000).messages().find("grad") != std::string::npos);
    const auto statements = [](const std::string& body) { return parse_text("float f() {" + body + "}"); };
    CHECK(statements(repeated("{", 255) + repeated("}", 255)).messages() == "");
    CHECK(only_code(statements(repeated("{", 20'000) + repeated("}", 20'000))) == "too-deep");
    CHECK(only_code(statements(repeated("if (a) ", 20'000) + "b = 1;")) == "too-deep");
    CHECK(only_code(statements(repeated("for (;;) ", 20'000) + "b = 1;")) == "too-deep");
    CHECK(only_code(statements(repeated("if (a) { b = 1; } else { ", 20'000) + repeated("}", 20'000))) == "too-deep");
}

TEST_CASE("what stands behind what nests too deep is not read, and may have declared any name")
{
    const Parsed parsed = parse_text("float f() { return " + repeated("(", 300) + "1" + repeated(")", 300) +
                                     "; }\nfloat later() { return 1 1; }\nconst float A = 1.0;");
    CHECK(only_code(parsed) == "too-deep");
    CHECK(parsed.file.functions.at(0).damage.any);
    CHECK(parsed.file.lacks_functions);
    CHECK(parsed.file.unread.contains("A"));
}

TEST_CASE("long is not deep")
{
    const Parsed chain = parse_text("float f() { return a" + repeated(" + b - c", 25'000) + "; }");
    CHECK(chain.messages() == "");
    const auto& scope = std::get<ast::Scope>(chain.file.functions.at(0).body->node);
    const auto& returned = std::get<ast::Return>(scope.statements.at(0)->node);
    CHECK(std::get<ast::Chain>(returned.value->node).rest.size() == 50'000);
    CHECK(parse_text("float f() { return 1" + repeated(" + a * b < c", 20'000) + "; }").messages() == "");
    CHECK(parse_text("float f() { if (a) b = 1;" + repeated(" else if (a) b = 1;", 20'000) + "}").messages() == "");
    CHECK(parse_text("const float A[] = {" + repeated("1.0, ", 50'000) + "};").messages() == "");
    CHECK(parse_text("float f() {" + repeated("a = b;", 50'000) + "}").messages() == "");
}

TEST_CASE("megabytes of nonsense are read in one go")
{
    constexpr size_t megabyte = 1 << 20;
    for (const char* piece :
         {"(",   ")",       "{",       "}",      "[",      "+",        ";",          "\"",       "#\n",
          "/*",  "a ",      "a a (\n", "a a ( ", "const ", "texture ", "texture t(", "import ",  "1",
          "1..", "/// a\n", "if (",    "for (",  "a ? ",   "a.x",      "\xFF",       "\xC3\xA9", ","}) {
        CAPTURE(piece);
        check_sane(repeated(piece, megabyte / std::string_view(piece).size()));
        check_sane("float f() { " + repeated(piece, megabyte / 8 / std::string_view(piece).size()));
    }
    check_sane(std::string(megabyte, '\0'));
    check_sane("float f(" + repeated("; struct ", megabyte / 8)); // on one line, which is not searched for each
}

TEST_CASE("slips in a file with more mistakes than are said")
{
    const std::string unreadable = repeated("$\n", 60); // the lexer says all that is ever said
    for (const char* slip :
         {"texture t(float a = 1 if 0 .. 2) {}\n", "float float f(float x) {}\n", "f float(float x) {}\n",
          "texture t({ ) return 1; }\n", "float f((float x) {}\n", "float f(x float, y) {}\n",
          "float f(float x float y) {}\n", "t(float a = 1) {}\n", "float f() { q vec3 = p; }\n",
          "const float A[2] = {1 2};\n", "float f() { for (i) ++ { a = {1, 2; } }\n"}) {
        CAPTURE(slip);
        check_sane(slip + unreadable);
        check_sane(unreadable + slip);
    }
}

TEST_CASE("random bytes")
{
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        std::string text(random() % 300, ' ');
        for (char& c : text) c = static_cast<char>(random() % 256);
        check_sane(text);
        for (char& c : text) c = static_cast<char>(32 + random() % 96);
        check_sane(text);
    }
}

TEST_CASE("random words of the language")
{
    const char* const words[] = {
#define SYMBOL(token, spelling) spelling,
#define KEYWORD(token, spelling) spelling,
#include "lang/text/token.def"
#undef SYMBOL
#undef KEYWORD
        "float",  "int", "vec3",  "a",   "grad",  "while",     "struct",
        "float3", "1",   "2.5mm", "0x1", "\"s\"", "/// doc\n", "/// @facts value 1\n",
        "\n",     "$"};
    std::mt19937 random(2);
    for (int round = 0; round < 4000; ++round) {
        std::string text = round % 2 == 0 ? "float f() { " : "";
        for (uint_fast32_t i = 0, count = random() % 80; i < count; ++i)
            text += std::string(words[random() % std::size(words)]) + " ";
        check_sane(text);
    }
}

TEST_CASE("valid programs with a few changes")
{
    REQUIRE(parse_text(valid).messages() == "");
    std::mt19937 random(3);
    for (int round = 0; round < 4000; ++round) {
        std::string text = valid;
        for (uint_fast32_t i = 0, count = 1 + random() % 4; i < count; ++i) {
            if (text.empty()) break;
            const size_t at = random() % text.size(), length = random() % 20;
            switch (random() % 4) {
            case 0: text.erase(at, length); break;
            case 1: text.insert(at, text.substr(random() % text.size(), length)); break;
            case 2: text[at] = static_cast<char>(random() % 256); break;
            case 3: text.resize(at + 1); break;
            }
        }
        check_sane(text);
    }
}

TEST_CASE("one change to a valid program makes few messages")
{
    // Every token left out in turn: a mistake that cascades shows here.
    size_t most = 0, sum = 0, programs = 0;
    const Parsed whole = parse_text(valid);
    SourceSet sources = whole.sources;
    Diagnostics none;
    const TokenList list = lex(sources, 0, none);
    for (const PlacedToken& token : list.tokens) {
        std::string text = valid;
        text.replace(token.begin, token.end - token.begin, token.end - token.begin, ' ');
        const size_t found = parse_text(text).diagnostics.all().size();
        most = std::max(most, found);
        sum += found;
        ++programs;
    }
    CHECK(most <= 2);
    CHECK(static_cast<double>(sum) / static_cast<double>(programs) < 1.1);
}
