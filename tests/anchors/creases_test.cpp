// The proxy never wedges between facets that lie nearly in one plane, however many there are.
#include "runtime/render/renderer.h"
#include "tests/anchors/geodesic.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

constexpr double stiffness_n_per_m = 500, static_friction = 0.3, dynamic_friction = 0.2;

// A walk of the hand over the directions, with momentum.
class Stroll {
public:
    const dvec3& next(double step)
    {
        heading_ = glm::normalize(heading_ + 0.01 * dvec3(normal_(random_), normal_(random_), normal_(random_)));
        heading_ = glm::normalize(heading_ - glm::dot(heading_, at_) * at_);
        return at_ = glm::normalize(at_ + step * heading_);
    }
    const dvec3& at() const { return at_; }

private:
    std::mt19937_64 random_{1};
    std::normal_distribution<double> normal_;
    dvec3 at_{0, 0, 1}, heading_{glm::normalize(dvec3(1, 0.3, 0.1))};
};

struct Forces {
    double mean_n = 0, ideal_mean_n = 0; // force felt; force that the true surface gives without friction
    double least_n = 1e9, most_n = -1e9; // felt beyond what the ideal and the friction allow; short of the ideal if < 0
    int above = 0, lost = 0;             // ticks above 1.5 times the ideal; without contact
};

std::shared_ptr<const Scene> scene_of(const std::shared_ptr<const Surface>& surface, bool friction,
                                      const ProbeSettings& probe = {})
{
    Scene scene = tests::bare_scene(tests::plane_mesh());
    SceneObject& object = scene.objects[0];
    object.surface = surface;
    object.material = {stiffness_n_per_m, 0, friction ? static_friction : 0, friction ? dynamic_friction : 0};
    scene.probe = probe;
    scene.servo.force_limit_n = 100; // the most that a scene may have: what is too much must be seen
    return tests::shared(std::move(scene));
}

// `hand` as a function of the direction, `ideal_depth` of the hand.
template <class Hand, class Depth>
Forces stroke(const std::shared_ptr<const Scene>& scene, double start_m, double step, int ticks, Hand&& hand,
              Depth&& ideal_depth)
{
    const double sticking = std::hypot(1, scene->objects[0].material.static_friction);
    Renderer renderer(scene);
    Stroll stroll;
    const dvec3 start = start_m * stroll.at();
    renderer.tick({start, start});
    Forces forces;
    for (int i = 0; i < ticks; ++i) {
        const dvec3 tip = hand(stroll.next(step));
        const TickResult felt = renderer.tick({tip, tip});
        const double force_n = glm::length(felt.force_n), ideal_n = stiffness_n_per_m * ideal_depth(tip);
        forces.mean_n += force_n / ticks;
        forces.ideal_mean_n += ideal_n / ticks;
        forces.least_n = std::min(forces.least_n, force_n - ideal_n);
        forces.most_n = std::max(forces.most_n, force_n / sticking - ideal_n);
        forces.above += force_n > 1.5 * ideal_n;
        forces.lost += felt.contacts != 1;
    }
    return forces;
}

// How far facets lie from the surface that they stand for.
template <class Nearest>
double furthest_facet_m(const Surface& surface, Nearest&& nearest)
{
    double furthest_m = 0;
    for (uint32_t face = 0; face < surface.faces.size(); ++face) {
        const dvec3 middle = (surface.vertex_m(face, 0) + surface.vertex_m(face, 1) + surface.vertex_m(face, 2)) / 3.0;
        furthest_m = std::max(furthest_m, glm::distance(middle, nearest(middle)));
    }
    return furthest_m;
}

// Nothing but the facets' distance from the true surface parts the forces from the ideal ones; it is exceeded a little
// where the ways from both to the hand differ, in shallow creases.
void check(const Forces& forces, double furthest_m)
{
    const double slack_n = 1.2 * stiffness_n_per_m * furthest_m;
    CAPTURE(forces.least_n, forces.most_n, slack_n);
    CHECK(forces.above == 0);
    CHECK(forces.lost == 0);
    CHECK(forces.least_n > -slack_n);
    CHECK(forces.most_n < slack_n);
}

} // namespace

TEST_CASE("anchors row 1: no tick above 1.5 times the ideal force on a bumpy sphere of 7 220 to 699 380 triangles")
{
    constexpr double depth_m = 0.02; // along the radius
    for (const uint32_t parts : {19u, 59u, 187u}) {
        const auto surface = build_surface(BumpySphere::mesh(parts)).surface;
        REQUIRE(surface->faces.size() == 20 * parts * parts);
        const double furthest_m = furthest_facet_m(*surface, BumpySphere::nearest_m);
        for (const bool friction : {false, true})
            for (const double step : {2e-4, 1e-3}) {
                CAPTURE(parts, friction, step);
                const Forces forces = stroke(
                    scene_of(surface, friction), 1.2, step, 200'000,
                    [&](const dvec3& d) { return d * (BumpySphere::radius_m(d) - depth_m); },
                    [](const dvec3& tip) { return glm::distance(tip, BumpySphere::nearest_m(tip)); });
                CHECK(std::abs(forces.ideal_mean_n - 10) < 0.1); // the hand was where it was meant to be
                check(forces, furthest_m);
            }
    }
}

TEST_CASE("anchors row 1: nor is a ball wedged, of a twentieth of the object's radius")
{
    constexpr double depth_m = 0.02, radius_m = 0.05;
    for (const uint32_t parts : {59u, 187u}) {
        const auto surface = build_surface(BumpySphere::mesh(parts)).surface;
        const double furthest_m = furthest_facet_m(*surface, BumpySphere::nearest_m);
        for (const bool friction : {false, true})
            for (const double step : {2e-4, 1e-3}) {
                CAPTURE(parts, friction, step);
                const Forces forces = stroke(
                    scene_of(surface, friction, {ProbeKind::sphere, 0, radius_m}), 1.2, step, 20'000,
                    [&](const dvec3& d) { return d * (BumpySphere::radius_m(d) + radius_m - depth_m); },
                    [&](const dvec3& centre) {
                        return radius_m - glm::distance(centre, BumpySphere::nearest_m(centre));
                    });
                CHECK(std::abs(forces.ideal_mean_n - 10) < 0.1);
                check(forces, furthest_m);
            }
    }
}

TEST_CASE("anchors row 1: in a bowl of two million triangles the force is the ideal one")
{
    constexpr double depth_m = 0.01;
    const auto surface = build_surface(make_unit_geodesic(316)).surface;
    REQUIRE(surface->faces.size() == 1'997'120);
    const double furthest_m = furthest_facet_m(*surface, [](const dvec3& p) { return glm::normalize(p); });
    for (const bool friction : {false, true}) {
        CAPTURE(friction);
        const Forces forces = stroke(
            scene_of(surface, friction), 0.9, 1e-3, 200'000, [&](const dvec3& d) { return d * (1 + depth_m); },
            [&](const dvec3&) { return depth_m; });
        check(forces, 2 * furthest_m); // between two shallow walls at most twice as deep as below one
        const double sliding_n = stiffness_n_per_m * depth_m * (friction ? std::hypot(1, dynamic_friction) : 1);
        CHECK(std::abs(forces.mean_n - sliding_n) < 1e-3 * sliding_n);
    }
}
