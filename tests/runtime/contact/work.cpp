// What a tick looks at does not grow with the mesh or the scene: counted, not timed.
#include "runtime/contact/probe_contact.h"
#include "runtime/contact/sphere_contact.h"
#include "runtime/render/renderer.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

// A ball is put on a bumpy one of radius 1, a fifth of it large, and goes over it: triangles and groups looked at.
double seen_by_ball(uint32_t subdivisions)
{
    const auto surface = test::surface_of(test::make_bumpy_sphere(subdivisions));
    constexpr double radius = 0.2;
    SphereContact ball(surface, radius);
    const auto place = [&](int i, double over) {
        const glm::dvec3 d(std::cos(1e-3 * i), std::sin(1e-3 * i), 0);
        return d * (test::bumpy_radius(d) + radius + over);
    };
    ball.update(place(0, 0.05));
    ball.update(place(0, -0.02));
    const uint64_t before = ball.counters().triangles_tested;
    for (int i = 0; i < 2000; ++i) ball.update(place(i, -0.02));
    CHECK(ball.counters().walks_cut == 0);
    return static_cast<double>(ball.counters().triangles_tested - before) / 2000;
}

struct Seen {
    uint64_t queries = 0;          // in all ticks
    double steps = 0, seen = 0;    // 99th percentiles over the ticks
    std::vector<glm::dvec3> force; // of all ticks
};

// A stroke over a bumpy ball of radius 1 at a thousandth of it per tick, 0.02 deep, among others on a grid.
Seen stroke(uint32_t subdivisions, int objects, bool between_ticks = true)
{
    Scene scene = bare_scene(test::make_bumpy_sphere(subdivisions));
    scene.objects[0].material.static_friction = scene.objects[0].material.dynamic_friction = 0.2;
    const SceneObject first = scene.objects[0];
    for (int i = 1; i < objects; ++i) {
        scene.objects.push_back(first);
        scene.objects.back().placement.position_m = {3.0 * (i % 10), 3.0 * (i / 10 % 10), 3.0 * (i / 100)};
    }
    Renderer renderer(shared(std::move(scene)));
    Seen all;
    std::vector<double> steps, seen;
    for (int i = -1; i < 6000; ++i) {
        const double angle = 1e-3 * i, height = 0.7 * std::sin(0.37 * angle), across = std::sqrt(1 - height * height);
        const glm::dvec3 d(across * std::cos(angle), across * std::sin(angle), height);
        const glm::dvec3 hand = d * (test::bumpy_radius(d) - (i < 0 ? -0.02 : 0.02));
        const ContactWork before = renderer.work();
        all.force.push_back(renderer.tick(at(hand.x, hand.y, hand.z)).force_n);
        if (between_ticks) renderer.between_ticks();
        const ContactWork& after = renderer.work();
        if (i < 1) continue;
        all.queries += after.sweeps - before.sweeps;
        steps.push_back(static_cast<double>(after.walk_steps - before.walk_steps + after.triangles_tested -
                                            before.triangles_tested));
        seen.push_back(steps.back() + static_cast<double>(after.read_ahead - before.read_ahead));
    }
    const auto p99 = [](std::vector<double> of) {
        std::sort(of.begin(), of.end());
        return of[of.size() * 99 / 100];
    };
    all.steps = p99(steps);
    all.seen = p99(seen);
    return all;
}

} // namespace

TEST_CASE("the triangles that a tick looks at hardly grow with the mesh, and not with the number of objects")
{
    const Seen coarse = stroke(3, 1), fine = stroke(test::is_sanitized ? 5 : 7, 1), many = stroke(3, 1000);
    CHECK(coarse.queries == 0); // in contact the tree is never asked
    CHECK(fine.queries == 0);
    CHECK(many.queries == 0);
    CHECK(coarse.seen >= 11); // its own, and ten of which some are read for the next tick
    CHECK(fine.seen < 1.2 * coarse.seen);
    CHECK(fine.steps <= 3);
    CHECK(many.seen == coarse.seen);
    CHECK(many.force == coarse.force);
}

TEST_CASE("what is done between ticks changes no force")
{
    CHECK(stroke(4, 3, true).force == stroke(4, 3, false).force);
}

TEST_CASE("among blades that stand through a plane a tick looks at those around, however many there are")
{
    // Upright triangles through the plane at random places, but not in the strip that the hand strokes.
    const auto seen_of = [](int blades) {
        Mesh mesh;
        mesh.positions_m = {{-0.05, -0.05, 0}, {0.05, -0.05, 0}, {0.05, 0.05, 0}, {-0.05, 0.05, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> any(-0.049, 0.049);
        for (int i = 0; i < blades; ++i) {
            const double x = any(random), y = any(random);
            if (std::abs(x) < 3e-3 && std::abs(y) < 20e-3) continue;
            const auto first = uint32_t(mesh.positions_m.size());
            for (const glm::dvec3& corner :
                 {glm::dvec3(x, y, -1e-3), glm::dvec3(x + 1e-4, y, -1e-3), glm::dvec3(x, y + 1e-4, 2e-3)})
                mesh.positions_m.push_back(corner);
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        Renderer renderer(shared(bare_scene(mesh)));
        renderer.tick(at(0, 0, 0.01));
        renderer.tick(at(0, 0, 0.001));
        uint64_t most = 0, sum = 0;
        for (int i = 0; i < 1000; ++i) {
            const uint64_t before = renderer.work().triangles_tested;
            const TickResult felt = renderer.tick(at(1e-3 * std::sin(0.02 * i), 15e-3 * std::sin(0.013 * i), -0.5e-3));
            CHECK(std::abs(felt.depth_m - 0.5e-3) < 1e-9);
            CHECK((felt.faults & fault_contact_unfinished) == 0);
            const uint64_t looked_at = renderer.work().triangles_tested - before;
            most = std::max(most, looked_at);
            sum += looked_at;
        }
        return std::pair(most, sum);
    };
    const auto few = seen_of(1000), many = seen_of(16'000);
    CAPTURE(few.first, few.second, many.first, many.second);
    CHECK(many.first <= 2048);
    CHECK(many.second < 64 * 1000);
}

TEST_CASE("what a ball looks at in a tick does not grow with the mesh that it lies on")
{
    if (test::is_sanitized) return; // which takes long to build so fine a mesh
    const double coarse = seen_by_ball(5), fine = seen_by_ball(7);
    CAPTURE(coarse, fine);
    CHECK(fine < 4 * coarse); // 16 times as many triangles
}

TEST_CASE("a hand that rests is felt for nothing")
{
    const auto surface = test::surface_of(test::make_bumpy_sphere(4));
    for (const ProbeSettings& probe : {ProbeSettings{ProbeKind::point}, ProbeSettings{ProbeKind::sphere, 0, 0.1},
                                       ProbeSettings{ProbeKind::stylus, 0.5}, ProbeSettings{ProbeKind::gripper}}) {
        ProbeContact contact(probe, surface);
        const Friction friction{0.3, 0.2};
        std::vector<Contact> held;
        ProbePose hand;
        for (int i = 0; i < 40; ++i) {
            const double angle = 2e-3 * i;
            const glm::dvec3 d(std::cos(angle), std::sin(angle), 0);
            hand = {d * (i < 20 ? 1.5 : 0.99), d * (i < 20 ? 1.9 : 1.4)};
            const auto contacts = contact.update(hand, friction);
            held.assign(contacts.begin(), contacts.end());
        }
        REQUIRE(!held.empty());
        const ContactCounters before = contact.counters();
        for (int i = 0; i < 50; ++i) {
            const auto contacts = contact.update(hand, friction);
            REQUIRE(contacts.size() == held.size());
            for (std::size_t k = 0; k < held.size(); ++k) {
                CHECK(contacts[k].proxy_m == held[k].proxy_m);
                CHECK(contacts[k].depth_m == held[k].depth_m);
                CHECK(contacts[k].lag_m == held[k].lag_m);
            }
        }
        CAPTURE(int(probe.kind));
        CHECK(contact.counters().walk_steps == before.walk_steps);
        CHECK(contact.counters().triangles_tested == before.triangles_tested);
        hand.tip_m.z += 0.01; // which is felt
        CHECK(contact.update(hand, friction)[0].hand_m != held[0].hand_m);
    }
}

TEST_CASE("a shaft that lies on a fine mesh follows a hand of two metres a second")
{
    // On a ball of 5 cm 2 mm a tick, 1 mm deep; the axis about which it rolls over the ball turns.
    StylusContact stylus(test::surface_of(make_icosphere(test::is_sanitized ? 6 : 7)));
    for (int i = 0; i < 800; ++i) {
        const double a = 0.04 * i, b = 0.3 * a;
        const glm::dvec3 d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
        const glm::dvec3 along = glm::normalize(glm::cross(d, glm::dvec3(0.1, 0.2, 1)));
        const glm::dvec3 at = (i == 0 ? 0.51 : 0.49) * d;
        stylus.update(at - 0.7 * along, at + 0.8 * along);
    }
    CHECK(stylus.counters().walks_cut < 5);
}

TEST_CASE("how deep the hand of a point is does not widen what it looks at")
{
    const auto surface = test::surface_of(make_icosphere(test::is_sanitized ? 5 : 7));
    const auto seen_by_point = [&](double depth) { // 1 cm a tick on a ball of 50 cm
        SphereContact point(surface);
        for (int i = 0; i < 1200; ++i) {
            const double a = 0.02 * i, b = 0.3 * a;
            const glm::dvec3 d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
            point.update((i == 0 ? 0.51 : 0.5 - depth) * d);
        }
        CHECK(point.counters().walks_cut < 5);
        return static_cast<double>(point.counters().triangles_tested) / 1200;
    };
    const double in_the_skin = seen_by_point(0.01);
    for (const double depth : {0.2, 0.49}) {
        CAPTURE(depth, in_the_skin);
        CHECK(seen_by_point(depth) < 1.1 * in_the_skin);
    }
}
