// The grammar in docs/language.md against the parser, both ways: sentences derived from it at random are accepted, and
// what the library and the examples are made of can be derived from it.
#include "lang/format/format.h"
#include "lang/syntax/parser.h"
#include "lang/text/lexer.h"
#include "tests/lang/syntax/ebnf.h"
#include "tests/support/catch.h"
#include "tests/support/haptel_files.h"
#include "tests/support/project_path.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

using namespace haptel::lang;
using namespace haptel::lang::test;

namespace {

std::string read(const std::filesystem::path& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

Ebnf grammar_of_the_page()
{
    const std::string page = read(haptel::test::project_path("docs/language.md"));
    const size_t begin = page.find("```ebnf\n");
    REQUIRE(begin != std::string::npos);
    return Ebnf(page.substr(begin + 8, page.find("```", begin + 8) - begin - 8));
}

// As the grammar sees it: the kind of names, numbers and strings, the spelling of everything else.
std::vector<std::string> terminals_of(const std::string& text, const Ebnf& grammar)
{
    SourceSet sources;
    const uint32_t file = sources.add({"t.haptel", text});
    Diagnostics diagnostics;
    std::vector<std::string> all;
    for (const PlacedToken& token : lex(sources, file, diagnostics).tokens) {
        const std::string word = text.substr(token.begin, token.end - token.begin);
        if (token.kind == Token::end) continue;
        if (token.kind == Token::number)
            all.push_back("number");
        else if (token.kind == Token::string)
            all.push_back("string");
        else
            all.push_back(token.kind == Token::name && !grammar.is_word(word) ? "name" : word);
    }
    return all;
}

std::string rendered(const Diagnostics& diagnostics, const SourceSet& sources)
{
    return render(diagnostics.all(), sources);
}

// No text that the parser accepts is too odd for the formatter.
void check_format(const std::string& text, const Ebnf& grammar)
{
    SourceSet sources;
    Diagnostics diagnostics;
    const std::optional<std::string> once = format(sources, sources.add({"derived", text}), diagnostics);
    REQUIRE(once);
    INFO(*once);
    REQUIRE(terminals_of(*once, grammar) == terminals_of(text, grammar));
    const std::optional<std::string> twice = format(sources, sources.add({"formatted", *once}), diagnostics);
    REQUIRE(twice);
    REQUIRE(*twice == *once);
}

} // namespace

TEST_CASE("grammar: what it derives, the parser accepts")
{
    const Ebnf grammar = grammar_of_the_page();
    REQUIRE(grammar.mistakes() == "");
    std::mt19937 random(2026);
    const std::string names[] = {"a", "q", "height", "octaves", "fbm", "x1"},
                      strings[] = {"\"a.haptel\"", "\"wood/oak.haptel\""},
                      numbers[] = {"1", "0x1fu", "2.5", ".5", "1e-3", "0.8mm", "90deg", "3u", "1.0f"};
    std::set<std::string> used;
    for (int round = 0; round < 5000; ++round) {
        std::string text;
        for (const std::string& terminal : grammar.derive("file", random, used)) {
            text += terminal == "name"     ? names[random() % std::size(names)]
                    : terminal == "number" ? numbers[random() % std::size(numbers)]
                    : terminal == "string" ? strings[random() % std::size(strings)]
                                           : terminal;
            text += random() % 12 == 0 ? "\n" : " ";
        }
        SourceSet sources;
        const uint32_t file = sources.add({"derived", text});
        Diagnostics diagnostics;
        parse(sources, file, diagnostics);
        INFO(text);
        if (diagnostics.has_errors()) FAIL(rendered(diagnostics, sources)); // empty bodies are warned of
        if (round % 5 == 0) check_format(text, grammar);
    }
    for (const std::string& rule : grammar.rules()) {
        CAPTURE(rule);
        CHECK(used.count(rule) == 1);
    }
}

TEST_CASE("grammar: the library and the examples can be derived")
{
    const Ebnf grammar = grammar_of_the_page();
    size_t files = 0;
    for (const std::filesystem::path& path :
         haptel::test::haptel_files({"stdlib", "stdlib/tests", "examples/textures"})) {
        CAPTURE(path);
        ++files;
        CHECK(grammar.derives("file", terminals_of(read(path), grammar)));
    }
    CHECK(files > 25);
}

TEST_CASE("grammar: what is no Haptel cannot be derived")
{
    const Ebnf grammar = grammar_of_the_page();
    CHECK(grammar.derives("file", terminals_of("texture t() { return 1mm; }", grammar)));
    for (const char* text :
         {"texture t() { return 1mm }", "texture t( { }", "float f() { a = (b = c); }", "float x = 1.0;",
          "float f() { while (x) y; }", "float f(float a = ) { }", "texture t(float a) { }"}) {
        CAPTURE(text);
        CHECK_FALSE(grammar.derives("file", terminals_of(text, grammar)));
    }
}
