#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tools/report/explore_report.h"

#include <limits>

using namespace haptel::tools;

TEST_CASE("the report holds every promised field, null where nothing was measured")
{
    ExploreOutcome outcome;
    outcome.hands.resize(1);
    haptel::runtime::ServoReport& servo = outcome.hands[0].servo;
    servo.force_rms_n = std::numeric_limits<double>::quiet_NaN();
    Json json = Json::parse(to_text(to_json(outcome)));
    for (const char* field :
         {"seconds", "rate_hz", "ticks", "missed_deadlines", "contact_ticks", "tick_ns", "wake_late_us", "force_n",
          "energy_j", "faults", "textures_compiled", "reloads", "allocations_in_tick", "skipped"}) {
        CAPTURE(field);
        CHECK(json.contains(field));
    }
    CHECK(json["tick_ns"].size() == 4);
    CHECK(json["tick_ns"]["p999"].is_null());
    CHECK(json["wake_late_us"]["max"].is_null());
    CHECK(json["force_n"]["rms"].is_null());
    CHECK(json["allocations_in_tick"].is_null());
    for (const char* stage : {"free_space", "objects", "texture", "octaves", "mapping"})
        CHECK(json["skipped"][stage] == 0);

    servo.allocations_in_tick = 3;
    servo.skipped = {4, 6, 5, 3, 2};
    for (uint64_t ns = 1; ns <= 1000; ++ns) servo.wake_late_ns.add(ns * 1000);
    json = to_json(outcome);
    CHECK(json["allocations_in_tick"] == 3);
    CHECK(json["skipped"] == Json{{"free_space", 4}, {"objects", 6}, {"texture", 5}, {"octaves", 3}, {"mapping", 2}});
    CHECK(json["wake_late_us"]["max"] == 1000);
    const double median_us = json["wake_late_us"]["median"];
    CHECK((median_us > 480 && median_us < 520)); // buckets of 3 %
    CHECK(!to_lines(outcome).empty());
}

TEST_CASE("a fault is told by its own name")
{
    ExploreOutcome outcome;
    outcome.hands.resize(1);
    haptel::runtime::ServoReport& servo = outcome.hands[0].servo;
    servo.faults = 3;
    servo.fault_bits = haptel::runtime::fault_height_above_bound;
    const std::string bound = to_lines(outcome);
    CHECK(bound.find("above its proven bound") != std::string::npos);
    CHECK(bound.find("not finite") == std::string::npos);
    servo.fault_bits = haptel::runtime::fault_pose_not_finite | 1u << 31;
    CHECK(to_lines(outcome).find("pose that is not finite (no force); unknown bits 0x80000000") != std::string::npos);
}
