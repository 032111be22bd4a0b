// A gripper's two fingers against closed forms.
#include "runtime/render/renderer.h"
#include "runtime/servo/servo_thread.h"
#include "tests/runtime/files/scene_folder.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <memory>
#include <random>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

Scene box_for_fingers(double friction = 0)
{
    Mesh box = make_box();
    scale_to_size(box, 0.02);
    Scene scene = bare_scene(box);
    scene.probe.kind = ProbeKind::gripper;
    scene.objects[0].material.static_friction = scene.objects[0].material.dynamic_friction = friction;
    return scene;
}

// Fingers on the x axis, each so far from the middle, and so high.
DevicePose fingers(double apart_m, double z_m = 0, double y_m = 0)
{
    return {{-apart_m, y_m, z_m}, {apart_m, y_m, z_m}};
}

} // namespace

TEST_CASE("a gripper that holds a box feels it between its fingers, and nothing else")
{
    Renderer renderer(shared(box_for_fingers()));
    CHECK(renderer.tick(fingers(0.02)).contacts == 0);
    TickResult felt;
    for (int i = 0; i < 3; ++i) felt = renderer.tick(fingers(0.0085, 0.002, -0.003)); // each 1.5 mm deep
    CHECK(felt.contacts == 1);                                                        // object
    CHECK(std::abs(felt.grip_force_n - 1.5e-3 * spring_n_per_m) < 1e-9);
    CHECK(glm::length(felt.force_n) < 1e-9);
    CHECK(glm::length(felt.torque_n_m) < 1e-11);
    CHECK(glm::length(felt.grip_m - dvec3(0, -0.003, 0.002)) < 1e-15);
    CHECK(renderer.tick(fingers(0.02)).grip_force_n == 0);
}

TEST_CASE("what a gripper has between its fingers is carried by friction: twice one finger's")
{
    Renderer renderer(shared(box_for_fingers(0.5)));
    renderer.tick(fingers(0.02));
    for (int i = 0; i < 3; ++i) renderer.tick(fingers(0.009));
    TickResult felt;
    for (int i = 1; i <= 20; ++i) felt = renderer.tick(fingers(0.009, 1e-5 * i)); // up to 0.2 mm, below 0.5 times 1 mm
    CHECK(glm::length(felt.force_n - dvec3(0, 0, -2 * 0.2e-3 * spring_n_per_m)) < 1e-9);
    CHECK(std::abs(felt.grip_force_n - 1e-3 * spring_n_per_m) < 1e-9);
    CHECK(glm::length(felt.torque_n_m) < 1e-11);
}

TEST_CASE("one finger alone turns the gripper about its middle")
{
    Scene scene = bare_scene(plane_mesh());
    scene.probe.kind = ProbeKind::gripper;
    Renderer renderer(shared(std::move(scene)));
    const auto pose = [](double z_m) { return DevicePose{{0.01, 0, z_m}, {0.01, 0.03, z_m + 0.04}}; };
    renderer.tick(pose(1e-3));
    TickResult felt;
    for (int i = 0; i < 3; ++i) felt = renderer.tick(pose(-1e-3));
    const dvec3 force_n(0, 0, 1e-3 * spring_n_per_m);
    CHECK(glm::length(felt.force_n - force_n) < 1e-9);
    CHECK(glm::length(felt.torque_n_m - glm::cross(dvec3(0, -0.015, -0.02), force_n)) < 1e-11);
    CHECK(std::abs(felt.grip_force_n - -0.5 * 0.8 * force_n.z) < 1e-9); // along (0, 0.6, 0.8), toward the other
}

TEST_CASE("without friction a gripper feels what two points feel, wherever its fingers are")
{
    Mesh star = make_icosphere(3);
    for (std::size_t i = 0; i < star.positions_m.size(); i += 3) star.positions_m[i] *= 0.8;
    scale_to_size(star, 0.1);
    Scene one = bare_scene(star), gripped = bare_scene(star);
    gripped.probe.kind = ProbeKind::gripper;
    const auto points = shared(std::move(one));
    Renderer tip(points), tail(points), gripper(shared(std::move(gripped)));
    std::mt19937 random(3);
    std::normal_distribution<double> step(0, 0.002);
    dvec3 a(0.06, 0, 0), b(-0.06, 0, 0);
    int both = 0;
    for (int i = 0; i < 20000; ++i) {
        for (dvec3* finger : {&a, &b}) {
            *finger = *finger * 0.995 + dvec3(step(random), step(random), step(random));
            if (glm::length(*finger) < 0.02) *finger = 0.07 * glm::normalize(*finger);
        }
        const TickResult felt = gripper.tick({a, b}), at_a = tip.tick({a, a}), at_b = tail.tick({b, b});
        REQUIRE(glm::length(felt.unlimited_force_n - at_a.unlimited_force_n - at_b.unlimited_force_n) < 1e-12);
        both += at_a.contacts > 0 && at_b.contacts > 0;
    }
    CHECK(both > 1000);
}

TEST_CASE("the gripping force is limited, rises from zero, and is zero where the pose is none")
{
    Scene scene = box_for_fingers();
    scene.servo.force_limit_n = 1;
    scene.servo.force_rise_s = 0.01;
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(fingers(0.02));
    double before_n = 0;
    for (int i = 0; i < 20; ++i) {
        const double now_n = renderer.tick(fingers(0.005)).grip_force_n; // 5 N, but for the limit
        CHECK(now_n <= 1);
        CHECK(now_n >= before_n);
        before_n = now_n;
    }
    CHECK(before_n == 1);
    CHECK(renderer.tick({{NAN, 0, 0}, {0.005, 0, 0}}).grip_force_n == 0);
    CHECK(renderer.tick({{-0.005, 0, 0}, {0.005, INFINITY, 0}}).grip_force_n == 0);
    for (int i = 0; i < 20; ++i) before_n = renderer.tick(fingers(0.005)).grip_force_n;
    CHECK(before_n == 1);                                                           // contact kept
    CHECK(std::isfinite(renderer.tick({{0, 0, 0.02}, {0, 0, 0.02}}).grip_force_n)); // fingers in one place
}

TEST_CASE("the gripping force reaches the device, and zero when the run is over")
{
    class Tongs final : public ScriptedDevice {
    public:
        Tongs(Read read, std::shared_ptr<std::vector<double>> written_n)
            : ScriptedDevice(std::move(read)), written_n_(std::move(written_n))
        {
            written_n_->reserve(1000);
        }
        void write_grip(double grip_force_n) noexcept override { written_n_->push_back(grip_force_n); }

    private:
        std::shared_ptr<std::vector<double>> written_n_;
    };
    const auto written_n = std::make_shared<std::vector<double>>();
    const auto close = [](uint64_t tick, DevicePose& pose) {
        pose = fingers(tick == 0 ? 0.02 : 0.0085);
        return DeviceStatus::ok;
    };
    ServoOptions options;
    options.clock = ServoClock::virtual_time;
    options.seconds = 0.01;
    ServoThread servo(shared(box_for_fingers()), std::make_unique<Tongs>(close, written_n), options);
    servo.start();
    servo.wait();
    REQUIRE(written_n->size() == 11);
    CHECK(written_n->front() == 0);
    CHECK(std::abs((*written_n)[9] - 1.5) < 1e-9);
    CHECK(written_n->back() == 0);
}

TEST_CASE("what a gripper's springs take while it closes they give back while it opens")
{
    constexpr int steps = 4000;
    constexpr double depth_m = 2e-3;
    // Moved as a whole meanwhile, so that one finger goes deeper than the other.
    const auto close = [](uint64_t tick, DevicePose& pose) {
        const double share = std::min(1.0, double(tick) / steps);
        pose = fingers(0.0101 - share * (depth_m + 1e-4));
        pose.tip_m.x += 1e-3 * share;
        pose.tail_m.x += 1e-3 * share;
        return DeviceStatus::ok;
    };
    const auto energy_j = [&](const ScriptedDevice::Read& hand, double seconds) {
        ServoOptions options;
        options.clock = ServoClock::virtual_time;
        options.seconds = seconds;
        ServoThread servo(shared(box_for_fingers()), std::make_unique<ScriptedDevice>(hand), options);
        servo.start();
        return servo.wait().energy_j;
    };
    const double taken_j = -energy_j(close, 1e-3 * (steps + 1));
    // One finger is 3 mm deep, the other 1 mm: each stores half of K d^2.
    const double stored_j = 0.5 * spring_n_per_m * (3e-3 * 3e-3 + 1e-3 * 1e-3);
    CHECK(std::abs(taken_j / stored_j - 1) < 1e-3);
    const auto there_and_back = [&](uint64_t tick, DevicePose& pose) {
        return close(tick <= steps ? tick : 2 * steps - std::min(tick, uint64_t(2 * steps)), pose);
    };
    CHECK(std::abs(energy_j(there_and_back, 2e-3 * (steps + 1))) < 2e-3 * stored_j);
}

TEST_CASE("a magnet that pulls one finger does no work on a closed path of a gripper")
{
    constexpr double force_n = 1, reach_m = 5e-3;
    constexpr int steps = 2000;
    // Tip and tail above the plane, metres: down as a whole, up with the tip while the tail comes nearer, up as a whole
    // and open again.
    const glm::dvec2 corners[] = {{6e-3, 60e-3}, {1e-6, 54e-3}, {6e-3, 48e-3}, {12e-3, 54e-3}, {6e-3, 60e-3}};
    const auto energy_j = [&](int sides) {
        Scene scene = magnet_scene(plane_mesh(), force_n, reach_m);
        scene.probe.kind = ProbeKind::gripper;
        const auto hand = [&](uint64_t tick, DevicePose& pose) {
            const auto last = static_cast<uint64_t>(sides * steps);
            const uint64_t at = std::min(tick, last), side = std::min<uint64_t>(at / steps, uint64_t(sides) - 1);
            const glm::dvec2 place = glm::mix(corners[side], corners[side + 1], double(at - side * steps) / steps);
            pose = {{0, 0, place.x}, {0, 0, place.y}};
            return DeviceStatus::ok;
        };
        ServoOptions options;
        options.clock = ServoClock::virtual_time;
        options.seconds = 1e-3 * (sides * steps + 1);
        ServoThread servo(shared(std::move(scene)), std::make_unique<ScriptedDevice>(hand), options);
        servo.start();
        return servo.wait().energy_j;
    };
    const double drawn_j = 2.0 / 3 * force_n * reach_m; // from its reach down to the surface
    CHECK(std::abs(energy_j(1) / drawn_j - 1) < 1e-2);
    CHECK(std::abs(energy_j(4)) < 1e-2 * drawn_j);
}

TEST_CASE("a scene may be felt with a gripper")
{
    Folder folder;
    const LoadedScene loaded =
        load_scene(folder.write("tongs.toml", "[probe]\nkind = \"gripper\"\nlength_m = \"30mm\"\n[[object]]\n"
                                              "shape = \"sphere\"\n"),
                   {}, {});
    REQUIRE(loaded.scene);
    CHECK(loaded.scene->probe.kind == ProbeKind::gripper);
    CHECK(loaded.scene->probe.length_m == 0.03);
    const std::string said =
        load_scene(folder.write("wrong.toml", "[probe]\nkind = \"gripper\"\ngrip_m = 0.01\n[[object]]\n"
                                              "shape = \"sphere\"\n"),
                   {}, {})
            .diagnostics;
    CHECK(said.find("`grip_m` is for `kind = \"stylus\"` alone") != std::string::npos);
}
