// Where a smooth wall meets its floor each is felt by its own shading: no step of the force.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double radius_m = 0.02, height_m = 0.04;

// A closed tube that stands on z = 0, its walls smooth.
Mesh tube(uint32_t sides)
{
    Mesh mesh;
    for (const double z : {0.0, height_m})
        for (uint32_t i = 0; i < sides; ++i) {
            const double angle = 2 * std::numbers::pi * i / sides;
            mesh.positions_m.push_back({radius_m * std::cos(angle), radius_m * std::sin(angle), z});
        }
    mesh.positions_m.push_back({0, 0, 0});
    mesh.positions_m.push_back({0, 0, height_m});
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t j = (i + 1) % sides;
        mesh.triangles.push_back({i, j, sides + j});
        mesh.triangles.push_back({i, sides + j, sides + i});
        mesh.triangles.push_back({2 * sides, j, i});
        mesh.triangles.push_back({2 * sides + 1, sides + i, sides + j});
    }
    return mesh;
}

Scene tube_scene(uint32_t sides, const ProbeSettings& probe)
{
    Scene scene = bare_scene(tube(sides));
    scene.probe = probe;
    return scene;
}

dvec3 around(double angle, double from_axis_m, double z_m)
{
    return {from_axis_m * std::cos(angle), from_axis_m * std::sin(angle), z_m};
}

// How much more than by its spring the force changes from tick to tick, at most.
double steepest(Renderer& renderer, const auto& place, int ticks)
{
    dvec3 at_m = place(0), force_n = renderer.tick({at_m, at_m}).force_n;
    double most = 0;
    for (int i = 1; i <= ticks; ++i) {
        const dvec3 next_m = place(i), next_n = renderer.tick({next_m, next_m}).force_n;
        REQUIRE(glm::length(next_n) > 0);
        most = std::max(most, glm::distance(next_n, force_n) / (spring_n_per_m * glm::distance(next_m, at_m)));
        at_m = next_m, force_n = next_n;
    }
    return most;
}

} // namespace

TEST_CASE("no force steps where the smooth wall of a tube meets its floor")
{
    for (const uint32_t sides : {10u, 16u, 32u, 64u})
        for (const double turn : {0.5, 0.3, 0.05, 0.0}) { // of a side
            if (haptel::test::is_sanitized && sides != 16) continue;
            const double angle = 2 * std::numbers::pi * (1 + turn) / sides;
            CAPTURE(sides, turn);
            Renderer renderer(shared(tube_scene(sides, {})));
            renderer.tick({around(angle, 0.015, 0.01), {}});
            renderer.tick({around(angle, 0.015, 1e-3), {}});
            // From the wall down into the crease, and along it.
            CHECK(steepest(
                      renderer, [&](int i) { return around(angle, radius_m + 1e-3, 0.5e-3 - i * 0.5e-6); }, 2000) < 2);
            CHECK(steepest(
                      renderer, [&](int i) { return around(angle + i * 2.5e-5, radius_m + 1e-3, -0.5e-3); }, 20'000) <
                  2);
        }
}

TEST_CASE("no force steps where a ball rolls over the rim of a tube")
{
    constexpr double ball_m = 2.5e-3, reach_m = ball_m - 1e-3;
    for (const uint32_t sides : {10u, 16u, 32u, 64u}) {
        CAPTURE(sides);
        const double angle = 2 * std::numbers::pi * 1.5 / sides, wall_m = radius_m * std::cos(std::numbers::pi / sides);
        Renderer renderer(shared(tube_scene(sides, {ProbeKind::sphere, 0, ball_m})));
        // From the wall over the rim onto the lid, at a depth of 1 mm, on a quarter of a circle round the edge.
        const auto place = [&](int i) {
            const double tilt = i * std::numbers::pi / 2 / 4000;
            return around(angle, wall_m + reach_m * std::cos(tilt), height_m + reach_m * std::sin(tilt));
        };
        renderer.tick({around(angle, 0.03, height_m - 1e-4), {}});
        CHECK(steepest(renderer, place, 4000) < 4);
    }
}
