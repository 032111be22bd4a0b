// haptel bench: what scripts rely on, and that the front end grows with the text and not faster.
#include "tests/support/catch.h"
#include "tests/tools/run_command.h"
#include "tools/json.h"

using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("bench compile: rows by length, with machine, commit and flags")
{
    const Folder folder;
    const Ran ran = run_command("bench compile --quick --json --out '" + folder.file("figures") + "'");
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    for (const char* field : {"machine", "commit", "flags"}) CHECK(!json[field].get<std::string>().empty());
    REQUIRE(json["rows"].size() == 6);
    for (const Json& row : json["rows"]) {
        CHECK(row["front_end_ms"]["median"].get<double>() > 0);
        CHECK(row["front_end_ms"]["p99"].get<double>() >= row["front_end_ms"]["median"].get<double>());
        CHECK(row.contains("cached_ms"));
    }
    CHECK(json["rows"][3]["lines"].get<int>() >= 370);
    // a ratio of times side by side: a front end that grew with the square would be at 16
    CHECK(json["growth"].get<double>() < 6);
    CHECK(Json::parse(read_file(folder.path / "figures/compile.json")) == json);
    CHECK(run_command("bench nothing").code == 2);
    CHECK(run_command("bench --quick --out /proc/none").code == 1);
}
