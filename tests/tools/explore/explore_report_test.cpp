#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tools/explore/explore_report.h"

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
    CHECK(json["link_us"]["median"].is_null());
    for (uint64_t ns = 1; ns <= 1000; ++ns) servo.wake_late_ns.add(ns * 1000);
    servo.link_ns.add(2'000'000);
    json = to_json(outcome);
    CHECK(json["allocations_in_tick"] == 3);
    CHECK(json["skipped"] == Json{{"free_space", 4}, {"objects", 6}, {"texture", 5}, {"octaves", 3}, {"mapping", 2}});
    CHECK(json["wake_late_us"]["max"] == 1000);
    CHECK(json["link_us"]["max"] == 2000);
    const double median_us = json["wake_late_us"]["median"];
    CHECK((median_us > 480 && median_us < 520)); // buckets of 3 %
    CHECK(!to_lines(outcome).empty());
}

TEST_CASE("times are told in the unit that suits them")
{
    ExploreOutcome outcome;
    outcome.hands.resize(1);
    const auto longest_of = [&](uint64_t ns) {
        outcome.hands[0].servo.tick_ns.add(ns);
        const std::string all = to_lines(outcome);
        const size_t at = all.find("longest ");
        return all.substr(at, all.find('\n', at) - at);
    };
    CHECK(longest_of(999) == "longest 999 ns");
    CHECK(longest_of(1'500) == "longest 1.5 us");
    CHECK(longest_of(2'500'000) == "longest 2.5 ms");
}

TEST_CASE("what was left out because deadlines were missed is told, and nothing where none was")
{
    ExploreOutcome outcome;
    outcome.hands.resize(1);
    CHECK(to_json(outcome)["degraded"] == Json{{"without_effects", 0}, {"without_textures", 0}, {"without_force", 0}});
    CHECK(to_lines(outcome).find("overload") == std::string::npos);
    outcome.hands[0].servo.degraded = {70, 30, 5};
    CHECK(to_json(outcome)["degraded"] ==
          Json{{"without_effects", 70}, {"without_textures", 30}, {"without_force", 5}});
    CHECK(to_lines(outcome).find("effects were left out in 70 ticks, textures in 30, all force in 5") !=
          std::string::npos);
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

TEST_CASE("a texture lower than two position steps of the device is told, one that is higher is not")
{
    using haptel::runtime::TickRecord;
    const auto outcome_of = [](double height_m, double resolution_m, double scale) {
        ExploreOutcome outcome;
        HandOutcome& hand = outcome.hands.emplace_back();
        hand.device.name = "simulated:premium";
        hand.device.position_resolution_m = resolution_m;
        TickRecord above;
        above.height_m = 1; // not touched: no height was felt
        hand.heights.add(above, scale);
        for (double height : {-height_m / 2, 0.0, height_m / 2}) {
            TickRecord tick;
            tick.contact = 1;
            tick.depth_m = 1e-4;
            tick.height_m = height;
            hand.heights.add(tick, scale);
        }
        return outcome;
    };
    const std::string note = "the texture is 50 um high along the path, but simulated:premium measures positions in "
                             "steps of 30 um: the steps hide it.";
    CHECK(to_lines(outcome_of(50e-6, 30e-6, 1)).find(note) != std::string::npos);
    CHECK(to_json(outcome_of(50e-6, 30e-6, 1))["texture_below_resolution"] == true);
    CHECK(to_json(outcome_of(50e-6, 30e-6, 1))["felt_height_m"]["maximum"] == 25e-6);
    CHECK(to_json(outcome_of(50e-6, 30e-6, 1))["position_resolution_m"] == 30e-6);
    for (const auto& shown : {outcome_of(61e-6, 30e-6, 1),       // two steps are enough
                              outcome_of(50e-6, 0, 1),           // an exact device, or one that does not say
                              outcome_of(0, 30e-6, 1),           // a flat surface
                              outcome_of(6.1e-6, 30e-6, 0.1)}) { // ten times as high in the hand
        CHECK(to_lines(shown).find("hide") == std::string::npos);
        CHECK(to_json(shown)["texture_below_resolution"] == false);
    }
    CHECK(to_json(outcome_of(50e-6, 0, 1))["position_resolution_m"].is_null());
}

TEST_CASE("contact that is felt as nothing for 200 ms is told, a tap is not")
{
    using haptel::runtime::TickRecord;
    const auto outcome_of = [](int unfelt_ticks, double force_n, bool waiting) {
        ExploreOutcome outcome;
        HandOutcome& hand = outcome.hands.emplace_back();
        hand.servo.rate_hz = 1000;
        TickRecord tick;
        for (int i = 0; i < 3; ++i) { // thrice, with a push between
            tick.contact = 1;
            tick.waiting = waiting;
            tick.force_n = {0, 0, force_n};
            for (int k = 0; k < unfelt_ticks; ++k) {
                tick.depth_m = 1e-6 * k;
                hand.unfelt.add(tick, 0.5);
            }
            tick.force_n = {0, 0, 1};
            hand.unfelt.add(tick, 0.5);
        }
        return outcome;
    };
    const std::string told = to_lines(outcome_of(251, 0, false));
    CHECK(told.find("for 0.25 s the hand was up to 500 um below a surface and felt nothing") != std::string::npos);
    CHECK(to_json(outcome_of(251, 0, false))["unfelt"]["longest_s"] == 0.25); // the first tick lies on it
    for (const ExploreOutcome& fine :
         {outcome_of(150, 0, false), outcome_of(251, 0.1, false), outcome_of(251, 0, true)})
        CHECK(to_lines(fine).find("felt nothing") == std::string::npos);
}
