// Examples show what their first lines say.
#include "runtime/servo/recording.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace haptel::test;
using glm::dvec3;
using haptel::runtime::TickRecord;
using haptel::tools::Json;

namespace {

const std::string explore = "explore " + project_path("examples/scenes/");

// What a hand feels in so many seconds of a scene of which nothing is to be said. Recorded: a folder's pictures take
// longer than all the ticks.
std::vector<TickRecord> felt_in(const std::string& scene, int seconds)
{
    const Folder folder;
    const Ran ran = run_command(explore + scene + " --clock virtual --seconds " + std::to_string(seconds) +
                                " --json --record " + folder.file("run.haptrace"));
    CAPTURE(scene);
    CHECK(ran.err == "");
    REQUIRE(ran.code == 0);
    auto trace = haptel::runtime::read_trace(folder.file("run.haptrace"));
    REQUIRE(trace.records.size() == static_cast<std::size_t>(1000 * seconds));
    int touching = 0;
    for (const TickRecord& tick : trace.records) {
        touching += tick.contact > 0;
        REQUIRE(glm::length(tick.force_n) < 1.5);
    }
    CHECK(touching > 1000 * seconds - 700);
    trace.records.erase(trace.records.begin(), trace.records.begin() + 1000); // it comes down
    return std::move(trace.records);
}

template <class Quantity>
double mean(const std::vector<TickRecord>& ticks, double from_x_m, double to_x_m, Quantity of)
{
    double sum = 0, count = 0;
    for (const TickRecord& tick : ticks)
        if (tick.tip_m.x > from_x_m && tick.tip_m.x < to_x_m) sum += of(tick), ++count;
    return sum / count;
}

struct Range {
    double least, most;
};

Range heights_m(const std::vector<TickRecord>& ticks, double from_x_m, double to_x_m)
{
    Range range{1, -1};
    for (const TickRecord& tick : ticks)
        if (tick.tip_m.x > from_x_m && tick.tip_m.x < to_x_m)
            range = {std::min(range.least, tick.height_m), std::max(range.most, tick.height_m)};
    return range;
}

} // namespace

TEST_CASE("example lever: the shaft leans on the block in a part of each circle, and the torque is then not the tip's")
{
    const Folder folder;
    const Ran ran =
        run_command(explore + "lever.toml --clock virtual --seconds 4 --record " + folder.file("run.haptrace"));
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const auto trace = haptel::runtime::read_trace(folder.file("run.haptrace"));
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

TEST_CASE("example rib: bone is felt through the flesh that it reaches out of")
{
    const auto ticks = felt_in("rib.toml", 6);
    const auto up_n = [](const TickRecord& tick) { return tick.force_n.z; };
    const double flesh_n = mean(ticks, 0.02, 0.028, up_n);
    CHECK(flesh_n > 0.3);
    CHECK(mean(ticks, -0.004, 0.004, up_n) > 2 * flesh_n);
}

TEST_CASE("example honey: it holds the hand back more than water does")
{
    const auto ticks = felt_in("honey.toml", 6);
    const auto sideways_n = [](const TickRecord& tick) { return std::hypot(tick.force_n.x, tick.force_n.y); };
    const double honey_n = mean(ticks, -0.018, 0, sideways_n), water_n = mean(ticks, 0.01, 0.018, sideways_n);
    CHECK(honey_n > 0.06 * 4);
    CHECK(water_n > 0.06);
    CHECK(honey_n > 2 * water_n);
}

TEST_CASE("examples handle, dice, vault: what is mapped on a cylinder, a cube and by the mesh lies where the hand goes")
{
    const auto handle = felt_in("handle.toml", 6);
    for (const double x_m : {-0.008, 0.0, 0.008}) {
        const auto [least_m, most_m] = heights_m(handle, x_m - 0.002, x_m + 0.002);
        CHECK(least_m < 10e-6);
        CHECK(most_m > 90e-6);
    }
    const auto dice = felt_in("dice.toml", 12);
    const auto [pip_m, bone_m] = heights_m(dice, -0.018, -0.001);
    CHECK(pip_m < -0.35e-3);
    CHECK(bone_m == 0);
    const auto [least_m, most_m] = heights_m(dice, 0.001, 0.018);
    CHECK(least_m < -20e-6);
    CHECK(most_m > 20e-6);
    const auto vault = felt_in("vault.toml", 6);
    for (const double x_m : {-0.025, 0.0, 0.025}) { // a course is 4 mm along the arc
        const auto [joint_m, brick_m] = heights_m(vault, x_m - 0.004, x_m + 0.004);
        CHECK(joint_m < 0.08e-3);
        CHECK(brick_m > 0.3e-3);
    }
}
