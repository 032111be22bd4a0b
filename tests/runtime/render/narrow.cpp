// Walls of a narrow groove push against each other by the way of the hand over the sine of the angle between them. By
// what is left of it, stiffnesses and textures apart, the hand is pushed by no more than a few times its spring's pull.
// Where a probe comes to a wall besides what holds it, the force does not step. And a ball on the border of an open
// mesh, where there is one wall of no thickness.
#include "runtime/render/renderer.h"
#include "runtime/surface/build/joined_surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

Scene joined_scene(const Mesh& first, const Mesh& second)
{
    Scene scene = bare_scene(first);
    scene.objects.push_back(bare_scene(second).objects[0]);
    const std::vector<PlacedSurface> placed{{scene.objects[0].surface, {}}, {scene.objects[1].surface, {}}};
    const std::vector<uint32_t> numbers{0, 1};
    scene.joined.push_back({join(placed, numbers).surface, numbers});
    return scene;
}

// Two joined boxes with a gap of that angle, which widens along x from the y axis.
Scene gap_scene(double angle, double below_n_per_m, double above_n_per_m)
{
    Mesh below = make_box({0.1, 0.1, 0.03}), above = below;
    for (dvec3& p : below.positions_m) p += dvec3(0.02, 0, -0.015);
    for (dvec3& p : above.positions_m) {
        const dvec3 flat = p + dvec3(0.02, 0.001, 0.015);
        p = {std::cos(angle) * flat.x - std::sin(angle) * flat.z, flat.y,
             std::sin(angle) * flat.x + std::cos(angle) * flat.z};
    }
    Scene scene = joined_scene(below, above);
    scene.objects[0].material.stiffness_n_per_m = below_n_per_m;
    scene.objects[1].material.stiffness_n_per_m = above_n_per_m;
    return scene;
}

// Into a gap that widens along x: 4.9 mm farther than the probe can go, whose centre stops at `bottom_m`.
dvec3 force_in_gap_n(const Scene& scene, double angle, double bottom_m)
{
    Renderer renderer(shared(scene));
    dvec3 force(0);
    for (double x = bottom_m + 0.05; x > bottom_m - 4.9e-3; x -= 1e-4)
        force = renderer.tick(at(x, 0.0013, x * std::tan(angle / 2))).unlimited_force_n;
    return force;
}

} // namespace

TEST_CASE("a narrow gap between a soft and a hard object pushes by a few times the pull of the harder spring")
{
    for (const double angle : {0.2, 0.01, 0.002}) {
        CAPTURE(angle);
        CHECK(glm::length(force_in_gap_n(gap_scene(angle, 100, 2000), angle, 0)) < 4.5 * 2000 * 4.9e-3);
        const dvec3 alike = force_in_gap_n(gap_scene(angle, 1000, 1000), angle, 0); // as one mesh would
        CHECK(glm::distance(alike, 4.9 * dvec3(std::cos(angle / 2), 0, std::sin(angle / 2))) < 0.15);
    }
}

TEST_CASE("in a rough groove of 60 degrees the force has no step where the hand goes over the plane of a wall")
{
    // Behind the bottom it is above that wall, and still held by it.
    constexpr double angle = 1.047, step_m = 1e-5;
    Scene scene = gap_scene(angle, 1000, 1000);
    for (SceneObject& object : scene.objects) {
        object.material.static_friction = object.material.dynamic_friction = 0.3;
        object.material.damping_n_s_per_m = 2;
    }
    Renderer renderer(shared(std::move(scene)));
    for (double x = 0.02; x > -3e-3; x -= step_m) renderer.tick(at(x, 0, 0.5 * std::max(x, 0.0)));
    dvec3 before(0);
    int above = 0;
    for (int i = 0; i < 1000; ++i) {
        const double z = -1e-3 + 2e-6 * i;
        const TickResult tick = renderer.tick(at(-3e-3, step_m * i, z));
        CAPTURE(i, z);
        REQUIRE(tick.contacts == 2);
        // 0.01 N by the spring, once the hand goes that way
        if (i > 50) CHECK(glm::distance(tick.unlimited_force_n, before) < 0.03);
        before = tick.unlimited_force_n;
        above += z > 0 && std::fabs(before.y) > 1; // friction holds it back
    }
    CHECK(above > 400);
}

// Where it comes to the wall, the ball's facets stand for another normal than they have, and for a place above them.
TEST_CASE("where a probe comes to a wall on a ball of triangles the force has no step")
{
    constexpr double depth_m = 1e-3, step_m = 5e-7, wall_m = 0.01;
    for (const double radius_m : {0.0, 2e-3}) {
        Mesh wall = make_box({0.1, 0.12, 0.12});
        for (dvec3& p : wall.positions_m) p.x += wall_m + 0.05;
        Scene scene = joined_scene(ball_mesh(3, 0.1), wall);
        if (radius_m > 0) scene.probe = ProbeSettings{ProbeKind::sphere, 0.15, radius_m};
        const auto touched = shared(std::move(scene));
        std::mt19937_64 random(5);
        for (int i = 0; i < 20; ++i) {
            const double y = std::uniform_real_distribution<double>(-0.03, 0.03)(random),
                         distance_m = 0.0495 - depth_m + radius_m; // the facets are up to half a millimetre lower
            Renderer renderer(touched);
            renderer.tick(at(0, y, 0.08));
            dvec3 hand(0), before(0);
            double most_n_per_m = 0;
            bool met = false;
            for (double x = wall_m - radius_m - 1e-3; x < wall_m - radius_m + 3e-4; x += step_m) {
                const dvec3 next(x, y, std::sqrt(distance_m * distance_m - x * x - y * y));
                const TickResult tick = renderer.tick({next, next});
                if (hand != dvec3(0))
                    most_n_per_m = std::fmax(most_n_per_m,
                                             glm::distance(tick.unlimited_force_n, before) / glm::distance(next, hand));
                hand = next;
                before = tick.unlimited_force_n;
                met = met || tick.contacts == 2;
            }
            CAPTURE(radius_m, y);
            CHECK(met);
            CHECK(most_n_per_m < 3 * spring_n_per_m);
        }
    }
}

TEST_CASE("in a corner of a bare wall and a textured one the force has no step where the texture begins to be felt")
{
    constexpr double angle = 2.094, high_m = 1e-4, step_m = high_m / 4000;
    const auto sunk = [](const haptel_point&, haptel_sample& sample) { sample.height_m = -high_m; };
    for (const int textured : {0, 1}) {
        Scene scene = gap_scene(angle, 1000, 1000);
        scene.objects[textured].texture = std::make_shared<TextureSlot>(sample_lambda(sunk, -high_m, 0));
        const auto touched = shared(std::move(scene));
        const dvec3 below(0, 0, 1), above(std::sin(angle), 0, -std::cos(angle));
        for (const double bare_m : {0.1, 0.3, 0.7, 1.0, 1.4, 2.0}) {
            Renderer renderer(touched);
            renderer.tick({below + above, below + above});
            dvec3 hand(0), before(0);
            double most_n_per_m = 0;
            int both = 0;
            for (double depth_m = 0; depth_m < 2 * high_m; depth_m += step_m) {
                const dvec3 next =
                    -(textured ? bare_m * high_m : depth_m) * below - (textured ? depth_m : bare_m * high_m) * above;
                const TickResult tick = renderer.tick({next, next});
                if (depth_m > 10 * step_m)
                    most_n_per_m = std::fmax(most_n_per_m,
                                             glm::distance(tick.unlimited_force_n, before) / glm::distance(next, hand));
                hand = next;
                before = tick.unlimited_force_n;
                both += tick.contacts == 2;
            }
            CAPTURE(textured, bare_m);
            CHECK(both > 7000);
            CHECK(most_n_per_m < 6 * spring_n_per_m);
        }
    }
}

TEST_CASE("a texture in a narrow groove acts by a few times the way of the ball, not by its walls' pushes")
{
    constexpr double angle = 0.03, radius_m = 1e-3, length_m = 0.12, amplitude_m = 1e-4, per_m = 600;
    Mesh groove;
    const double high_m = length_m * std::tan(angle / 2);
    groove.positions_m = {{0, -0.05, 0},
                          {0, 0.05, 0},
                          {length_m, -0.05, -high_m},
                          {length_m, 0.05, -high_m},
                          {length_m, -0.05, high_m},
                          {length_m, 0.05, high_m}};
    groove.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 5, 4}, {0, 1, 5}};
    const auto waves = [](const haptel_point& at, haptel_sample& sample) {
        sample.height_m = amplitude_m * std::sin(per_m * at.p[1]);
        sample.gradient[1] = amplitude_m * per_m * std::cos(per_m * at.p[1]);
    };
    Scene scene = bare_scene(groove, sample_lambda(waves, -amplitude_m, amplitude_m));
    scene.probe.kind = ProbeKind::sphere;
    scene.probe.radius_m = radius_m;
    Renderer renderer(shared(scene));
    dvec3 force(0);
    for (double x = 0.11; x > radius_m / std::sin(angle / 2) - 5e-3; x -= 1e-4)
        force = renderer.tick(at(x, 3e-4, 0)).unlimited_force_n;
    CHECK(std::fabs(force.x - 5) < 1);
    CHECK(std::fabs(force.y) < 4 * 5 * amplitude_m * per_m); // the slope's share
}

TEST_CASE("a ball on the border of a sheet is pushed away from it, and a closed path gives nothing")
{
    constexpr double radius_m = 5e-3, side_m = 0.1;
    for (const bool at_a_corner : {false, true}) {
        CAPTURE(at_a_corner);
        Scene scene = bare_scene(plane_mesh(side_m));
        scene.probe.kind = ProbeKind::sphere;
        scene.probe.radius_m = radius_m;
        Renderer renderer(shared(scene));
        const dvec3 rim(side_m / 2, at_a_corner ? side_m / 2 : 0.01, 0);
        const dvec3 out = at_a_corner ? glm::normalize(dvec3(1, 1, 0)) : dvec3(1, 0, 0), up(0, 0, 1);
        double given_j = 0;
        dvec3 hand = rim + 0.006 * out + 2e-4 * up, force(0);
        const auto go = [&](const dvec3& to) {
            constexpr int ticks = 400;
            const dvec3 from = hand;
            for (int i = 1; i <= ticks; ++i) {
                const dvec3 next = from + double(i) / ticks * (to - from);
                const dvec3 felt = renderer.tick(at(next.x, next.y, next.z)).unlimited_force_n;
                given_j += 0.5 * glm::dot(felt + force, next - hand);
                hand = next;
                force = felt;
                const dvec3 away = hand - rim;
                const double depth_m = std::fmax(0, radius_m - glm::length(away));
                REQUIRE(glm::distance(force, 1000 * depth_m * glm::normalize(away)) < 1e-3);
            }
        };
        const dvec3 start = hand, near = rim + 0.002 * out + 2e-4 * up, above = near + 2.8e-3 * up;
        go(near);
        go(above);
        go(start + 2.8e-3 * up);
        go(start);
        CHECK(std::fabs(given_j) < 1e-7);
    }
}
