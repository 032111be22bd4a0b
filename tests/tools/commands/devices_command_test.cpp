// haptel devices: what it lists on a machine without devices, and when a device counts as opened.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("devices: lists what is supported, by the names that open it")
{
    const Ran ran = run_command("devices --json");
    REQUIRE(ran.code == 0);
    const Json all = Json::parse(ran.out);
    CHECK(all["connected"].is_array());
    bool has_falcon = false;
    for (const Json& one : all["supported"]) has_falcon |= one["name"] == "falcon[:SERIAL]";
    CHECK(has_falcon);
    const Ran text = run_command("devices");
    CHECK(text.code == 0);
    CHECK(text.out.find("simulated[:PRESET[:HAND]]") != std::string::npos);
}

TEST_CASE("devices: one that moves is opened; its axes, its range and its readings are told")
{
    const Ran ran = run_command("devices --open simulated:wheel --seconds 2 --json");
    REQUIRE(ran.code == 0);
    const Json said = Json::parse(ran.out);
    CHECK(said["opened"] == true);
    CHECK(said["senses"] == "x");
    CHECK(said["pushes"] == "x");
    CHECK(said["reads"] == 2000); // two seconds at 1 kHz
    CHECK(said["poses"] == 2000);
    CHECK(said["range_m"][0] > 1e-4);
    CHECK(said["range_m"][1] == 0);
}

TEST_CASE("devices: one that is not there, or unknown, is told with what to do")
{
    const Ran unknown = run_command("devices --open falkon");
    CHECK(unknown.code == 1);
    CHECK(unknown.err.find("did you mean 'falcon'?") != std::string::npos);
    CHECK(run_command("devices --open simulated --seconds -1").code == 2);
}
