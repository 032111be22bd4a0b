// Versions of the language: the line that says one, and what brings a text to a later one, by a table of our own, since
// nothing has been renamed yet.
#include "lang/compile.h"
#include "lang/syntax/language_version.h"
#include "lang/syntax/parser.h"
#include "tests/support/catch.h"

using namespace haptel::lang;

namespace {

constexpr Renamed renamed_later[] = {{2, "bumps", "hills"}, {3, "hills", "mounds"}, {3, "grooves", "furrows"}};

// The text as one of version `to`.
std::string brought_to(uint32_t to, std::string text, uint32_t from)
{
    SourceSet sources;
    Diagnostics diagnostics;
    const uint32_t file = sources.add({"t.haptel", text});
    const Span line = parse(sources, file, diagnostics).language;
    const std::vector<FixIt> fixes = upgrades(sources, file, line, from, to, renamed_later);
    for (size_t i = fixes.size(); i-- > 0;)
        text.replace(fixes[i].span.begin, fixes[i].span.end - fixes[i].span.begin, fixes[i].replacement);
    return text;
}

std::string first_error(const std::string& text)
{
    const CompileResult result = compile({"t.haptel", text}, {});
    for (const Diagnostic& said : result.diagnostics.all())
        if (said.severity == Severity::error) return said.code + ": " + said.message;
    return "";
}

} // namespace

TEST_CASE("version: a file may begin with the present one, and another is an error that says what is read")
{
    CHECK(first_error("// Mine.\nlanguage 1;\ntexture t() { return 1mm; }") == "");
    CHECK(first_error("language 2;\ntexture t() { return 1mm; }") ==
          "language-version: this file is written in version 2 of the language, and this Haptel reads version 1");
    for (const char* number : {"0", "1.5", "1mm", "1u", "0x1", "99999999999999999999"}) {
        CAPTURE(number);
        const std::string said = first_error("language " + std::string(number) + ";\ntexture t() { return 1mm; }");
        CHECK(said == "language-version: expected the version of the language, a whole number from 1 on, found '" +
                          std::string(number) + "'");
    }
    CHECK(first_error("texture t() { return 1mm; }\nlanguage 1;") ==
          "language-version: the version of the language stands before all else in a file");
    CHECK(first_error("language 1\ntexture t() { return 1mm; }").starts_with("syntax: expected ';'"));
    CHECK(fault_of_version("2", 3).hint == "'haptel fmt --upgrade' rewrites what has changed");
    CHECK(fault_of_version("4", 3).hint == "a newer Haptel reads it");
    CHECK(fault_of_version("3", 3).message == "");
}

TEST_CASE("version: 'language' is a name wherever it does not begin a file")
{
    CHECK(first_error("float language(float language) { return 2.0 * language; }\n"
                      "texture t(float language2 = 1mm) { float language = language(language2); return language; }") ==
          "");
}

TEST_CASE("version: an upgrade renames from version to version, and writes the version into the first line")
{
    CHECK(brought_to(1, "texture t() { return bumps(p); }", 1) == "language 1;\n\ntexture t() { return bumps(p); }");
    CHECK(brought_to(2, "// Mine.\nlanguage 1;\ntexture t() { return bumps(p) + grooves(p); }", 1) ==
          "// Mine.\nlanguage 2;\ntexture t() { return hills(p) + grooves(p); }");
    CHECK(brought_to(3, "language 1;\ntexture t() { return bumps(p) + fbm(grooves, p); }", 1) ==
          "language 3;\ntexture t() { return mounds(p) + fbm(furrows, p); }");
    CHECK(brought_to(3, "language 2;\ntexture t() { return bumps(p) + hills(p); }", 2) ==
          "language 3;\ntexture t() { return bumps(p) + mounds(p); }");
    CHECK(brought_to(3, "language 3;\ntexture t() { return hills(p); }", 3) ==
          "language 3;\ntexture t() { return hills(p); }");
}

TEST_CASE("version: an upgrade leaves what the text itself declares, members and comments")
{
    const char* const own = "float hills(float x) { return x; } // hills\n"
                            "texture t() { float[2] grooves = float[2](1mm, 2mm); return hills(grooves[0]); }";
    CHECK(brought_to(3, own, 2) == "language 3;\n\n" + std::string(own));
    CHECK(brought_to(3, "texture t() { return other.hills(p); }", 2) ==
          "language 3;\n\ntexture t() { return other.hills(p); }");
    CHECK(brought_to(3, "\xef\xbb\xbftexture t() { return 1mm; }", 1) ==
          "\xef\xbb\xbflanguage 3;\n\ntexture t() { return 1mm; }");
}
