// Scenes that a program builds: held to the rules of those from files, in the same words, and never felt if they break
// one.
#include "runtime/scene/validation.h"
#include "runtime/render/renderer.h"
#include "runtime/servo/servo_thread.h"
#include "tests/runtime/files/scene_folder.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();

struct Fault {
    std::function<void(Scene&)> make;
    std::string told;
};

std::shared_ptr<const Motion> turning(const Placement& start, double spin_rad_per_s)
{
    return std::make_shared<SteadyMotion>(start, SteadyMotion::Figures{{0, 0, 1}, spin_rad_per_s, {}, 0});
}

const std::vector<Fault>& faults()
{
    static const Placement skewed{glm::dmat3(1, 0, 0, 0.5, 1, 0, 0, 0, 1), {}},
        mirrored{glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), {}}, grown{glm::dmat3(2), {}};
    static const std::string no_rotation =
        "the rotation is not one: its columns must be unit vectors at right angles to each other, right-handed";
    static const std::vector<Fault> all = {
        {[](Scene& s) { s.servo.force_limit_n = -2; }, "servo: `force_limit_n` must be above 0 up to 100, found -2"},
        {[](Scene& s) { s.servo.force_limit_n = no_number; },
         "servo: `force_limit_n` must be above 0 up to 100, found nan"},
        {[](Scene& s) { s.servo.rate_hz = 0; }, "servo: `rate_hz` must be from 10 to 100000, found 0"},
        {[](Scene& s) { s.servo.rate_hz = -1000; }, "servo: `rate_hz` must be from 10 to 100000, found -1000"},
        {[](Scene& s) { s.servo.rate_hz = infinity; }, "servo: `rate_hz` must be from 10 to 100000, found inf"},
        {[](Scene& s) { s.servo.force_rise_s = -1; }, "servo: `force_rise_s` must be from 0 to 10, found -1"},
        {[](Scene& s) { s.servo.force.model = static_cast<ForceModel>(9); }, "servo: unknown `force_model`"},
        {[](Scene& s) { s.probe = {ProbeKind::sphere, 0.1, 0}; },
         "probe: a sphere needs a radius: write `radius_m = 0.005`, or `kind = \"point\"`"},
        {[](Scene& s) { s.probe = {ProbeKind::sphere, 0.1, no_number}; },
         "probe: `radius_m` must be from 0 to 10, found nan"},
        {[](Scene& s) { s.probe = {ProbeKind::sphere, 0.1, 1}; },
         "object 1 (`test object`): the probe's `radius_m` is larger than `test object`: at most the largest side of "
         "its "
         "box"},
        {[](Scene& s) { s.probe.kind = static_cast<ProbeKind>(7); }, "probe: unknown `kind`"},
        {[](Scene& s) { s.objects[0].surface = nullptr; },
         "object 1 (`test object`): there is no surface: build_surface() says why"},
        {[](Scene& s) { s.objects[0].surface = std::make_shared<Surface>(); },
         "object 1 (`test object`): there is no surface: build_surface() says why"},
        {[](Scene& s) { s.objects[0].texture = nullptr; },
         "object 1 (`test object`): there is no slot for a texture: an object without one has an empty slot"},
        {[](Scene& s) { s.objects[0].placement = skewed; }, "object 1 (`test object`): " + no_rotation},
        {[](Scene& s) { s.objects[0].placement = mirrored; }, "object 1 (`test object`): " + no_rotation},
        {[](Scene& s) { s.objects[0].placement = grown; }, "object 1 (`test object`): " + no_rotation},
        {[](Scene& s) { s.objects[0].placement.position_m.y = no_number; },
         "object 1 (`test object`): `position_m` must be from -1000 to 1000, found nan"},
        {[](Scene& s) { s.objects[0].motion = turning(grown, 1); }, "object 1 (`test object`): " + no_rotation},
        {[](Scene& s) { s.objects[0].motion = std::make_shared<LivePlacement>(mirrored); },
         "object 1 (`test object`): where its motion begins " + no_rotation},
        {[](Scene& s) { s.objects[0].motion = turning({}, 4000); },
         "object 1 (`test object`): `spin_deg_per_s` must be below half a turn in a tick at the servo's `rate_hz`, so "
         "below 180000 about all axes together: at that rate faster turns are felt as slower ones. Lower it, or raise "
         "`rate_hz`"},
        {[](Scene& s) { s.objects[0].material.stiffness_n_per_m = no_number; },
         "object 1 (`test object`): `stiffness_n_per_m` must be above 0 up to 1000000, found nan"},
        {[](Scene& s) { s.objects[0].material.damping_n_s_per_m = -1; },
         "object 1 (`test object`): `damping_n_s_per_m` must be from 0 to 10000, found -1"},
        {[](Scene& s) { s.objects[0].material.dynamic_friction = 0.5; },
         "object 1 (`test object`): `dynamic_friction` must not exceed `static_friction`: a surface that slides harder "
         "than it sticks chatters"},
        {[](Scene& s) { s.objects[0].effects.magnet = {1, 0}; },
         "object 1 (`test object`): `reach_m` must be above 0 up to 1000, found 0"},
        {[](Scene& s) { s.objects[0].effects.vibration = {1, 600, {0, 0, 1}}; },
         "object 1 (`test object`): `frequency_hz` must be below half of the servo's `rate_hz`, so below 500: at that "
         "rate faster swings are felt as slower ones. Lower it, or raise `rate_hz`"},
        {[](Scene& s) { s.objects[0].effects.vibration = {1, 60, {0, 0, 2}}; },
         "object 1 (`test object`): the `direction` of a vibration must be a unit vector, and is 2 long"},
        {[](Scene& s) { s.regions.emplace_back().damping_n_s_per_m = -3; },
         "region 1: `damping_n_s_per_m` must be from 0 to 1000, found -3"},
        {[](Scene& s) { s.regions.push_back({RegionShape::ball, {}, glm::dvec3(0.01), 0.02, 3, {}}); },
         "region 1: `edge_m` must be at most 0.01, half of the region's smallest side: beyond that its effects are "
         "nowhere felt in full"},
        {[](Scene& s) { s.joined.push_back({s.objects[0].surface, {0, 7}}); },
         "joined objects 1: there is no object 8\njoined objects 1: the surface does not say which of its faces are of "
         "which object: join() makes one that does"},
    };
    return all;
}

} // namespace

TEST_CASE("a scene that breaks a rule is told by it, and none of its ticks has a force")
{
    const Scene good = bare_scene(plane_mesh());
    CHECK(validate(&good).empty());
    for (const Fault& fault : faults()) {
        Scene scene = good;
        fault.make(scene);
        CHECK(validate(&scene) == fault.told);
        Renderer renderer(shared(std::move(scene)));
        CHECK(renderer.refused() == fault.told);
        for (const double z : {1e-3, -3e-3, -3e-3}) {
            const TickResult felt = renderer.tick(at(0, 0, z));
            CHECK(felt.force_n == glm::dvec3(0));
            CHECK(felt.faults == fault_scene_refused);
        }
    }
    CHECK(validate(nullptr) == "there is no scene");
    CHECK(Renderer(nullptr).tick(at(0, 0, 0)).faults == fault_scene_refused);
}

TEST_CASE("a hand that breaks a rule feels nothing")
{
    const auto scene = shared(bare_scene(plane_mesh()));
    HandSettings hand;
    hand.workspace.scale = 0;
    CHECK(Renderer(scene, hand).refused() == "hand: `scale` must be from 0.001 to 1000, found 0");
    hand = {.force_max_n = -1};
    CHECK(Renderer(scene, hand).refused() == "hand: `force_max_n` must be at least 0, found -1");
    hand = {.probe = ProbeSettings{ProbeKind::stylus, -0.1}};
    CHECK(Renderer(scene, hand).refused() == "probe: `length_m` must be above 0 up to 10, found -0.1");
}

TEST_CASE("a servo ends before its first tick with a scene that breaks a rule, and goes on with the one it has")
{
    for (const Fault& fault : faults()) {
        Scene scene = bare_scene(plane_mesh());
        const auto good = shared(scene);
        fault.make(scene);
        const auto broken = shared(std::move(scene));
        for (const bool turns : {false, true}) {
            auto seen = std::make_shared<ScriptedDevice::Seen>();
            const auto pressed = [](uint64_t tick, DevicePose& pose) {
                pose = at(0, 0, tick == 0 ? 1e-3 : -1e-3);
                return DeviceStatus::ok;
            };
            ServoOptions options;
            options.clock = turns ? ServoClock::virtual_time : ServoClock::wall;
            options.seconds = 0.01;
            ServoThread servo(broken, std::make_unique<ScriptedDevice>(pressed, seen), options);
            servo.start();
            const ServoReport& report = servo.wait();
            CHECK(report.state == ServoState::faulted);
            CHECK(report.stop_reason == "the scene is refused:\n" + fault.told);
            CHECK(report.ticks == 0);
            CHECK(seen->last_force_n == glm::dvec3(0));
            CHECK(seen->stopped);

            ServoThread felt(good, std::make_unique<ScriptedDevice>(pressed), options);
            CHECK(felt.publish(broken) == fault.told);
            CHECK(felt.publish(nullptr) == "there is no scene");
            felt.start();
            CHECK(std::abs(felt.wait().force_max_n - 1) < 1e-9);
            CHECK(felt.wait().scenes_swapped == 0);
        }
    }
}

TEST_CASE("many faults are told up to a number, and counted")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects.assign(1000, scene.objects[0]);
    for (SceneObject& object : scene.objects) object.material.stiffness_n_per_m = 0;
    const std::string told = validate(&scene);
    CHECK(told.starts_with("object 1 (`test object`): `stiffness_n_per_m` must be above 0 up to 1000000, found 0\n"));
    CHECK(told.ends_with("\nand 980 more"));
}

TEST_CASE("a file is told in the words in which a program is")
{
    const auto object = [](const std::string& keys) { return "[[object]]\nshape = \"plane\"\n" + keys; };
    const std::pair<std::string, std::function<void(Scene&)>> same[] = {
        {"[servo]\nrate_hz = 0\n" + object(""), [](Scene& s) { s.servo.rate_hz = 0; }},
        {"[servo]\nforce_limit_n = -2\n" + object(""), [](Scene& s) { s.servo.force_limit_n = -2; }},
        {"[servo]\nv_max_m_per_s = nan\n" + object(""), [](Scene& s) { s.servo.v_max_m_per_s = no_number; }},
        {"[probe]\nkind = \"sphere\"\n" + object(""), [](Scene& s) { s.probe = {ProbeKind::sphere, 0.15, 0}; }},
        {"[probe]\nkind = \"stylus\"\nlength_m = 0\n" + object(""), [](Scene& s) { s.probe = {ProbeKind::stylus, 0}; }},
        {object("stiffness_n_per_m = -5\n"), [](Scene& s) { s.objects[0].material.stiffness_n_per_m = -5; }},
        {object("static_friction = 0.1\ndynamic_friction = 0.5\n"),
         [](Scene& s) { s.objects[0].material = {800, 1, 0.1, 0.5}; }},
        {object("position_m = [0, 2000, 0]\n"), [](Scene& s) { s.objects[0].placement.position_m.y = 2000; }},
        {object("magnet = { force_n = 200, reach_m = 0.01 }\n"),
         [](Scene& s) { s.objects[0].effects.magnet = {200, 0.01}; }},
        {object("vibration = { force_n = 1, frequency_hz = 600 }\n"),
         [](Scene& s) { s.objects[0].effects.vibration = {1, 600, {0, 0, 1}}; }},
        {object("spin_deg_per_s = [0, 0, 20000]\n[servo]\nrate_hz = 100\n"),
         [](Scene& s) { s.servo.rate_hz = 100, s.objects[0].motion = turning({}, glm::radians(20000.0)); }},
    };
    for (const auto& [file, make] : same) {
        Scene scene = bare_scene(plane_mesh());
        make(scene);
        const std::string told = validate(&scene), by_file = diagnostics_of(file);
        CAPTURE(by_file, told);
        const std::string why = told.substr(told.find(": ") + 2);
        CHECK(by_file.ends_with(": error: " + why + "\n"));
    }
}
