#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"
#include "tests/lang/text/one_source.h"
#include "tests/support/catch.h"

using namespace haptel::lang;

namespace {

std::string rendered(std::string text, uint32_t begin, uint32_t end)
{
    Diagnostic diagnostic;
    diagnostic.code = "code";
    diagnostic.span = {0, begin, end};
    diagnostic.message = "message";
    return render({diagnostic}, one_source(std::move(text)));
}

} // namespace

TEST_CASE("a finding shows its line, the whole span underlined, further places and a hint")
{
    const SourceSet sources = one_source("texture t(\n    float a = 1,\n    return depth * sin(p.x);\n");
    Diagnostics diagnostics;
    Diagnostic& d = diagnostics.warning({0, 47, 55}, "dimension", "sin() expects a plain number, got a length");
    d.hint = "divide by a wavelength";
    d.related.push_back({{0, 9, 10}, "it was opened here"});
    CHECK(render(diagnostics.all(), sources) ==
          "t.haptel:3:20: warning: sin() expects a plain number, got a length [dimension]\n"
          "   3 |     return depth * sin(p.x);\n"
          "     |                    ^~~~~~~~\n"
          "t.haptel:1:10: note: it was opened here\n"
          "   1 | texture t(\n"
          "     |          ^\n"
          "     = hint: divide by a wavelength\n");
}

TEST_CASE("an empty span, also at the end of a line, is one caret")
{
    CHECK(rendered("ab\ncd", 2, 2) == "t.haptel:1:3: error: message [code]\n   1 | ab\n     |   ^\n");
    CHECK(rendered("ab\ncd", 5, 5) == "t.haptel:2:3: error: message [code]\n   2 | cd\n     |   ^\n");
    CHECK(rendered("", 0, 0) == "t.haptel:1:1: error: message [code]\n"); // there is no line
    CHECK(rendered("ab", 900, 900) == "t.haptel:1:3: error: message [code]\n   1 | ab\n     |   ^\n");
}

TEST_CASE("a span of several lines is underlined to the end of its first")
{
    CHECK(rendered("a (b\nc) d", 2, 7) == "t.haptel:1:3: error: message [code]\n   1 | a (b\n     |   ^~\n");
}

TEST_CASE("the underline stands below tabs, wide and combined characters")
{
    CHECK(rendered("\tab", 1, 3) == "t.haptel:1:2: error: message [code]\n   1 |     ab\n     |     ^~\n");
    CHECK(rendered("\xE6\x9C\xA8x", 3, 4) == "t.haptel:1:2: error: message [code]\n   1 | \xE6\x9C\xA8x\n     |   ^\n");
    CHECK(rendered("e\xCC\x81x", 3, 4) == "t.haptel:1:3: error: message [code]\n   1 | e\xCC\x81x\n     |  ^\n");
}

TEST_CASE("what is shown is always text")
{
    CHECK(rendered("a\xFF\033b", 0, 1) == "t.haptel:1:1: error: message [code]\n   1 | a\xEF\xBF\xBD\xEF\xBF\xBD"
                                          "b\n     | ^\n");
}

// All characters that Unicode 15 (UAX 9, section 2) lets embed, override or isolate a direction, and that a text could
// say other than it is compiled with (CVE-2021-42574).
TEST_CASE("no character that turns the direction of text is shown, wherever it stands")
{
    const char* const turns[] = {"\u202A", "\u202B", "\u202C", "\u202D", "\u202E",
                                 "\u2066", "\u2067", "\u2068", "\u2069"};
    for (const std::string turn : turns) {
        CAPTURE(turn);
        Diagnostic diagnostic;
        diagnostic.code = "code";
        diagnostic.span = {0, 0, 1};
        diagnostic.message = "message " + turn + "here";
        diagnostic.hint = "hint " + turn + "here";
        diagnostic.related.push_back({{0, 0, 1}, "note " + turn + "here"});
        SourceSet sources;
        sources.add({"t" + turn + ".haptel", "ab" + turn + "cd"});
        const std::string shown = render({diagnostic}, sources);
        CHECK(shown.find(turn) == std::string::npos);
        CHECK(shown.find("ab\uFFFDcd\n") != std::string::npos);
        CHECK(shown.find("message \uFFFDhere") != std::string::npos);
    }
    for (const std::string kept : {"\u2029\u202F", "\u2065\u206A"}) // beside them
        CHECK(rendered("a" + kept, 0, 1).find(kept) != std::string::npos);
}

TEST_CASE("a long line is cut around the finding")
{
    const std::string out =
        rendered(std::string(5'000'000, 'a') + "b" + std::string(5'000'000, 'c'), 5'000'000, 5'000'001);
    CHECK(out == "t.haptel:1:5000001: error: message [code]\n   1 | ..." + std::string(25, 'a') + "b" +
                     std::string(74, 'c') + "...\n     | " + std::string(28, ' ') + "^\n");
    CHECK(rendered(std::string(300, 'x'), 0, 300).size() < 300);
}

TEST_CASE("one error per place, a bounded number of them, the rest goes nowhere")
{
    Diagnostics diagnostics;
    diagnostics.error({0, 5, 6}, "syntax", "first");
    diagnostics.error({0, 5, 9}, "number", "second at the same place").hint = "lost";
    CHECK(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].hint.empty());
    diagnostics.warning({0, 5, 6}, "dimension", "warnings stand beside errors");
    diagnostics.warning({0, 5, 6}, "dimension", "but not twice");
    CHECK(diagnostics.all().size() == 2);
    for (uint32_t i = 0; i < 1000; ++i) diagnostics.error({0, 10 + i, 11 + i}, "facts", "more");
    CHECK(diagnostics.full());
    CHECK(diagnostics.all().size() == 51);
    for (uint32_t i = 0; i < 1000; ++i) diagnostics.note({0, i, i + 1}, "replaces-library", "more");
    CHECK(diagnostics.all().size() == 250);
    for (size_t i = 0; i < 250; ++i) CHECK(diagnostics.all()[i].related.size() == (i == 50 || i == 249)); // says so
}

TEST_CASE("findings are sorted by file and place")
{
    Diagnostics diagnostics;
    diagnostics.error({1, 0, 1}, "facts", "");
    diagnostics.warning({0, 9, 10}, "prototype", "");
    diagnostics.error({0, 2, 3}, "syntax", "");
    diagnostics.sort_by_place();
    CHECK(diagnostics.all()[0].code == "syntax");
    CHECK(diagnostics.all()[1].code == "prototype");
    CHECK(diagnostics.all()[2].code == "facts");
}

TEST_CASE("of a file without text only the place is shown")
{
    Diagnostic diagnostic;
    diagnostic.code = "unreadable-file";
    diagnostic.message = "cannot read this file";
    diagnostic.hint = "look";
    CHECK(render({diagnostic}, one_source("")) == "t.haptel:1:1: error: cannot read this file [unreadable-file]\n"
                                                  "     = hint: look\n");
}

TEST_CASE("colour wraps label and underline and changes no text")
{
    Diagnostic diagnostic;
    diagnostic.severity = Severity::warning;
    diagnostic.code = "code";
    diagnostic.span = {0, 0, 1};
    diagnostic.message = "message";
    std::string colored = render({diagnostic}, one_source("a"), true);
    CHECK(colored.find("\033[1;35mwarning: \033[0m") != std::string::npos);
    for (size_t at; (at = colored.find('\033')) != std::string::npos;)
        colored.erase(at, colored.find('m', at) - at + 1);
    CHECK(colored == render({diagnostic}, one_source("a"), false));
}

TEST_CASE("a near name stands alone where no other may be meant")
{
    const std::vector<std::string_view> names = {"asin", "asinh", "min", "mins", "uv", "octaves", "floor", "p"};
    const auto only = [&](std::string_view word) {
        const haptel::NearName near = haptel::near_name(word, names);
        return near.is_only ? std::string(near.name) : "";
    };
    CHECK(only("octave") == "octaves");
    CHECK(only("flor") == "floor");
    CHECK(only("mni") == "min");
    CHECK(only("asing") == ""); // asinh by one letter, asin by one too many
    CHECK(only("min3") == "");
    CHECK(only("u1") == ""); // half of its letters say nothing
    CHECK(only("v") == "");
    CHECK(only("P") == "p");
}

TEST_CASE("the nearest name, if it is near enough")
{
    const std::vector<std::string_view> names = {"octaves", "depth", "pitch", "fbm", "p"};
    CHECK(haptel::near_name("octave", names).name == "octaves");
    CHECK(haptel::near_name("Depth", names).name == "depth");
    CHECK(haptel::near_name("dpeth", names).name == "depth");
    CHECK(haptel::near_name("fmb", names).name == "fbm");
    CHECK(haptel::near_name("width", names).name == "");
    CHECK(haptel::near_name("x", names).name == "");
    CHECK(haptel::near_name("", names).name == "");
    CHECK(haptel::near_name(std::string(1000, 'a'), names).name == "");
    CHECK(haptel::near_name("pitch", {}).name == "");
    // A letter typed twice, or once where it stands twice, is likelier than another letter.
    const std::vector<std::string_view> functions = {"sign", "sinh", "sin", "cross", "floor"};
    CHECK(haptel::near_name("sinn", functions).name == "sin");
    CHECK(haptel::near_name("sinhh", functions).name == "sinh");
    CHECK(haptel::near_name("cros", functions).name == "cross");
    CHECK(haptel::near_name("sinj", functions).name == "sinh"); // no doubling: a slip keeps the length
}
