// A hand that reaches into a larger, turned or shifted scene: what it feels, and what that does with energy.
#include "runtime/render/renderer.h"
#include "tests/runtime/render/swap_stage.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <numbers>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

Workspace turned(double scale)
{
    const double c = std::cos(0.4), s = std::sin(0.4);
    Workspace workspace;
    workspace.scale = scale;
    workspace.placement.rotation = glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c) * glm::dmat3(0, 1, 0, 0, 0, 1, 1, 0, 0);
    workspace.placement.position_m = {0.3, -0.2, 0.1};
    return workspace;
}

HandSettings through(const Workspace& workspace)
{
    HandSettings hand;
    hand.workspace = workspace;
    return hand;
}

// All that can be felt, with every length times `scale`, put where the workspace has its origin and axes.
Scene world(double scale, const Placement& placement, ProbeKind probe)
{
    Mesh mesh = make_torus(0.4, 48, 24);
    scale_to_size(mesh, 0.1 * scale);
    const double wave = 2 * std::numbers::pi / (3e-3 * scale), amplitude_m = 40e-6 * scale;
    Scene scene = bare_scene(mesh, lambda_texture(
                                       [=](const haptel_point& point, glm::dvec3& gradient) {
                                           gradient = {amplitude_m * wave * std::cos(wave * point.p[0]), 0, 0};
                                           return amplitude_m * std::sin(wave * point.p[0]);
                                       },
                                       -amplitude_m, amplitude_m));
    SceneObject& object = scene.objects[0];
    object.placement = placement;
    object.material = {700, 2, 0.4, 0.3};
    object.effects.magnet = {0.8, 5e-3 * scale};
    object.effects.damping_n_s_per_m = 1.5;
    object.effects.damping_reach_m = 8e-3 * scale;
    object.effects.vibration = {0.2, 70, {0, 0.6, 0.8}};
    Region region;
    region.shape = RegionShape::ball;
    region.half_sides_m = glm::dvec3(0.06 * scale);
    region.edge_m = 0.01 * scale;
    region.placement = placement;
    region.damping_n_s_per_m = 1;
    scene.regions.push_back(region);
    scene.probe = {probe, 0.1 * scale, probe == ProbeKind::sphere ? 3e-3 * scale : 0};
    scene.servo.force_limit_n = 3;
    scene.servo.force_rise_s = 0.05;
    return scene;
}

} // namespace

TEST_CASE("a workspace takes places there and back, and turns directions")
{
    const Workspace workspace = turned(4);
    CHECK(workspace.moves());
    CHECK_FALSE(Workspace().moves());
    const glm::dvec3 p(0.01, -0.02, 0.05), q(0.03, 0.01, -0.01);
    CHECK(glm::distance(workspace.to_hand(workspace.to_scene(p)), p) < 1e-15);
    CHECK(std::abs(glm::distance(workspace.to_scene(p), workspace.to_scene(q)) - 4 * glm::distance(p, q)) < 1e-15);
    CHECK(glm::distance(workspace.direction_to_hand(workspace.to_scene(p) - workspace.to_scene(q)), 4.0 * (p - q)) <
          1e-15);
}

TEST_CASE("the hand feels the stiffness and the damping that are written, whatever the scale")
{
    for (const double scale : {0.01, 1.0, 2.5, 100.0}) {
        Scene scene = bare_scene(plane_mesh(0.1 * scale));
        scene.objects[0].material = {800, 5, 0, 0};
        Workspace workspace;
        workspace.scale = scale;
        workspace.placement.position_m = {0, 0, 0.5 * scale};
        Renderer renderer(shared(std::move(scene)), through(workspace));
        glm::dvec3 force(0);
        constexpr double speed = 0.01;
        for (int i = 0; i < 400; ++i) {
            const double z = -0.499 - i * speed * 1e-3;
            force = renderer.tick(at(0.01, 0.02, z)).force_n;
            const double depth_m = -0.5 - z;
            if (depth_m > 2e-3) CHECK(std::abs(force.z - (800 * depth_m + 5 * speed)) < 1e-6);
        }
        CHECK(force.z > 2);
        CHECK(std::hypot(force.x, force.y) < 1e-9);
    }
}

TEST_CASE("a world twice as large, seen through a scale of two, is the same to the hand")
{
    for (const ProbeKind probe : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus})
        for (const double scale : {4.0, 0.25}) { // powers of two: the meshes are the same to the last bit
            const Workspace workspace = turned(scale);
            Renderer plain(shared(world(1, {}, probe)));
            Renderer scaled(shared(world(scale, workspace.placement, probe)), through(workspace));
            std::mt19937 random(4);
            std::normal_distribution<double> step(0, 1.5e-4);
            glm::dvec3 tip(0.055, 0, 0.001);
            double worst_n = 0, largest_n = 0, in_contact = 0;
            for (int i = 0; i < 4000; ++i) {
                tip += glm::dvec3(step(random), step(random), step(random)) + 2e-3 * (glm::dvec3(0.045, 0, 0) - tip);
                const DevicePose pose{tip, tip + glm::dvec3(0, -0.02, 0.09)};
                const TickResult a = plain.tick(pose), b = scaled.tick(pose);
                worst_n = std::max(worst_n, glm::distance(a.force_n, b.force_n));
                largest_n = std::max(largest_n, glm::length(a.force_n));
                in_contact += a.contacts > 0;
                CHECK(a.contacts == b.contacts);
                CHECK((glm::distance(a.normal, b.normal) < 1e-5 || probe == ProbeKind::sphere));
                CHECK(std::abs(scale * a.depth_m - b.depth_m) < 1e-9 * scale);
            }
            CAPTURE(static_cast<int>(probe), scale, worst_n, largest_n, in_contact);
            CHECK(largest_n > 1);
            CHECK((in_contact > 500 && in_contact < 3900));
            // The turn is rounded, and friction and creases decide: of a ball by how it goes over edges.
            CHECK(worst_n < (probe == ProbeKind::sphere ? 1e-2 : 1e-5));
        }
}

// Half a millimetre of the hand is a nudge: the plate takes along what friction holds on it, which draws the hand by as
// much. Two millimetres are another plate, on which the hand is put down.
TEST_CASE("whether an object was moved under the hand is said in millimetres of the hand")
{
    for (const double scale : {0.25, 1.0, 4.0})
        for (const double moved_m : {0.5e-3, 2e-3}) {
            Scene scene = plane_scene();
            scene.objects[0].surface = build_surface(plane_mesh(0.1 * scale)).surface;
            scene.objects[0].material = {1000, 0, 0.8, 0.8};
            Scene after = same_as(scene);
            after.objects[0].placement.position_m.x = moved_m * scale;
            HandSettings hand;
            hand.workspace.scale = scale;
            Stage stage(shared(std::move(scene)), hand);
            stage.press(1e-3, 1);
            stage.press(-3e-3, 200);
            stage.slot.publish(shared(std::move(after)));
            const glm::dvec3 force = stage.press(-3e-3, 200).force_n;
            CAPTURE(scale, moved_m);
            CHECK(std::abs(force.z - 3) < 1e-6);
            CHECK(std::abs(force.x - (moved_m < 1e-3 ? 1000 * moved_m : 0)) < 1e-6);
        }
}

TEST_CASE("a closed path through a scaled scene gives the hand no energy")
{
    double last_j = 0;
    for (const int steps : {2000, 4000, 8000}) {
        Mesh mesh = make_icosphere(5);
        scale_to_size(mesh, 0.5);
        Scene scene = bare_scene(mesh);
        scene.objects[0].effects.magnet = {1, 0.05};
        Workspace workspace = turned(5);
        scene.objects[0].placement = workspace.placement;
        Renderer renderer(shared(std::move(scene)), through(workspace));
        double given_j = 0, held_j = 0;
        glm::dvec3 last_m(0), force_n(0);
        for (int i = 0; i <= steps; ++i) { // 5 mm out of the ball of 50 mm and 2 mm into it, three times
            const double t = 2 * std::numbers::pi * i / steps, r = 0.0515 + 0.0035 * std::sin(3 * t);
            const glm::dvec3 p(r * std::cos(0.3 * std::sin(t)), r * std::sin(0.3 * std::sin(t)), 0.003 * std::sin(t));
            if (i == 0) renderer.tick({glm::dvec3(0.08, 0, 0), glm::dvec3(0.08, 0, 0)});
            if (i > 0) {
                given_j += glm::dot(force_n, p - last_m);
                held_j += 1000 / 2.0 * glm::dot(p - last_m, p - last_m); // what holding a spring's force may give
            }
            last_m = p;
            force_n = renderer.tick({p, p}).force_n;
        }
        CAPTURE(steps, given_j, last_j, held_j);
        if (last_j != 0) CHECK(std::abs(given_j / last_j - 0.5) < 0.1);
        CHECK(given_j <= held_j);
        last_j = given_j;
    }
}

TEST_CASE("a probe of its own is what a hand touches with")
{
    HandSettings ball;
    ball.probe = ProbeSettings{ProbeKind::sphere, 0, 2e-3};
    const auto scene = shared(bare_scene(plane_mesh()));
    Renderer point(scene), sphere(scene, ball);
    for (const double z : {5e-3, 1e-3}) {
        const TickResult a = point.tick(at(0, 0, z)), b = sphere.tick(at(0, 0, z));
        CHECK(a.force_n.z == 0);
        CHECK(std::abs(b.force_n.z - 1000 * std::max(0.0, 2e-3 - z)) < 1e-8);
    }
}
