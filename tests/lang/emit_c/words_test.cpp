// Numbers, strings, comments and names of C text.
#include "lang/emit_c/words.h"
#include "tests/support/catch.h"

#include <bit>
#include <cstdlib>
#include <random>

using namespace haptel::emit_c;

TEST_CASE("a literal is the number again, in double and in float")
{
    std::mt19937_64 random(5);
    for (int i = 0; i < 20000; ++i) {
        const auto number = std::bit_cast<double>(random());
        if (!(number - number == 0)) continue;
        std::string text = literal(number);
        if (text[0] == '(') text = text.substr(1, text.size() - 2);
        REQUIRE(std::bit_cast<uint64_t>(std::strtod(text.c_str(), nullptr)) == std::bit_cast<uint64_t>(number));
        REQUIRE(text.find_first_of(".e") != text.npos); // or it was a whole number, and divided as one
    }
    CHECK(literal(-0.0) == "(-0.0)");
    CHECK(literal(3.0) == "3.0");
    CHECK(literal(0.1, true) == "0.1F");
    CHECK(literal(-HUGE_VAL) == "(-HUGE_VAL)");
    CHECK(literal(1e300, true) == "HUGE_VALF");
    CHECK(literal(uint32_t{4294967295}) == "4294967295u");
}

TEST_CASE("no text of an author ends its string or its comment")
{
    CHECK(quoted("a\"b\\c\n\xc3\xa9?") == "\"a\\042b\\134c\\012\\303\\251\\077\"");
    const std::string comment = in_comment("*/ evil(); /* **/", " * ");
    CHECK(comment.find("*/") == comment.npos);
    CHECK(comment.find("/*") == comment.npos);
    CHECK(in_comment("two\nlines", " * ") == "two\n * lines");
}

TEST_CASE("parameters whose names C or a neighbour has taken get others")
{
    haptel::ir::Texture texture;
    for (const char* name : {"depth", "class", "class_", "size.x", "size_x", "head"}) {
        texture.parameters.emplace_back();
        texture.parameters.back().name = name;
    }
    std::vector<std::string> names;
    for (const haptel::ir::Parameter& parameter : texture.parameters) names.push_back(member_name(texture, parameter));
    CHECK(names == std::vector<std::string>{"depth", "class__", "class_", "size_x_", "size_x", "head_"});
}
