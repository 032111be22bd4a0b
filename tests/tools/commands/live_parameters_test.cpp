// Parameters that other programs set while a hand feels them.
#include "runtime/render/renderer.h"
#include "tests/jit/texture/idioms.h"
#include "tests/tools/commands/live_stage.h"
#include "tests/tools/commands/quiet_machine.h"
#include "tests/tools/control/osc_client.h"
#include "tools/control/osc_server.h"

#include <chrono>
#include <cmath>
#include <random>
#include <thread>

using namespace haptel;
using namespace haptel::test;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

namespace {

constexpr const char* ripples =
    "texture t(float pitch = 2mm in 0.5mm .. 5mm, float depth = 60um in 0um .. 200um, int octaves = 2 in 1 .. 4)\n"
    "{ return depth * fbm(vec3(p.xy / pitch, 0.0), octaves); }\n"
    "texture fine = t(pitch = 1mm, depth = 20um);\n";
const std::string depth = "/haptel/object/1/parameter/depth";

} // namespace

TEST_CASE("a parameter that is set over OSC is felt within two ticks, and nothing is compiled")
{
    LiveStage stage(ripples);
    TexturesAlone controlled(stage.textures);
    tools::OscControl control(controlled);
    runtime::Renderer renderer(stage.scene, {});
    runtime::DevicePose pose;
    runtime::TickResult felt;
    for (uint64_t tick = 0; tick < 600; ++tick) press_and_stay(tick, pose), felt = renderer.tick(pose);
    REQUIRE(glm::length(felt.force_n) > 0.1);
    const uint64_t compiled = stage.textures.compiled();
    const std::size_t programs = jit::programs_alive();

    std::vector<int64_t> taken_us;
    const auto is_felt = [&](const std::string& datagram) {
        const uint64_t serial = stage.slot().newest_serial();
        const glm::dvec3 force_n = felt.force_n;
        const auto answers = control.take(datagram, {0, 7000}, Clock::now());
        REQUIRE(answers.size() == 1);
        CHECK(osc_heard(answers[0].bytes).address == "/haptel/ok");
        const auto asked = Clock::now();
        REQUIRE(comes_true([&] { return stage.slot().newest_serial() > serial; }));
        taken_us.push_back(std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - asked).count());
        renderer.tick(pose);
        felt = renderer.tick(pose);
        CHECK(felt.binding == stage.slot().newest_serial());
        CHECK(glm::distance(felt.force_n, force_n) > 1e-6);
        for (int i = 0; i < 60; ++i) felt = renderer.tick(pose); // until it has faded in
    };
    is_felt(osc_string_message(depth, "150um"));
    is_felt(osc_bytes(depth, "f", osc_float(0.00002f)));
    is_felt(osc_bytes("/haptel/object/1/parameter/octaves", "i", osc_word(1)));
    is_felt(osc_string_message("/haptel/object/1/preset", "fine"));
    is_felt(osc_string_message("/haptel/object/1/preset", "t"));
    std::ranges::sort(taken_us);
    WARN("from the message to the slot: median " << taken_us[2] << " us, longest " << taken_us.back() << " us");
    CHECK(stage.textures.compiled() == compiled);
    CHECK(jit::programs_alive() == programs);
    CHECK(stage.textures.take_messages().empty());
}

TEST_CASE("a value that cannot be is answered with why, and nothing is felt of it")
{
    LiveStage stage(ripples);
    TexturesAlone controlled(stage.textures);
    tools::OscControl control(controlled);
    const auto why_not = [&](const std::string& datagram) {
        const auto answers = control.take(datagram, {0, 7000}, Clock::now());
        const OscHeard heard = osc_heard(answers.at(0).bytes);
        CHECK(heard.address == "/haptel/error");
        return heard.values.at(1);
    };
    CHECK(why_not(osc_string_message(depth, "3kHz")) == "expected a length such as 0.5mm or 60um, found '3kHz'");
    CHECK(why_not(osc_string_message(depth, "")).find("found ''") != std::string::npos);
    CHECK(!why_not(osc_bytes(depth, "f", osc_word(0x7f800000))).empty()); // infinity
    CHECK(!why_not(osc_bytes(depth, "ff", osc_float(1) + osc_float(1))).empty());
    CHECK(why_not(osc_bytes("/haptel/object/1/parameter/octaves", "i", osc_word(5))) ==
          "5 is outside its range: expected a whole number in 1 .. 4");
    CHECK(why_not(osc_string_message("/haptel/object/1/parameter/dept", "1um")) ==
          "texture 't' has no parameter 'dept': did you mean 'depth'?");
    CHECK(why_not(osc_string_message("/haptel/object/1/preset", "fime")) ==
          "texture 't' has no preset 'fime': did you mean 'fine'?");
    CHECK(why_not(osc_string_message("/haptel/object/2/preset", "fine")) == "expected an object from 1 to 1, found 2");
    std::this_thread::sleep_for(100ms);
    CHECK(stage.slot().newest_serial() == 1);
}

TEST_CASE("what is told of parameters is what is felt: the scene's values, then those that were set, across a reload")
{
    LiveStage stage(ripples);
    const auto value = [&](std::size_t parameter) { return stage.textures.controlled()[0].parameters.at(parameter); };
    CHECK(value(1) == std::pair<std::string, double>("depth", 60e-6));
    CHECK(stage.textures.controlled()[0].presets == std::vector<std::string>{"t", "fine"});
    CHECK(stage.textures.set(1, "depth", "70um").refused.empty());
    CHECK(comes_true([&] { return value(1).second == 70e-6; }));
    CHECK(stage.textures.choose_preset(1, "fine").refused.empty());
    CHECK(comes_true([&] { return value(0).second == 1e-3 && value(1).second == 20e-6; }));
    stage.folder.replace("t.haptel", std::string(ripples) + "// new\n");
    CHECK(comes_true([&] { return stage.textures.take_messages().find("reloaded") != std::string::npos; }));
    CHECK(value(1).second == 20e-6);
}

namespace {

// Another program that sets parameters and chooses presets, well and badly.
struct Controller {
    LiveStage stage{ripples};
    TexturesAlone controlled{stage.textures};
    tools::OscServer server{0, controlled};
    OscClient client{server.port()};
    std::mt19937_64 random{5};

    void change(int i)
    {
        const float metres = static_cast<float>(random() % 1000) * 2e-7f;
        switch (random() % 8) {
        case 0: client.send(osc_string_message("/haptel/object/1/preset", random() % 2 ? "fine" : "t")); break;
        case 1: client.send(osc_string_message(depth, "3kg")); break;
        case 2:
            client.send(
                osc_bytes("/haptel/object/1/parameter/octaves", "i", osc_word(static_cast<uint32_t>(random() % 7))));
            break;
        default: client.send(osc_bytes(depth, "f", osc_float(metres))); break;
        }
        server.serve();
        client.drop_what_came();
        if (i % 100 == 0) stage.textures.take_messages();
    }
};

} // namespace

TEST_CASE("10 000 parameters set over OSC while a servo runs: no allocation, no step of the force, no memory")
{
    Controller controller;
    LiveStage& stage = controller.stage;
    const auto pause = [] { std::this_thread::sleep_for(500us); };
    const LiveRun still = LiveRun::of(stage, 10'000, [&](int) { pause(); });
    const uint64_t serial = stage.slot().newest_serial(), compiled = stage.textures.compiled();
    const LiveRun changed = LiveRun::of(stage, 10'000, [&](int i) { controller.change(i), pause(); });
    WARN("missed deadlines: " << changed.report.missed_deadlines << " of " << changed.report.ticks << " ticks, "
                              << still.report.missed_deadlines << " of " << still.report.ticks << " without changes; "
                              << stage.slot().newest_serial() - serial << " values published; force "
                              << changed.force_min_n << " .. " << changed.force_max_n << " N, largest step "
                              << changed.step_max_n << " N in a period (" << still.step_max_n
                              << " without); heap grew by " << changed.heap_growth << " bytes (" << still.heap_growth
                              << " without), resident by " << changed.resident_growth);
    CHECK(stage.slot().newest_serial() - serial > 500);
    CHECK(stage.textures.compiled() == compiled);
    CHECK(changed.report.state == runtime::ServoState::stopped);
    CHECK(changed.report.allocations_in_tick == 0);
    CHECK(changed.report.faults == 0);
    CHECK(changed.force_max_n - changed.force_min_n > 0.05); // it was felt,
    CHECK(still.step_max_n < 1e-9);
    // and each fades in over 50 ms: a 50th of a force that is the product of a height and of a slope, both fading.
    CHECK(changed.step_max_n < 2 * changed.force_max_n / 50);
    CHECK(changed.heap_growth < 1 << 17); // the values published take four times as much
    CHECK(changed.resident_growth < 16 << 20);
}

TEST_CASE("10 000 parameters set over OSC miss no deadline that a servo does not miss without them", "[.long]")
{
    const ProcessorsAwake awake;
    Controller controller;
    const auto pause = [] { std::this_thread::sleep_for(2ms); };
    const LiveRun run =
        LiveRun::of(controller.stage, 10'000, [&](int i) { controller.change(i), pause(); }, {[&](int) { pause(); }});
    const Deadlines &changed = run.deadlines[0], &still = run.deadlines[1];
    WARN("of 1000 deadlines missed: " << changed.mean() << " +- " << changed.error() << ", without changes "
                                      << still.mean() << " +- " << still.error());
    CHECK(changed.mean() - still.mean() < 3 * std::hypot(changed.error(), still.error()));
    CHECK(run.force_max_n - run.force_min_n > 0.05);
}

TEST_CASE(
    "a knob of a texture whose range is searched: no step of the force, neither at once nor when it comes to rest")
{
    LiveStage stage(std::string(idioms) +
                    "texture t(float depth = 50um in 0um .. 200um, float size = 3mm in 1mm .. 5mm)\n"
                    "{ return depth * simplex_plane(p.xy / size); }\n");
    std::this_thread::sleep_for(200ms); // until the range of what is in the hand is known
    constexpr int times = 20;
    int set = 0;
    const LiveRun turned = LiveRun::of(stage, 40 * times, [&](int i) {
        std::this_thread::sleep_for(5ms);
        if (i % 40 != 0) return;
        const bool is_size = ++set % 2 == 0;
        CHECK(stage.textures
                  .set(1, is_size ? "size" : "depth",
                       std::to_string(is_size ? 1 + set % 5 : 10 * set) + (is_size ? "mm" : "um"))
                  .refused.empty());
    });
    WARN(stage.slot().newest_serial() - 1 << " bindings of " << set << " values; force " << turned.force_min_n << " .. "
                                          << turned.force_max_n << " N, largest step " << turned.step_max_n
                                          << " N in a period");
    CHECK(stage.slot().newest_serial() > 5); // where there is time, each at once and most again
    CHECK(turned.report.allocations_in_tick == 0);
    CHECK(turned.report.faults == 0);
    CHECK(turned.force_max_n - turned.force_min_n > 0.05);
    CHECK(turned.step_max_n < 2 * turned.force_max_n / 50);
}
