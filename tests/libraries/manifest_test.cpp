#include "libraries/manifest.h"
#include "tests/libraries/library_text.h"
#include "tests/support/catch.h"

using namespace haptel;
using namespace haptel::libraries;

namespace {

std::string said_of(const std::string& text)
{
    input::FileMessages messages("library.toml");
    const bool is_read = read_manifest(text, messages).has_value();
    CHECK(is_read == messages.text().empty());
    return messages.text();
}

// What is said of the manifest of tests with one line changed.
std::string said_of(const std::string& line, const std::string& instead)
{
    std::string text = test::manifest_text("wood", "1.2.0");
    const size_t at = text.find(line);
    REQUIRE(at != text.npos);
    return said_of(text.replace(at, line.size(), instead));
}

} // namespace

TEST_CASE("library.toml: every key is read")
{
    input::FileMessages messages("library.toml");
    const auto made =
        read_manifest("schema = 1\nname = \"wood\"\nversion = \"1.2.3\"\ntagline = \"Boards\"\n"
                      "authors = [\"A <a@example.org>\", \"B\"]\nlicense = \"MIT OR (CC0-1.0 AND X)\"\n"
                      "textures = [\"oak:board\", \"old/pine:bark\"]\ntags = [\"rough\"]\nhaptel = \"0.1\"\n"
                      "language = 1\n[dependencies]\ngrain = \"2.1\"\n[previews]\n\"old/pine:bark\" = 0.12\n",
                      messages);
    CHECK(messages.text() == "");
    REQUIRE(made);
    CHECK(made->name == "wood");
    CHECK(made->version == Version{1, 2, 3});
    CHECK(made->tagline == "Boards");
    CHECK(made->authors == std::vector<std::string>{"A <a@example.org>", "B"});
    CHECK(made->license == "MIT OR (CC0-1.0 AND X)");
    CHECK(made->textures == std::vector<TextureName>{{"oak", "board"}, {"old/pine", "bark"}});
    CHECK(made->tags == std::vector<std::string>{"rough"});
    CHECK(made->haptel_least == Version{0, 1, 0});
    REQUIRE(made->dependencies.size() == 1);
    CHECK(made->dependencies[0].name == "grain");
    CHECK(made->dependencies[0].least == Version{2, 1, 0});
    REQUIRE(made->previews.size() == 1);
    CHECK(made->previews[0].of == TextureName{"old/pine", "bark"});
    CHECK(made->previews[0].window_m == 0.12);
    CHECK(why_too_new(*made) == "");
}

TEST_CASE("library.toml: a preview is of a texture that is named, and of a size")
{
    const std::string text = test::manifest_text("wood", "1.2.0");
    CHECK(test::says(said_of(text + "[previews]\n\"oak:bord\" = 0.01\n"), "expected one of `textures`"));
    CHECK(test::says(said_of(text + "[previews]\n\"oak\" = 0.01\n"), "expected one of `textures`"));
    for (const char* wrong : {"0", "-0.01", "11", "nan", "\"6mm\"", "[1]"})
        CHECK(test::says(said_of(text + "[previews]\n\"oak:board\" = " + wrong + "\n"),
                         "expected how wide the picture is, 0.0001 .. 10 metres, such as 0.01"));
    CHECK(said_of(text + "[previews]\n\"oak:board\" = 1\n") == "");
}

TEST_CASE("library.toml: what is missing or wrong is told by its place, with what to write")
{
    CHECK(said_of(test::manifest_text("wood", "1.2.0")) == "");
    CHECK(test::says(said_of("license = \"CC0-1.0\"\n", ""),
                     "1:1: error: `license` is missing: write license = \"Apache-2.0\""));
    CHECK(test::says(said_of("license", "licence"), "6:1: error: unknown key `licence`: did you mean `license`?"));
    CHECK(test::says(said_of("\"CC0-1.0\"", "\"Apache 2\""), "6:11: error: expected the SPDX name of a licence"));
    for (const char* const wrong : {"MIT OR", "OR MIT", "(MIT", "MIT)", "MIT AND OR MIT", "GPL/3"})
        CHECK(test::says(said_of("CC0-1.0", wrong), "SPDX"));
    CHECK(test::says(said_of("\"1.2.0\"", "\"1.2\""),
                     "3:11: error: expected three numbers, such as \"1.0.0\", found \"1.2\""));
    CHECK(test::says(said_of("\"1.2.0\"", "1.2"), "expected text in quotes for `version`, found 1.2"));
    CHECK(test::says(said_of("\"wood\"", "\"Wood\""), "2:8: error: expected a name of small letters"));
    CHECK(test::says(said_of("\"wood\"", "\"../wood\""), "expected a name of small letters"));
    CHECK(test::says(said_of("schema = 1", "schema = 2"),
                     "this Haptel reads schema 1, found 2: a newer Haptel may read it"));
    CHECK(test::says(said_of("schema = 1\n", ""), "`schema` is missing"));
    CHECK(
        test::says(said_of("[\"oak:board\"]", "[\"oak.haptel:board\"]"), "expected a file, without .haptel, a colon"));
    CHECK(test::says(said_of("[\"oak:board\"]", "[\"../oak:board\"]"), "expected a file, without .haptel"));
    CHECK(test::says(said_of("[\"oak:board\"]", "[]"), "expected one texture or more"));
    CHECK(test::says(said_of("[\"oak:board\"]", "[\"oak:board\", \"oak:board\"]"), "is there twice"));
    CHECK(test::says(said_of("[\"A. Tester\"]", "\"A. Tester\""), "5:11: error: expected a list of texts"));
    CHECK(test::says(said_of("\"For tests\"", "\"two\\nlines\""), "expected one line"));
    CHECK(test::says(said_of(test::manifest_text("wood", "1.2.0", "[dependencies]\ngrain = 1.2\n")),
                     "9:9: error: expected the least version that will do, such as grain = \"1.2\", found 1.2"));
    CHECK(test::says(said_of(test::manifest_text("wood", "1.2.0", "[dependencies]\nwood = \"1.2\"\n")),
                     "depend on itself"));
    CHECK(test::says(said_of("name = wood"), "1:8: error: "));
    CHECK(test::says(said_of(std::string(100'000, '[')), "nest deeper"));
}

TEST_CASE("library.toml: a library for a newer Haptel or language says so")
{
    input::FileMessages messages("library.toml");
    const auto newer = read_manifest(test::manifest_text("wood", "1.0.0", "haptel = \"99.1\"\n"), messages);
    CHECK(why_too_new(newer.value()) == "it needs Haptel 99.1.0, and this is " + to_text(haptel_version()));
    const auto language = read_manifest(test::manifest_text("wood", "1.0.0", "language = 7\n"), messages);
    CHECK(test::says(why_too_new(language.value()), "version 7 of the language"));
}
