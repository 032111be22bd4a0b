#include "lang/text/source.h"
#include "tests/lang/text/one_source.h"
#include "tests/support/catch.h"

using namespace haptel::lang;

static std::pair<uint32_t, uint32_t> place(const SourceSet& sources, uint32_t byte)
{
    const Position position = sources.position(0, byte);
    return {position.line, position.column};
}

using Place = std::pair<uint32_t, uint32_t>;

TEST_CASE("lines end at LF, CR LF and a lone CR")
{
    const SourceSet sources = one_source("a\nbc\r\nd\re");
    CHECK(sources.line(0, 1) == "a");
    CHECK(sources.line(0, 2) == "bc");
    CHECK(sources.line(0, 3) == "d");
    CHECK(sources.line(0, 4) == "e");
    CHECK(sources.line(0, 5) == "");
    CHECK(sources.line(0, 0) == "");
    CHECK(place(sources, 0) == Place{1, 1});
    CHECK(place(sources, 3) == Place{2, 2});
    CHECK(place(sources, 6) == Place{3, 1});
    CHECK(place(sources, 8) == Place{4, 1});
    CHECK(place(sources, 9) == Place{4, 2});
    CHECK(place(sources, 1000) == Place{4, 2});
}

TEST_CASE("columns count code points, an invalid byte is one")
{
    const SourceSet sources =
        one_source("\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80\xFF\xC3x"); // e-acute, euro, a face, two invalid bytes
    CHECK(place(sources, 2) == Place{1, 2});
    CHECK(place(sources, 5) == Place{1, 3});
    CHECK(place(sources, 9) == Place{1, 4});
    CHECK(place(sources, 10) == Place{1, 5});
    CHECK(place(sources, 11) == Place{1, 6});
}

TEST_CASE("a byte order mark is no part of the first line")
{
    const SourceSet sources = one_source("\xEF\xBB\xBF"
                                         "ab\n");
    CHECK(sources.line(0, 1) == "ab");
    CHECK(place(sources, 3) == Place{1, 1});
    CHECK(place(sources, 4) == Place{1, 2});
}

TEST_CASE("only shortest forms of real characters are UTF-8")
{
    const auto invalid = [](std::string_view text) {
        return decode_utf8(text, 0).value == invalid_code_point && decode_utf8(text, 0).length == 1;
    };
    CHECK(decode_utf8("\xE2\x82\xAC", 0).value == 0x20AC);
    CHECK(decode_utf8("\xF4\x8F\xBF\xBF", 0).value == 0x10FFFF);
    CHECK(invalid("\xC0\x80"));         // overlong NUL
    CHECK(invalid("\xE0\x80\xAF"));     // overlong slash
    CHECK(invalid("\xED\xA0\x80"));     // surrogate
    CHECK(invalid("\xF4\x90\x80\x80")); // above the last plane
    CHECK(invalid("\xE2\x82"));         // cut off
    CHECK(invalid("\x80"));
}

TEST_CASE("what is printed is valid UTF-8 and cannot steer the terminal")
{
    CHECK(printable("caf\xC3\xA9") == "caf\xC3\xA9");
    CHECK(printable("a\xFF"
                    "b") == "a\xEF\xBF\xBD"
                            "b");
    CHECK(printable("\033[2J") == "\xEF\xBF\xBD[2J");
    CHECK(printable("\n") == "\xEF\xBF\xBD");
    CHECK(printable("\xC2\x9B") == "\xEF\xBF\xBD");     // the one-character form of ESC [
    CHECK(printable("\xE2\x80\xAE") == "\xEF\xBF\xBD"); // right-to-left override
}

TEST_CASE("places outside of any file are harmless")
{
    const SourceSet sources = one_source("ab");
    CHECK(sources.text({7, 0, 1}).empty());
    CHECK(sources.text({0, 1, 900}) == "b");
    CHECK(sources.text({0, 9, 10}).empty());
    CHECK(sources.line(7, 1).empty());
    CHECK(sources.position(7, 1).line == 1);
}
