#include "lang/text/lexer.h"
#include "tests/support/catch.h"

using namespace haptel::lang;

namespace {

struct Lexed {
    SourceSet sources;
    Diagnostics diagnostics;
    TokenList list;

    // The tokens' own text, separated by one space; an invalid one in angle brackets.
    std::string text() const
    {
        std::string out;
        for (const PlacedToken& token : list.tokens) {
            if (token.kind == Token::end) continue;
            const std::string part(sources.text({0, token.begin, token.end}));
            out += (out.empty() ? "" : " ") + (token.kind == Token::invalid ? "<" + printable(part) + ">" : part);
        }
        return out;
    }
    std::string first_message() const { return diagnostics.all().empty() ? "" : diagnostics.all()[0].message; }
};

Lexed lexed(std::string text)
{
    Lexed result;
    result.sources.add({"t.haptel", std::move(text)});
    result.list = lex(result.sources, 0, result.diagnostics);
    return result;
}

std::string tokens(std::string text)
{
    return lexed(std::move(text)).text();
}

} // namespace

TEST_CASE("every symbol and keyword is its own token, however close they stand")
{
#define SYMBOL(token, spelling)                                                                                        \
    CHECK(lexed("a" spelling "b").list.tokens.at(1).kind == Token::token);                                             \
    CHECK(tokens("a" spelling "b") == "a " spelling " b");
#define KEYWORD(token, spelling)                                                                                       \
    CHECK(lexed(spelling).list.tokens.at(0).kind == Token::token);                                                     \
    CHECK(lexed(spelling "x").list.tokens.at(0).kind == Token::name);
#include "lang/text/token.def"
#undef SYMBOL
#undef KEYWORD
}

TEST_CASE("the longest symbol wins")
{
    CHECK(tokens("a<<=b") == "a <<= b");
    CHECK(tokens("a<=b") == "a <= b");
    CHECK(tokens("i+++j") == "i ++ + j");
    CHECK(tokens("a&&&b") == "a && & b");
}

TEST_CASE("units belong to their number")
{
    CHECK(tokens("0.8mm 90deg 1u 1.0f 1e-3 2.5e+3mm 0xFFu .5 5.") == "0.8mm 90deg 1u 1.0f 1e-3 2.5e+3mm 0xFFu .5 5.");
    CHECK(tokens("0.8 mm") == "0.8 mm");
    CHECK(tokens("q.x") == "q . x");
    CHECK(tokens("1-2") == "1 - 2");
    CHECK(tokens("0x1-2") == "0x1 - 2");
    CHECK(tokens("1em") == "1em"); // an unknown unit, not half an exponent
}

TEST_CASE("a range needs no spaces where it is clear")
{
    CHECK(tokens("0..1") == "0 .. 1");
    CHECK(tokens("0.5..1.5") == "0.5 .. 1.5");
    CHECK(tokens("0.2mm..5mm") == "0.2mm .. 5mm");
    CHECK(tokens("0. .. .5") == "0. .. .5");
    CHECK(tokens("a..b") == "a .. b");
}

TEST_CASE("comments are no tokens; three slashes document the token behind")
{
    const Lexed l = lexed("a // x\n/* b\n** / c */ d /// tail\n//// ruler\n/// one\n///two\ne");
    CHECK(l.text() == "a d e");
    REQUIRE(l.list.docs.size() == 3);
    CHECK(l.sources.text(l.list.docs[1].span) == "/// one");
    CHECK(l.list.docs[0].before_token == 2);
    CHECK(l.list.docs[2].before_token == 2);
}

TEST_CASE("a comment that never ends is reported where it begins")
{
    const Lexed l = lexed("a\n  /* b\nc");
    REQUIRE(l.diagnostics.all().size() == 1);
    const Diagnostic& d = l.diagnostics.all()[0];
    CHECK(d.code == "open-comment");
    CHECK(l.sources.position(0, d.span.begin).line == 2);
    CHECK(l.sources.position(0, d.span.begin).column == 3);
    CHECK(l.list.tokens[1].kind == Token::invalid);
    CHECK(l.list.tokens[2].kind == Token::end);
}

TEST_CASE("strings end on their line")
{
    CHECK(tokens("import \"wood/oak.haptel\";") == "import \"wood/oak.haptel\" ;");
    CHECK(lexed("import \"wood;\nx").first_message() ==
          "this string is not closed: expected '\"' before the end of the line");
    CHECK(lexed("\"").diagnostics.all().size() == 1);
}

TEST_CASE("lines that begin with # are read up to the end of the line")
{
    const Lexed l = lexed("#define A \\\n 1\n#version 300\nb");
    CHECK(l.text() == "#define A 1  b");
    CHECK(l.list.tokens[3].kind == Token::line_end);
    REQUIRE(l.diagnostics.all().size() == 1);
    CHECK(l.diagnostics.all()[0].code == "directive");
    CHECK(l.list.has_directives);
    CHECK(lexed("# define A").text().empty());
    CHECK(lexed("#define A // nothing\nb").text() == "b");
    CHECK(lexed("#if 0\n#if 1\n#else\na\n#endif\n#else\nb\n#endif\nc").text() == "b c");
    CHECK(lexed("#if 1\na\n#elif 1\nb\n#else\nc\n#endif\nd").text() == "a d");
    CHECK(lexed("#ifdef A\na").first_message() ==
          "this choice is never ended: expected '#endif' before the end of the file");
    CHECK(lexed("#endif").first_message() == "'#endif' belongs to no '#if' above");
}

TEST_CASE("characters that look like others say which was meant")
{
    const Lexed l = lexed("a \xE2\x88\x92 b"); // the minus sign of typesetting
    REQUIRE(l.diagnostics.all().size() == 1);
    CHECK(l.diagnostics.all()[0].hint == "write -");
    REQUIRE(l.diagnostics.all()[0].fix);
    CHECK(l.diagnostics.all()[0].fix->replacement == "-");
    CHECK(lexed("\xC2\xA0").first_message() == "unexpected no-break space");
}

TEST_CASE("one report for a run of bytes that are no text, and none after a zero byte")
{
    CHECK(lexed("\xFF\xFE\xFD\x80 a").diagnostics.all().size() == 1); // UTF-16 by its mark
    CHECK(lexed("a \xFF\x80\x81\x82 b").diagnostics.all().size() == 1);
    const Lexed zero = lexed(std::string("a\0b $ c", 7));
    CHECK(zero.diagnostics.all().size() == 1);
    CHECK(zero.first_message() == "this file is not text, expected UTF-8");
    CHECK(zero.diagnostics.all()[0].span.begin == 1);
    CHECK(zero.list.tokens.size() == 2); // nothing else is said of such a file
}

TEST_CASE("a file that is no text is one mistake, a few odd bytes are not")
{
    std::string garbage = "float a; ";
    for (int i = 0; i < 400; ++i) garbage += std::string(1, static_cast<char>(1 + i % 8)) + "a\xFE$\n";
    const Lexed binary = lexed(garbage);
    CHECK(binary.diagnostics.all().size() == 1);
    CHECK(binary.diagnostics.all()[0].code == "not-text");
    CHECK(binary.diagnostics.all()[0].span.begin == 9);
    std::string text(2000, ' ');
    for (size_t i = 0; i < 20; ++i) text[100 * i] = '\x01';
    CHECK(lexed(text).diagnostics.all().size() == 20); // one in a hundred
    CHECK(lexed(text).diagnostics.all()[0].code == "unexpected-character");
    CHECK(lexed("// \xC3\xA9t\xC3\xA9 \xE6\x89\x8B").diagnostics.all().empty());
}

TEST_CASE("reading stops when enough is said")
{
    const Lexed l = lexed([] {
        std::string text;
        for (int i = 0; i < 1000; ++i) text += "$ a\n";
        return text;
    }());
    CHECK(l.diagnostics.all().size() == 50);
    CHECK(l.list.tokens.size() < 110);
    CHECK(l.list.tokens.back().kind == Token::end);
}
