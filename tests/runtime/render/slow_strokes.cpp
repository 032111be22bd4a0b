// How much a slow and smooth hand changes what it feels. A spring that follows the hand changes by the stiffness times
// the hand's way; what changes by more is felt as a click.
#include "runtime/render/renderer.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double way_m = 5e-5, pressed_m = 0.5e-3; // 0.05 m/s at 1 kHz

struct Probe {
    const char* name;
    ProbeSettings settings;
};
const Probe probes[] = {{"point", {}},
                        {"ball", {ProbeKind::sphere, 0, 2.5e-3}},
                        {"stylus", {ProbeKind::stylus, 0.15, 0}},
                        {"gripper", {ProbeKind::gripper, 0.02, 0}}};

// Strokes of 2 cm from places all over the mesh, at the depth that the hand feels. Returns for each tick the change of
// the force over the stiffness times the hand's way, rising.
std::vector<double> strokes(const Mesh& mesh, const Probe& probe, double friction, int ticks)
{
    Scene scene = bare_scene(mesh);
    scene.probe = probe.settings;
    scene.objects[0].material.static_friction = scene.objects[0].material.dynamic_friction = friction;
    const double stiffness = scene.objects[0].material.stiffness_n_per_m, radius = probe.settings.radius_m;
    const auto surface = scene.objects[0].surface;
    Renderer renderer(shared(std::move(scene)));
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const auto any = [&] { return glm::normalize(dvec3(normal(random), normal(random), normal(random))); };
    std::vector<double> changes;
    while (std::ssize(changes) < ticks) {
        const auto face = static_cast<uint32_t>(random() % surface->faces.size());
        const dvec3 out = surface->facet_normal(face, 0);
        const dvec3 middle =
            (surface->vertex_m(face, 0) + surface->vertex_m(face, 1) + surface->vertex_m(face, 2)) / 3.0;
        dvec3 along = any(), smooth = out, hand = middle + (1e-3 + radius) * out;
        const dvec3 tail = probe.settings.kind == ProbeKind::gripper ? 0.02 * glm::normalize(glm::cross(out, along))
                                                                     : 0.15 * glm::normalize(out + 0.7 * any());
        const auto tick = [&] {
            const dvec3 force = renderer.tick({hand, hand + tail}).unlimited_force_n;
            renderer.between_ticks();
            return force;
        };
        tick();
        for (double height = 1e-3; height > -pressed_m; height -= way_m, hand -= way_m * out) tick();
        dvec3 force = tick(), hand_before = hand;
        for (int i = 0; i < 400 && std::ssize(changes) < ticks; ++i) {
            const double depth = glm::length(force) / stiffness;
            if (depth == 0 || depth > 4 * pressed_m) break; // it has left, or the gripper has taken hold
            smooth = glm::normalize(0.95 * smooth + 0.05 * force / (stiffness * depth));
            along = glm::normalize(along - glm::dot(along, smooth) * smooth);
            hand += way_m * along + 0.05 * (depth - pressed_m) * smooth;
            const dvec3 now = tick();
            const double way = (probe.settings.has_tail() ? std::sqrt(2.0) : 1) * glm::distance(hand, hand_before);
            if (i > 2) changes.push_back(glm::distance(now, force) / (stiffness * way));
            force = now;
            hand_before = hand;
        }
        hand = 10.0 * out;
        tick();
    }
    std::sort(changes.begin(), changes.end());
    return changes;
}

// Valleys and ridges at every edge.
Mesh make_rough_ball()
{
    Mesh mesh = make_icosphere(5);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> height(0, 0.035);
    for (dvec3& at : mesh.positions_m) at *= 1 + height(random);
    return mesh;
}

} // namespace

TEST_CASE("a slow stroke changes the force by twice the spring's change at most, but for one tick of a thousand")
{
    Mesh bumpy = haptel::test::make_bumpy_sphere(5), torus = make_torus(0.4, 96, 48);
    for (Mesh* mesh : {&bumpy, &torus}) scale_to_size(*mesh, 0.1);
    for (const Mesh& mesh : {bumpy, torus})
        for (const Probe& probe : probes)
            for (const double friction : {0.0, 0.3}) {
                if (haptel::test::is_sanitized && (friction == 0) == (&probe == &probes[0])) continue;
                const std::vector<double> changes = strokes(mesh, probe, friction, 40'000);
                const auto share = [&](double of) { return changes[static_cast<std::size_t>(of * 39'999)]; };
                CAPTURE(mesh.triangles.size(), probe.name, friction, share(0.5), share(0.99), changes.back());
                CHECK(share(0.999) < 2);
                CHECK(share(0.9999) < 10);
                CHECK(share(0.99) > 0.01); // it does feel the mesh
            }
}

TEST_CASE("in rough valleys friction makes the force of a ball no more uneven")
{
    Mesh rough = make_rough_ball();
    scale_to_size(rough, 0.1);
    const auto at_999 = [&](double friction) { return strokes(rough, probes[1], friction, 40'000)[39'960]; };
    const double without = at_999(0), with = at_999(0.3);
    CAPTURE(without, with);
    CHECK(with < 1.5 * without); // where walls swap their shading it is more than twice that
}
