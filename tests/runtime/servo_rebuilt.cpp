// Surfaces that are built anew while a hand presses on them, as after an edit of a scene's file.
#include "runtime/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <random>
#include <string>

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
