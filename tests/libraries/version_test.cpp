#include "libraries/version.h"
#include "tests/support/catch.h"

using namespace haptel;
using namespace haptel::libraries;

namespace {

bool serves(const char* version, const char* least)
{
    return parse_version(version)->serves(*parse_least_version(least));
}

} // namespace

TEST_CASE("a version is three numbers; what is least may be shorter")
{
    CHECK(parse_version("1.20.3") == Version{1, 20, 3});
    CHECK(parse_version("0.0.0") == Version{});
    CHECK(parse_version("999999.0.0") == Version{999999, 0, 0});
    for (const char* const text : {"", "1", "1.2", "1.2.3.4", "1.2.", ".1.2", "1..2", "01.2.3", "1.2.3-rc1", "1.2.3+4",
                                   "v1.2.3", "1.2.-3", "1.2.3 ", "1000000.0.0", "1.2.x"})
        CHECK(!parse_version(text));
    CHECK(parse_least_version("1") == Version{1, 0, 0});
    CHECK(parse_least_version("1.2") == Version{1, 2, 0});
    CHECK(parse_least_version("1.2.3") == Version{1, 2, 3});
    for (const char* const text : {"", "1.", "^1.2", ">=1.2", "1.2.3.4"}) CHECK(!parse_least_version(text));
    CHECK(to_text(Version{1, 20, 3}) == "1.20.3");
}

TEST_CASE("versions are ordered by their numbers, and serve within a major one as semver.org says")
{
    CHECK(*parse_version("1.10.0") > *parse_version("1.9.9"));
    CHECK(serves("1.2.3", "1.2"));
    CHECK(serves("1.9.0", "1.2.3"));
    CHECK(!serves("1.2.2", "1.2.3"));
    CHECK(!serves("2.0.0", "1.2"));
    CHECK(serves("0.3.4", "0.3.1"));
    CHECK(!serves("0.4.0", "0.3.1")); // before 1.0.0 a minor version may change everything
}
