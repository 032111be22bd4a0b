// Surfaces that are built anew while a hand presses on them, as after an edit of a scene's file.
#include "runtime/render/renderer.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

Scene scene_of(const ProbeSettings& probe, const Mesh& mesh)
{
    Scene scene = bare_scene(mesh);
    scene.probe = probe;
    return scene;
}

// What is felt of `next` where the hand came to rest in `first`, when nothing fades any more.
TickResult swapped(Renderer& first, const Scene& before, const std::shared_ptr<const Scene>& next,
                   const DevicePose& hand)
{
    Renderer second(next, {}, before);
    second.take_over(first);
    TickResult felt;
    for (int i = 0; i < 20; ++i) felt = second.tick(hand);
    return felt;
}

} // namespace

TEST_CASE("surfaces built anew as they were are felt as they were, by any probe")
{
    std::mt19937_64 random(7);
    const auto uniform = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    const ProbeSettings probes[] = {{ProbeKind::point, 0.1}, {ProbeKind::sphere, 0.1, 2e-3}, {ProbeKind::stylus, 0.1}};
    for (const ProbeSettings& probe : probes)
        for (const char* name : {"icosphere", "box", "torus"}) {
            const Mesh mesh = shape(name, 0.05);
            const auto scene = shared(scene_of(probe, mesh)), anew = shared(scene_of(probe, mesh));
            int pressed = 0, otherwise = 0;
            for (int trial = 0; trial < 200; ++trial) {
                const dvec3 out = glm::normalize(dvec3(uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)));
                const dvec3 axis =
                    glm::normalize(glm::cross(out, dvec3(uniform(-1, 1), uniform(-1, 1), 0.3)) + uniform(0, 1) * out);
                const dvec3 from = out * uniform(0.018, 0.027) - uniform(0, 0.06) * axis;
                Renderer renderer(scene);
                TickResult felt;
                DevicePose hand;
                for (int i = 0; i <= 100; ++i) {
                    hand.tip_m = from + 5e-4 * (100 - i) * out;
                    hand.tail_m = hand.tip_m + 0.1 * axis;
                    felt = renderer.tick(hand);
                }
                const double force_n = glm::length(felt.force_n);
                if (force_n < 0.2 || force_n > 7) continue;
                ++pressed;
                const TickResult after = swapped(renderer, *scene, anew, hand);
                CAPTURE(int(probe.kind), name, trial, force_n);
                CHECK(after.contacts == 1);
                otherwise += !(glm::distance(after.force_n, felt.force_n) < 1e-3 * force_n);
            }
            CAPTURE(int(probe.kind), name, pressed, otherwise);
            // A shaft may come to rest on an edge beside the one that held it.
            CHECK(otherwise <= (probe.kind == ProbeKind::stylus ? pressed / 50 : 0));
            CHECK(pressed > 5);
        }
}

// A hand wanders about, 2 mm deep; of many renderers that follow it each is taken over from at another time.
TEST_CASE("a star of narrow pits and spikes built anew holds the probe where it did")
{
    constexpr double size_m = 0.1, length_m = 0.05, deepest_m = 2e-3, speed_m = 1e-4;
    constexpr int ticks = 4000, between = 100;
    Mesh mesh = haptel::test::make_star(3);
    scale_to_size(mesh, size_m);
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::stylus, ProbeKind::gripper}) {
        if (haptel::test::is_sanitized && kind != ProbeKind::stylus) continue;
        const ProbeSettings probe{kind, length_m};
        const auto scene = shared(scene_of(probe, mesh)), anew = shared(scene_of(probe, mesh));
        std::mt19937_64 random(9);
        std::normal_distribution<double> normal;
        const auto any = [&] { return dvec3(normal(random), normal(random), normal(random)); };
        std::vector<std::unique_ptr<Renderer>> followers;
        for (int i = 0; i <= ticks / between; ++i) followers.push_back(std::make_unique<Renderer>(scene));
        const dvec3 from = glm::normalize(any());
        dvec3 middle = 0.7 * size_m * from, heading = -from, axis = glm::normalize(glm::cross(from, any()));
        int pressed = 0, lost = 0, elsewhere = 0;
        for (int tick = 0; tick < ticks; ++tick) {
            const dvec3 home = -10.0 * std::max(0.0, glm::length(middle) - 0.35 * size_m) * middle;
            heading = glm::normalize(heading + 0.02 * any() + home);
            middle += speed_m * heading;
            axis = glm::normalize(axis + 2e-3 * any());
            const DevicePose hand{middle - 0.5 * length_m * axis, middle + 0.5 * length_m * axis};
            TickResult felt;
            for (auto& follower : followers)
                if (follower) felt = follower->tick(hand);
            if (tick % between == between - 1) {
                const auto first = std::move(followers[static_cast<std::size_t>(tick / between)]);
                if (felt.contacts == 0) continue;
                ++pressed;
                const TickResult after = swapped(*first, *scene, anew, hand);
                lost += after.contacts == 0;
                elsewhere += glm::distance(after.unlimited_force_n, felt.unlimited_force_n) > 1;
            }
            const double depth_m = glm::length(felt.unlimited_force_n) / 1000;
            if (depth_m > deepest_m) middle += (1 - deepest_m / depth_m) / 1000 * felt.unlimited_force_n;
        }
        CAPTURE(int(kind), pressed, lost, elsewhere);
        CHECK(pressed > 20);
        CHECK(lost == 0);
        CHECK(elsewhere == 0);
    }
}

TEST_CASE("a floor and a wall built anew both hold on, though each of them holds the probe inside the other")
{
    Mesh floor = make_box({0.2, 0.2, 0.02}), wall = make_box({0.02, 0.2, 0.2});
    for (const ProbeSettings& probe : {ProbeSettings{ProbeKind::point}, ProbeSettings{ProbeKind::sphere, 0.1, 2e-3}}) {
        const auto corner = [&] {
            Scene scene = scene_of(probe, floor); // its top at z = 0.01
            scene.objects.push_back(scene_of(probe, wall).objects[0]);
            scene.objects[1].placement.position_m = {0.05, 0, 0}; // its side at x = 0.04
            return shared(std::move(scene));
        };
        const auto scene = corner(), anew = corner();
        const double r = probe.radius_m;
        for (const double deep : {0.5e-3, 1e-3, 2e-3}) {
            Renderer renderer(scene);
            DevicePose hand;
            for (int i = 0; i <= 100; ++i) {
                const double away = 1e-4 * (100 - i);
                hand.tip_m = hand.tail_m = {0.04 - r + 1e-3 - away, 0.01, 0.01 + r - deep + away};
                renderer.tick(hand);
            }
            const TickResult felt = swapped(renderer, *scene, anew, hand);
            CAPTURE(int(probe.kind), deep);
            CHECK(felt.contacts == 2);
            CHECK(glm::distance(felt.force_n, dvec3(-1, 0, 1000 * deep)) < 1e-6);
        }
    }
}

TEST_CASE("both fingers go on holding what has grown or moved a little")
{
    const auto held = [](double size_m, double up_m) {
        Scene scene = scene_of({ProbeKind::gripper, 0.1}, make_box(dvec3(size_m)));
        scene.objects[0].placement.position_m.z = up_m;
        return shared(std::move(scene));
    };
    const auto scene = held(0.05, 0);
    for (const auto& [size_m, up_m] : {std::pair{0.05, 0.0}, {0.0501, 0.0}, {0.0515, 0.0}, {0.05, 0.9e-3}}) {
        Renderer renderer(scene);
        DevicePose hand;
        for (int i = 0; i <= 100; ++i) {
            const double z = 0.023 + 1e-4 * (100 - i);
            hand = {{-0.005, 0.001, z}, {-0.005, 0.001, -z}};
            renderer.tick(hand);
        }
        const TickResult felt = swapped(renderer, *scene, held(size_m, up_m), hand);
        const double top_m = 0.5 * size_m + up_m - 0.023, bottom_m = 0.5 * size_m - up_m - 0.023;
        CAPTURE(size_m, up_m);
        CHECK(std::abs(felt.grip_force_n - 500 * (top_m + bottom_m)) < 1e-6);
        CHECK(glm::distance(felt.force_n, dvec3(0, 0, 1000 * (top_m - bottom_m))) < 1e-6);
    }
}

// What a ball feels of a box, or of a vertex, is in closed form: by how much it reaches below the nearest point.
TEST_CASE("a ball pushes with its whole radius against a surface that has grown under it")
{
    const double r = 2e-3, deep = 0.3e-3, size_m = 0.05;
    const ProbeSettings probe{ProbeKind::sphere, 0.1, r};
    std::mt19937_64 random(3);
    const auto uniform = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    const auto in_box = [](double size, const dvec3& p) {
        return glm::clamp(p, dvec3(-0.5 * size), dvec3(0.5 * size));
    };
    const Mesh ball = shape("icosphere", size_m);
    const double share = glm::length(ball.positions_m[0]) / size_m; // of that vertex
    for (const double grown_m : {0.0, 5e-6, 50e-6, 0.5e-3, 0.99e-3})
        for (int trial = 0; trial < 10; ++trial) {
            const bool on_box = trial > 0; // on its sides, edges and corners
            const auto surface = [&](double size) { return on_box ? make_box(dvec3(size)) : shape("icosphere", size); };
            const auto nearest = [&](double size, const dvec3& p) {
                return on_box ? in_box(size, p) : share * size * glm::normalize(p);
            };
            const double larger_m = size_m + (on_box ? 2 * grown_m / std::sqrt(3.0) : grown_m / share); // or a corner
            Scene first = scene_of(probe, surface(size_m)), second = scene_of(probe, surface(larger_m));
            first.servo.force_rise_s = second.servo.force_rise_s = 0.1;
            const auto scene = shared(std::move(first)), anew = shared(std::move(second));

            dvec3 at = 0.03 * glm::normalize(ball.positions_m[0]);
            while (on_box && (at = dvec3(uniform(-0.03, 0.03), uniform(-0.03, 0.03), uniform(0.026, 0.03)),
                              in_box(size_m, at) == at)) {
            }
            const dvec3 foot = nearest(size_m, at), out = glm::normalize(at - foot);
            Renderer renderer(scene);
            DevicePose hand;
            TickResult felt;
            for (int i = 0; i <= 300; ++i) {
                hand.tip_m = hand.tail_m = foot + (r - deep + 1e-5 * std::max(0, 100 - i)) * out;
                felt = renderer.tick(hand);
            }
            CAPTURE(on_box, grown_m, at.x, at.y, at.z);
            CHECK(glm::distance(felt.force_n, 1000 * deep * out) < 1e-6);

            Renderer next(anew, {}, *scene);
            next.take_over(renderer);
            const dvec3 off = hand.tip_m - nearest(larger_m, hand.tip_m);
            const dvec3 whole_n = 1000 * (r - glm::length(off)) * glm::normalize(off);
            for (int i = 0; i < 150; ++i) {
                felt = next.tick(hand);
                const double risen = std::min(1.0, i / 100.0); // over force_rise_s, without a step
                CHECK(glm::distance(felt.force_n, (1 - risen) * 1000 * deep * out + risen * whole_n) < 1e-6);
            }
        }
}
