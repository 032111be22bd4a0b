// What OSC messages do, what they answer, and what subscribers hear; sockets apart.
#include "tests/support/catch.h"
#include "tests/tools/control/fake_controlled.h"
#include "tests/tools/control/osc_bytes.h"
#include "tools/control/osc_control.h"

#include <chrono>

using namespace haptel;
using namespace haptel::test;
using namespace std::chrono_literals;
using tools::OscControl;
using Strings = std::vector<std::string>;

namespace {

struct Conversation {
    FakeControlled controlled;
    OscControl control{controlled};
    OscControl::Clock::time_point now{};

    std::vector<OscHeard> say(const std::string& bytes, uint16_t port = 7000)
    {
        std::vector<OscHeard> heard;
        for (const tools::OscDatagram& answer : control.take(bytes, {0, port}, now)) {
            CHECK(answer.to == tools::OscPeer{0, port});
            heard.push_back(osc_heard(answer.bytes));
        }
        return heard;
    }
    // Of a message that is refused.
    std::string why_not(const std::string& bytes)
    {
        const std::vector<OscHeard> heard = say(bytes);
        REQUIRE(heard.size() == 1);
        CHECK(heard[0].address == "/haptel/error");
        REQUIRE(heard[0].values.size() == 2);
        return heard[0].values[1];
    }
    bool is_done(const std::string& bytes)
    {
        const std::vector<OscHeard> heard = say(bytes);
        return !heard.empty() && heard.back().address == "/haptel/ok";
    }
};

bool has(const std::string& text, const std::string& part)
{
    INFO(text);
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("osc: a parameter is set by text with its unit, by numbers, by several numbers")
{
    Conversation with;
    const std::string depth = "/haptel/object/2/parameter/depth";
    CHECK(with.is_done(osc_string_message(depth, "60um")));
    CHECK(with.is_done(osc_bytes(depth, "f", osc_float(0.00008f))));
    CHECK(with.is_done(osc_bytes("/haptel/object/2/parameter/octaves", "i", osc_word(5))));
    CHECK(with.is_done(osc_bytes("/haptel/object/2/parameter/size", "ff", osc_float(0.5f) + osc_float(2))));
    CHECK(with.is_done(osc_bytes("/haptel/object/2/parameter/size.x", "s", osc_text("2mm"))));
    CHECK(with.is_done(osc_bytes("/haptel/object/2/parameter/worn", "T")));
    CHECK(with.controlled.done == Strings{"set 2 depth 60um", "set 2 depth 8e-05", "set 2 octaves 5",
                                          "set 2 size 0.5, 2", "set 2 size.x 2mm", "set 2 worn true"});
    const std::vector<OscHeard> warned = with.say(osc_string_message("/haptel/object/2/parameter/deep", "1m"));
    REQUIRE(warned.size() == 1);
    CHECK(warned[0].values == Strings{"/haptel/object/2/parameter/deep", "outside of its range"});
    const std::vector<OscHeard> asked = with.say(osc_bytes(depth));
    REQUIRE(asked.size() == 2);
    CHECK(asked[0].address == "/haptel/state/object/2/parameter/depth");
    CHECK(std::stod(asked[0].values.at(0)) == 60e-6);
}

TEST_CASE("osc: preset, scene, recording, stop and start; a bundle in its order")
{
    Conversation with;
    CHECK(with.is_done(osc_string_message("/haptel/object/2/preset", "flint")));
    CHECK(with.is_done(osc_string_message("/haptel/scene/load", "other.toml")));
    CHECK(with.is_done(osc_bytes("/haptel/record/start")));
    CHECK(with.why_not(osc_bytes("/haptel/record/stop")) == "nothing is recorded");
    CHECK(with.controlled.done == Strings{"preset 2 flint", "scene other.toml", "record"});
    CHECK(with.is_done(osc_bytes("/haptel/stop")));
    CHECK(with.controlled.withheld);
    CHECK(with.is_done(osc_bytes("/haptel/start")));
    CHECK(!with.controlled.withheld);
    CHECK(with.say(osc_bundle({osc_bytes("/haptel/start"), osc_bytes("/haptel/stop")})).size() == 2);
    CHECK(with.controlled.withheld);
}

TEST_CASE("osc: what is wrong is told: what was expected, what was found, how to mend it")
{
    Conversation with;
    CHECK(has(with.why_not(osc_bytes("/haptel/stopp")), "did you mean /haptel/stop?"));
    CHECK(has(with.why_not(osc_bytes("/other")), "expected /haptel/start"));
    CHECK(has(with.why_not(osc_bytes("/haptel/stop", "i", osc_word(1))), "expected no arguments, found 1"));
    CHECK(has(with.why_not(osc_bytes("/haptel/object/x/preset", "s", osc_text("a"))), "from 1, found 'x'"));
    CHECK(has(with.why_not(osc_bytes("/haptel/object/0/preset", "s", osc_text("a"))), "from 1, found '0'"));
    CHECK(has(with.why_not(osc_bytes("/haptel/object/2/preset", "i", osc_word(1))), "the name of a preset"));
    CHECK(has(with.why_not(osc_bytes("/haptel/object/2/parameter/")), "no such address"));
    CHECK(has(with.why_not(osc_bytes("/haptel/object/2")), "no such address"));
    CHECK(has(with.why_not(osc_bytes("/haptel/object/2/parameter/hight")), "no parameter 'hight'"));
    CHECK(has(with.why_not(osc_string_message("/haptel/object/2/parameter/wrong", "1")), "no such parameter"));
    CHECK(has(with.why_not(osc_bytes("/haptel/scene/load")), "the name of a scene file"));
    CHECK(has(with.why_not(osc_bytes("/haptel/subscribe", "i", osc_word(0))), "from 1 to 60 Hz"));
    CHECK(has(with.why_not(osc_bytes("/haptel/subscribe", "f", osc_word(0x7fc00000))), "from 1 to 60 Hz")); // NaN
    CHECK(has(with.why_not(osc_bytes("/haptel/subscribe", "ii", osc_word(30) + osc_word(70000))), "as the port"));
    CHECK(has(with.why_not("hello"), "starts with an address"));
    CHECK(with.controlled.done.empty());
    // Or two programs would answer each other for ever.
    for (const char* told : {"/haptel/error", "/haptel/ok", "/haptel/message", "/haptel/state/running"})
        CHECK(with.say(osc_bytes(told)).empty());
}

TEST_CASE("osc: what there is to set is listed")
{
    Conversation with;
    const std::vector<OscHeard> heard = with.say(osc_bytes("/haptel/list"));
    REQUIRE(heard.size() == 7);
    CHECK(heard[0].address == "/haptel/state/object/1");
    CHECK(heard[0].values == Strings{"plane", ""});
    CHECK(heard[1].values == Strings{"ball.obj", "rock"});
    CHECK(heard[2].address == "/haptel/state/object/2/preset");
    CHECK(heard[3].values == Strings{"flint"});
    CHECK(heard[5].address == "/haptel/state/object/2/parameter/octaves");
    CHECK(heard[5].values == Strings{"5"});
    CHECK(heard[6].address == "/haptel/ok");
}

TEST_CASE("osc: subscribers hear the state at their rate, values when they change, and nothing after a minute")
{
    Conversation with;
    const auto at = [&](std::chrono::milliseconds time) {
        std::vector<OscHeard> heard;
        for (const tools::OscDatagram& datagram : with.control.state(with.now + time)) {
            CHECK(datagram.to.port == 7001);
            heard.push_back(osc_heard(datagram.bytes));
        }
        return heard;
    };
    CHECK(at(0ms).empty());
    CHECK(with.is_done(osc_bytes("/haptel/subscribe", "ii", osc_word(50) + osc_word(7001))));
    const std::vector<OscHeard> first = at(0ms);
    REQUIRE(first.size() == 9);
    CHECK(first[0].values == Strings{"running"});
    CHECK(first[1].address == "/haptel/state/hand/1/position");
    CHECK(first[1].values == Strings{"0.001000", "0.002000", "0.003000"});
    CHECK(first[2].values == Strings{"0.000000", "0.000000", "1.500000"});
    CHECK(first[3].values == Strings{"1"});
    CHECK(first[5].address == "/haptel/state/hand/1/fault");
    CHECK(first[5].values == Strings{"4"});
    CHECK(first[6].address == "/haptel/state/hand/1/missed_deadlines");
    CHECK(first[6].values == Strings{"7"});
    CHECK(first[7].address == "/haptel/state/object/2/parameter/depth");
    CHECK(at(19ms).empty());
    CHECK(at(20ms).size() == 7); // the values are the same
    CHECK(at(21ms).empty());
    ++with.controlled.version;
    with.controlled.withheld = true;
    const std::vector<OscHeard> changed = at(40ms);
    CHECK(changed.size() == 9);
    CHECK(changed[0].values == Strings{"stopped"});
    CHECK(at(59'990ms).size() == 7);
    CHECK(at(60'100ms).empty());
    CHECK(with.control.subscribers() == 0);
}

TEST_CASE("osc: a port has one subscription, and there is an end to them")
{
    Conversation with;
    for (int i = 0; i < 100; ++i) with.say(osc_bytes("/haptel/subscribe"), 7000);
    CHECK(with.control.subscribers() == 1);
    for (uint16_t port = 7001; port < 7200; ++port) with.say(osc_bytes("/haptel/subscribe"), port);
    CHECK(with.control.subscribers() == OscControl::subscribers_max);
    CHECK(has(with.say(osc_bytes("/haptel/subscribe"), 9999)[0].values[1], "have subscribed already"));
    CHECK(with.is_done(osc_bytes("/haptel/unsubscribe")));
    CHECK(with.control.subscribers() == OscControl::subscribers_max - 1);
    CHECK(with.control.tell("rock.haptel: reloaded\n").size() == OscControl::subscribers_max - 1);
}
