// Examples show what their first lines say.
#include "runtime/recording.h"
#include "tests/support/catch.h"
#include "tests/tools/run_command.h"
#include "tools/json.h"

#include <glm/glm.hpp>

#include <string>

using namespace haptel::test;
using glm::dvec3;
using haptel::runtime::TickRecord;
using haptel::tools::Json;

namespace {

const std::string explore = "explore " HAPTEL_SOURCE_DIR "/examples/scenes/";

} // namespace

TEST_CASE("example lever: the shaft leans on the block in a part of each circle, and the torque is then not the tip's")
{
    const Folder folder;
    const Ran ran = run_command(explore + "lever.toml --clock virtual --seconds 4 --out " + folder.file("run"));
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const auto trace = haptel::runtime::read_trace(folder.file("run/trace.csv"));
    REQUIRE(trace.records.size() == 4000);
    int by_tip = 0, leaning = 0;
    for (const TickRecord& tick : trace.records) {
        const double force_n = glm::length(tick.force_n);
        REQUIRE(force_n < 2); // the scene's limit is 5: it leans, and is not wedged
        if (tick.time_s < 0.7) continue;
        const dvec3 along = glm::normalize(tick.tail_m - tick.tip_m);
        const dvec3 of_tip = glm::cross(-0.05 * along, tick.force_n); // the grip is 5 cm from the tip
        const double off_n_m = glm::length(tick.torque_n_m - of_tip);
        by_tip += force_n > 0.2 && off_n_m < 1e-9;
        leaning += off_n_m > 3e-3; // N m
    }
    CHECK(by_tip > 1500);
    CHECK(leaning > 500);
}

TEST_CASE("example rings: the hand goes round on the texture, and falls into no hole")
{
    for (const char* scene : {"stone", "leather_ring", "two_hands"}) {
        const Ran ran = run_command(explore + scene + ".toml --clock virtual --seconds 4 --json");
        CAPTURE(scene, ran.err);
        REQUIRE(ran.code == 0);
        const Json report = Json::parse(ran.out);             // of the first device
        CHECK(report["skipped"]["texture"].get<int>() < 750); // above the ring, and while it presses more and more
        CHECK(report["contact_ticks"].get<int>() > 3300);
        CHECK(report["force_n"]["max"].get<double>() < 1.5 * report["force_n"]["rms"].get<double>());
    }
}
