// The distance to surfaces, and their pull, held to closed forms; what it does with energy.
#include "runtime/contact/contact.h"
#include "runtime/force/effects.h"
#include "runtime/hand/hand.h"
#include "runtime/render/renderer.h"
#include "runtime/surface/surface_distance.h"
#include "tests/runtime/surface/distance.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using haptel::test::distance_to;

namespace {

// Energy that held forces give to a hand on its way.
struct Energy {
    double given_j = 0, squared_way_m2 = 0;
    glm::dvec3 at_m{0}, force_n{0};

    void go(const glm::dvec3& to_m, const glm::dvec3& new_force_n)
    {
        given_j += glm::dot(force_n, to_m - at_m);
        squared_way_m2 += glm::dot(to_m - at_m, to_m - at_m);
        at_m = to_m;
        force_n = new_force_n;
    }
};

} // namespace

TEST_CASE("the distance to a surface is that of its nearest triangle, found by looking at few")
{
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const char* name : {"torus", "box", "icosphere"}) {
        const auto surface = build_surface(shape(name, 0.1)).surface;
        SurfaceDistance distance(surface);
        CollisionCount count;
        glm::dvec3 p(0.06, 0, 0.02);
        double worst_m = 0;
        int within = 0, wrong = 0;
        constexpr double reach_m = 0.03;
        for (int i = 0; i < test::tries(1000); ++i) {
            p = 0.99 * p + (i % 50 == 0 ? 0.03 : 0.002) * glm::dvec3(normal(random), normal(random), normal(random));
            const double truth_m = distance_to(*surface, p);
            const auto found = distance.within(p, reach_m, count);
            wrong += found.has_value() != (truth_m <= reach_m);
            if (!found) continue;
            ++within;
            worst_m = std::max({worst_m, std::fabs(found->distance_m - truth_m),
                                std::fabs(glm::distance(p, found->point_m) - truth_m)});
        }
        CAPTURE(name, worst_m, count.sweeps, count.triangles_tested);
        CHECK(wrong == 0);
        CHECK(within > test::tries(250));
        CHECK(worst_m < 1e-12);
        CHECK(count.sweeps <= 1000);
        CHECK(count.triangles_tested < 150 * count.sweeps); // of 20 480
    }
}

TEST_CASE("a surface that is out of reach is asked once for a long way")
{
    const auto surface = build_surface(shape("icosphere", 0.1)).surface;
    SurfaceDistance distance(surface);
    CollisionCount asked, looked;
    for (int i = 0; i < 1000; ++i) CHECK_FALSE(distance.within({0.08 + 1e-6 * i, 0, 0}, 0.01, asked));
    CHECK(asked.sweeps == 1);
    // In its centre all triangles are equally near: a bound on the work holds, not one on the answer.
    SurfaceDistance inside(build_surface(make_icosphere(6)).surface);
    REQUIRE(inside.within({0, 0, 0}, 2, looked));
    CHECK(looked.triangles_tested == SurfaceDistance::triangles_max);
    CHECK(std::fabs(inside.within({0, 0, 0}, 2, looked)->distance_m - 0.5) < 1e-3);
}

TEST_CASE("a magnet pulls toward a plate as its potential says, from its reach to the surface")
{
    constexpr double force_n = 2, reach_m = 5e-3;
    Renderer renderer(shared(magnet_scene(plane_mesh(), force_n, reach_m)));
    double largest_n = 0, last_n = 0;
    for (double z = 8e-3; z > -1e-3; z -= 1e-5) {
        const glm::dvec3 force = renderer.tick(at(0.01, 0.02, z)).force_n;
        const double x = z / reach_m;
        const double wanted_n = z > 0 ? (x < 1 ? -4 * force_n * x * (1 - x) : 0) : -1000 * z;
        CHECK(std::fabs(force.z - wanted_n) < 1e-8);
        CHECK(std::hypot(force.x, force.y) < 1e-12);
        CHECK(std::fabs(force.z - last_n) <= 1e-5 * 4 * force_n / reach_m + 1e-9); // no step
        largest_n = std::max(largest_n, -force.z);
        last_n = force.z;
        if (x > 0.01 && x < 0.99) {                    // minus the derivative of the energy
            const auto energy_j = [&](double away_m) { // magnet.h
                const double share = away_m / reach_m;
                return force_n * reach_m * share * share * (2 - 4.0 / 3 * share);
            };
            const double slope_n = (energy_j(z + 1e-7) - energy_j(z - 1e-7)) / 2e-7;
            CHECK(std::fabs(force.z + slope_n) < 1e-6);
        }
    }
    CHECK(std::fabs(largest_n - force_n) < 1e-4);
}

TEST_CASE("a magnet pulls a tip that is free, whatever else holds the stylus")
{
    const auto scene = shared(magnet_scene(plane_mesh(), 2, 5e-3));
    Effects effects(*scene, {});
    const auto pull_n = [&](const Contact& contact) {
        effects.begin({0.01, 0.02, 1e-3}, 0, 1);
        CollisionCount count;
        (void)effects.pull(0, {}, Effects::held_out_m({&contact, 1}), 1000, count);
        effects.update(0, {}, {&contact, 1});
        return effects.force_n().z;
    };
    Contact contact; // 0.1 m of it are drawn up by the shaft
    contact.touching = true;
    contact.depth_m = 0.1;
    CHECK(pull_n(contact) == 0);
    contact.by_shaft = true;
    CHECK(pull_n(contact) == Approx(-Magnet{2, 5e-3}.pull_n(1e-3)));
}

TEST_CASE("a magnet pulls to the nearest point of a box, wherever it stands, and a ball by its rim")
{
    constexpr double force_n = 1, reach_m = 0.02, half_m = 0.05;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(-0.08, 0.08);
    for (const double radius_m : {0.0, 4e-3}) {
        Scene scene = magnet_scene(shape("box", 2 * half_m), force_n, reach_m);
        if (radius_m > 0) scene.probe = {ProbeKind::sphere, 0, radius_m};
        const double c = std::cos(0.7), s = std::sin(0.7);
        Placement& placement = scene.objects[0].placement;
        placement.rotation = {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
        placement.position_m = {0.2, 0.1, -0.3};
        const auto to_world = [p = placement](const glm::dvec3& v) { return p.rotation * v + p.position_m; };
        const glm::dmat3 rotation = placement.rotation;
        Renderer renderer(shared(std::move(scene)));
        double worst_n = 0;
        int pulled = 0;
        for (int i = 0; i < 5000; ++i) {
            const glm::dvec3 p(part(random), part(random), part(random));
            const glm::dvec3 away = p - glm::clamp(p, -half_m, half_m);
            const double distance_m = glm::length(away) - radius_m;
            if (distance_m < 1e-3) continue;
            // Not through the box: over the outside, far enough for every corner.
            const glm::dvec3 out = glm::normalize(p) * 0.3;
            for (const glm::dvec3& way : {out, p}) {
                const glm::dvec3 at = to_world(way);
                const TickResult result = renderer.tick({at, at});
                if (result.contacts > 0 || way == out) continue;
                const double x = distance_m / reach_m;
                const double pull_n = x < 1 ? 4 * force_n * x * (1 - x) : 0;
                const glm::dvec3 wanted = rotation * (-pull_n * glm::normalize(away));
                worst_n = std::max(worst_n, glm::distance(result.force_n, wanted));
                pulled += pull_n > 0;
            }
            const glm::dvec3 back = to_world(out);
            renderer.tick({back, back});
        }
        CAPTURE(radius_m, worst_n, pulled);
        CHECK(pulled > 300);
        CHECK(worst_n < 1e-9);
    }
}

TEST_CASE("a magnet gives no energy on closed paths, not even where two walls are equally near")
{
    constexpr double force_n = 2, reach_m = 0.04;
    // Inside of a box of 0.1 m: every path crosses the ridges between its walls.
    for (const int steps : {500, 5000, 50000}) {
        Renderer renderer(shared(magnet_scene(shape("box", 0.1), force_n, reach_m)));
        Energy energy;
        for (int i = 0; i <= 3 * steps; ++i) {
            const double t = 2 * std::numbers::pi * i / steps;
            const glm::dvec3 p(0.035 * std::cos(t), 0.03 * std::sin(2 * t), 0.02 * std::sin(3 * t));
            if (i == 0) energy.at_m = p;
            const TickResult result = renderer.tick({p, p});
            REQUIRE(result.contacts == 0);
            energy.go(p, result.force_n);
        }
        CAPTURE(steps, energy.given_j, energy.squared_way_m2);
        CHECK(energy.given_j <= 4 * force_n / reach_m / 2 * energy.squared_way_m2);
        CHECK(energy.given_j < 1e-2 / steps);
    }
    // Round a ball and into its reach and out: nothing but the steps' own share, which falls with them.
    double last_j = 0;
    for (const int steps : {1000, 2000, 4000}) {
        Renderer renderer(shared(magnet_scene(shape("icosphere", 0.1), force_n, reach_m)));
        Energy energy;
        for (int i = 0; i <= steps; ++i) {
            const double t = 2 * std::numbers::pi * i / steps, r = 0.08 + 0.02 * std::sin(3 * t);
            const glm::dvec3 p(r * std::cos(t), r * std::sin(t), 0.01 * std::sin(t));
            if (i == 0) energy.at_m = p;
            energy.go(p, renderer.tick({p, p}).force_n);
        }
        CAPTURE(steps, energy.given_j, last_j);
        if (last_j != 0) CHECK(std::fabs(energy.given_j / last_j - 0.5) < 0.05);
        last_j = energy.given_j;
        CHECK(energy.given_j <= 4 * force_n / reach_m / 2 * energy.squared_way_m2);
    }
}
