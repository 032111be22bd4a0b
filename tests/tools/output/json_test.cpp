#include "tests/support/catch.h"
#include "tools/output/json.h"

#include <limits>

using namespace haptel::tools;

TEST_CASE("what is not finite is null, numbers round-trip, and bytes that are no UTF-8 are replaced")
{
    Json json;
    json["z_first"] = finite_or_null(std::numeric_limits<double>::infinity());
    json["nan"] = std::numeric_limits<double>::quiet_NaN(); // even where nobody thought of it
    json["third"] = 1.0 / 3;
    json["bytes"] = std::string("a\xff\xc3(", 4);
    json["key\xfe"] = 1;
    json["absent"] = value_or_null(std::optional<int>());
    json["present"] = value_or_null(std::optional<int>(7));
    const std::string text = to_text(json);

    const Json back = Json::parse(text);
    CHECK(back["z_first"].is_null());
    CHECK(back["nan"].is_null());
    CHECK(back["third"].get<double>() == 1.0 / 3);
    CHECK(back["bytes"] == "a\xef\xbf\xbd\xef\xbf\xbd(");
    CHECK(back.contains("key\xef\xbf\xbd"));
    CHECK(back["absent"].is_null());
    CHECK(back["present"] == 7);
    CHECK(back.begin().key() == "z_first"); // in the order in which they were added
    CHECK(text.find("Infinity") == std::string::npos);
}

TEST_CASE("the lines of a text are its JSON array, with a line break at its end or without")
{
    CHECK(lines_of("") == Json::array());
    CHECK(lines_of("a\n\nb") == Json({"a", "", "b"}));
    CHECK(lines_of("a\nb\n") == Json({"a", "b"}));
}
