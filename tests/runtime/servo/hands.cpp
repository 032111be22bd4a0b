// Several hands on one scene: each as if it were alone.
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/servo_turns.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

std::shared_ptr<const Scene> felt_scene()
{
    Mesh mesh = make_torus(0.4, 48, 24);
    scale_to_size(mesh, 0.1);
    Scene scene = bare_scene(mesh, sine_texture(40e-6, 2e-3));
    scene.objects[0].material = {800, 1, 0.3, 0.2};
    scene.objects[0].effects.magnet = {0.5, 5e-3};
    scene.objects[0].effects.vibration = {0.1, 60, {0, 0, 1}};
    Region region;
    region.damping_n_s_per_m = 0.5;
    scene.regions.push_back(region);
    SceneObject moving = scene.objects[0];
    SteadyMotion::Figures figures;
    figures.spin_rad_per_s = 2;
    moving.placement.position_m = {0, 0, 0.06};
    moving.motion = std::make_shared<SteadyMotion>(moving.placement, figures);
    scene.objects.push_back(moving);
    return shared(std::move(scene));
}

struct Hand {
    double phase;
    HandSettings settings;
};

// The second is a ball that reaches in through a workspace of its own.
std::vector<Hand> hands()
{
    Hand ball{1.3, {}};
    ball.settings.probe = ProbeSettings{ProbeKind::sphere, 0, 3e-3};
    ball.settings.workspace.scale = 2;
    ball.settings.workspace.placement.position_m = {0.002, 0, 0.001};
    return {{0, {}}, ball};
}

std::unique_ptr<HapticDevice> device(const Hand& hand)
{
    return std::make_unique<ScriptedDevice>([hand](uint64_t tick, DevicePose& pose) {
        const double t = static_cast<double>(tick) * 1e-3 + hand.phase;
        const glm::dvec3 tip = glm::dvec3(0.045 * std::cos(3 * t), 0.045 * std::sin(3 * t), 0.02 * std::sin(5 * t)) /
                               hand.settings.workspace.scale;
        pose = {tip, tip};
        return DeviceStatus::ok;
    });
}

ServoOptions options(const Hand& hand)
{
    ServoOptions options;
    options.clock = ServoClock::virtual_time;
    options.seconds = 4;
    options.hand = hand.settings;
    options.allocation_count = allocations_of_this_thread;
    return options;
}

std::vector<TickRecord> told(ServoThread& servo)
{
    std::vector<TickRecord> records;
    for (TickRecord record; servo.telemetry().pop(record);) {
        record.compute_ns = 0;
        records.push_back(record);
    }
    return records;
}

void check_equal(const std::vector<TickRecord>& a, const std::vector<TickRecord>& b)
{
    REQUIRE(a.size() == 4000);
    REQUIRE(b.size() == 4000);
    std::size_t different = 0, touching = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        different += a[i].tip_m != b[i].tip_m || a[i].force_n != b[i].force_n || a[i].depth_m != b[i].depth_m ||
                     a[i].contact != b[i].contact || a[i].height_m != b[i].height_m;
        touching += a[i].contact > 0;
    }
    CHECK(different == 0);
    CHECK((touching > 500 && touching < 3500));
}

std::vector<TickRecord> alone(const Hand& hand)
{
    ServoThread servo(felt_scene(), device(hand), options(hand));
    servo.start();
    servo.wait();
    return told(servo);
}

} // namespace

TEST_CASE("two hands on one scene feel what each feels alone, bit for bit, in threads of their own and in turn")
{
    for (const bool in_turn : {false, true}) {
        const auto scene = felt_scene();
        std::vector<std::unique_ptr<ServoThread>> servos;
        std::vector<ServoThread*> all;
        for (const Hand& hand : hands()) {
            servos.push_back(std::make_unique<ServoThread>(scene, device(hand), options(hand)));
            all.push_back(servos.back().get());
        }
        ServoTurns turns(all);
        if (in_turn)
            turns.start();
        else
            for (const auto& servo : servos) servo->start();
        turns.wait();
        for (std::size_t i = 0; i < servos.size(); ++i) {
            const ServoReport& report = servos[i]->wait();
            CHECK(report.state == ServoState::finished);
            CHECK(report.seconds == 4);
            CHECK(report.allocations_in_tick == 0);
            CAPTURE(in_turn, i);
            check_equal(told(*servos[i]), alone(hands()[i]));
        }
    }
}

TEST_CASE("hands that take turns end each in its own time, and all on request")
{
    std::vector<uint64_t> order;
    const auto run_all = [](std::vector<ServoThread*> servos) {
        ServoTurns turns(std::move(servos));
        turns.start();
        turns.wait();
    };
    const auto scripted = [&](uint64_t name, uint64_t ticks) {
        return std::make_unique<ScriptedDevice>([&order, name, ticks](uint64_t tick, DevicePose& pose) {
            order.push_back(name);
            pose = at(0, 0, 0.2);
            return tick < ticks ? DeviceStatus::ok : DeviceStatus::finished;
        });
    };
    const auto scene = felt_scene();
    ServoOptions endless;
    endless.clock = ServoClock::virtual_time;
    ServoThread first(scene, scripted(1, 3), endless), second(scene, scripted(2, 1), endless);
    run_all({&first, &second});
    CHECK(order == std::vector<uint64_t>{1, 2, 1, 2, 1, 1});
    CHECK(first.wait().ticks == 3);
    CHECK(second.wait().ticks == 1);
    CHECK_FALSE(first.running());

    order.clear();
    ServoThread fifth(scene, scripted(5, 1), endless), sixth(scene, scripted(6, 0), endless),
        seventh(scene, scripted(7, 2), endless);
    run_all({&fifth, &sixth, &seventh});
    CHECK(order == std::vector<uint64_t>{5, 6, 7, 5, 7, 7});

    ServoThread third(scene, scripted(3, ~uint64_t{0}), endless), fourth(scene, scripted(4, ~uint64_t{0}), endless);
    ServoTurns turns({&third, &fourth});
    turns.start();
    third.request_stop();
    fourth.request_stop();
    turns.wait();
    CHECK(third.wait().state == ServoState::stopped);
    CHECK(fourth.wait().state == ServoState::stopped);
}
