// From one object at rest to another that it meets: no step of the force that neither of them has by itself.
#include "runtime/render/renderer.h"
#include "runtime/surface/build/joined_surfaces.h"
#include "runtime/surface/shapes.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double step_m = 20e-6; // of the hand in a tick
constexpr ProbeKind every_probe[] = {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus, ProbeKind::gripper};

SceneObject object(const Mesh& mesh, const Placement& placement, double stiffness_n_per_m, double friction = 0,
                   TextureBinding texture = {})
{
    SceneObject one;
    one.surface = build_surface(mesh).surface;
    one.placement = placement;
    one.material = {stiffness_n_per_m, 0, friction, friction};
    one.texture = std::make_shared<TextureSlot>(std::move(texture));
    return one;
}

// All of them meet.
Scene joined(std::vector<SceneObject> objects)
{
    Scene scene;
    scene.servo.force_rise_s = 0;
    scene.servo.force_limit_n = 100;
    std::vector<PlacedSurface> placed;
    for (const SceneObject& one : objects) placed.push_back({one.surface, one.placement});
    const std::vector<MeetingSurfaces> meeting = find_meeting(placed);
    REQUIRE(meeting.size() == 1);
    REQUIRE(meeting[0].numbers.size() == objects.size());
    scene.joined.push_back({join(placed, meeting[0].numbers).surface, meeting[0].numbers});
    REQUIRE(scene.joined[0].surface);
    scene.objects = std::move(objects);
    return scene;
}

// A box of that size behind the plane through the place, which faces `normal`; `along` lies in it.
SceneObject behind(const dvec3& place_m, const dvec3& normal, const dvec3& along, double stiffness_n_per_m,
                   double friction = 0, TextureBinding texture = {})
{
    constexpr double size_m = 0.1;
    const glm::dmat3 rotation(along, glm::cross(normal, along), normal);
    return object(make_box(dvec3(size_m)), {rotation, place_m - 0.5 * size_m * normal}, stiffness_n_per_m, friction,
                  std::move(texture));
}

Scene with_probe(Scene scene, ProbeKind kind)
{
    scene.probe = {kind, 0.05, kind == ProbeKind::sphere ? 1e-3 : 0.0};
    return scene;
}

// The hand's way from place to place, and the largest change of the force between ticks.
class Stroke {
public:
    // `rest` leads from the tip to the tail: up the shaft of a stylus, to the other finger of a gripper.
    Stroke(Scene scene, const dvec3& rest_m, double tick_m = step_m)
        : renderer_(shared(std::move(scene))), rest_m_(rest_m), tick_m_(tick_m)
    {
    }

    void to(const dvec3& place_m)
    {
        const double way_m = began_ ? glm::distance(hand_m_, place_m) : 0;
        const dvec3 from_m = hand_m_;
        const int ticks = std::max(1, static_cast<int>(std::ceil(way_m / tick_m_)));
        for (int i = 1; i <= ticks; ++i) {
            const dvec3 last_m = hand_m_;
            hand_m_ = began_ ? from_m + (place_m - from_m) * (static_cast<double>(i) / ticks) : place_m;
            felt_ = renderer_.tick({hand_m_, hand_m_ + rest_m_});
            const double change_n = glm::distance(felt_.unlimited_force_n, force_n_);
            if (began_) given_j_ += 0.5 * glm::dot(felt_.unlimited_force_n + force_n_, hand_m_ - last_m);
            if (std::exchange(began_, true) && change_n > largest_n_) largest_n_ = change_n, largest_at_m_ = hand_m_;
            force_n_ = felt_.unlimited_force_n;
            touching_ += felt_.contacts > 0;
            both_ += felt_.contacts > 1;
        }
    }
    const dvec3& force_n() const { return force_n_; }
    const TickResult& felt() const { return felt_; }
    double largest_n() const { return largest_n_; }
    const dvec3& largest_at_m() const { return largest_at_m_; }
    double given_j() const { return given_j_; } // to the hand, of a point
    int touching() const { return touching_; }  // ticks
    int both() const { return both_; }          // ticks that felt more than one object

private:
    Renderer renderer_;
    dvec3 rest_m_;
    double tick_m_;
    dvec3 hand_m_{0}, force_n_{0}, largest_at_m_{0};
    TickResult felt_;
    bool began_ = false;
    double largest_n_ = 0, given_j_ = 0;
    int touching_ = 0, both_ = 0;
};

// A floor, its top in z = 0, and a wall on it that the hand in front of it meets in the y axis, at this angle.
struct Wedge {
    double degrees;

    double radians() const { return glm::radians(degrees); }
    dvec3 floor_normal() const { return {0, 0, 1}; }
    dvec3 wall_normal() const { return {-std::sin(radians()), 0, -std::cos(radians())}; }
    dvec3 between() const { return {-std::cos(radians() / 2), 0, std::sin(radians() / 2)}; }
    SceneObject floor(double stiffness_n_per_m, double friction = 0, TextureBinding texture = {}) const
    {
        return behind(dvec3(0), floor_normal(), {1, 0, 0}, stiffness_n_per_m, friction, std::move(texture));
    }
    SceneObject wall(double stiffness_n_per_m, double friction = 0, TextureBinding texture = {}) const
    {
        const dvec3 up(-std::cos(radians()), 0, std::sin(radians()));
        return behind(0.03 * up, wall_normal(), up, stiffness_n_per_m, friction, std::move(texture));
    }
};

dvec3 rest_m(ProbeKind kind, const dvec3& shaft)
{
    return kind == ProbeKind::gripper ? dvec3(0, 0.01, 0) : 0.05 * shaft;
}

// Everywhere around the line from -reach to reach on the y axis, in and out of what is there.
void wander(Stroke& stroke, double reach_m, double depth_m, int strokes, uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < strokes; ++i)
        stroke.to({depth_m * uniform(random), reach_m * uniform(random), depth_m * uniform(random)});
}

} // namespace

TEST_CASE("in the corner of a floor and a wall each pushes with its own stiffness against its own depth")
{
    const Wedge wedge{90};
    for (const bool floor_first : {true, false}) {
        std::vector<SceneObject> objects = {wedge.floor(300), wedge.wall(1100)};
        if (!floor_first) std::swap(objects[0], objects[1]);
        Stroke stroke(joined(std::move(objects)), dvec3(0));
        stroke.to({-2e-3, 1e-3, 2e-3});
        for (const dvec3& place : {dvec3(1e-3, 2e-3, -2e-3), dvec3(2e-3, -3e-3, -1e-4), dvec3(1e-6, 0.01, -1e-3),
                                   dvec3(-1e-3, 0.01, -1e-3), dvec3(1e-3, 0, 1e-3), dvec3(3e-3, 0.02, -3e-3)}) {
            stroke.to(place);
            const double floor_m = std::max(0.0, -place.z), wall_m = std::max(0.0, place.x);
            CHECK(glm::distance(stroke.force_n(), dvec3(-1100 * wall_m, 0, 300 * floor_m)) < 1e-7);
            CHECK(stroke.felt().contacts == (floor_m > 0 ? 1u : 0u) + (wall_m > 0 ? 1u : 0u));
        }
    }
}

TEST_CASE("no force steps where a floor and a wall of other stiffness meet, whatever wanders there")
{
    for (const double degrees : {60.0, 90.0, 120.0, 150.0})
        for (const ProbeKind kind : every_probe)
            for (const bool floor_first : {true, false}) {
                const Wedge wedge{degrees};
                std::vector<SceneObject> objects = {wedge.floor(200), wedge.wall(1500)};
                if (!floor_first) std::swap(objects[0], objects[1]);
                Stroke stroke(with_probe(joined(std::move(objects)), kind), rest_m(kind, wedge.between()));
                stroke.to(3e-3 * wedge.between());
                wander(stroke, 8e-3, 2.5e-3, 60, 7);
                CAPTURE(degrees, static_cast<int>(kind), floor_first, stroke.largest_at_m().x, stroke.largest_at_m().y,
                        stroke.largest_at_m().z);
                // What each holds changes by no more than the hand moves over the sine of the angle between them.
                const int ends = kind == ProbeKind::gripper ? 2 : 1;
                CHECK(stroke.largest_n() < 1.01 * ends * (200 + 1500) * step_m / std::sin(wedge.radians()));
                CHECK(stroke.touching() > 2000);
                CHECK(stroke.both() > 1000);
            }
}

TEST_CASE("no force steps where a floor and a wall of other texture or friction meet, nor more by friction than "
          "between the materials")
{
    constexpr double amplitude_m = 10e-6, wave_m = 4e-3, slope = 2 * std::numbers::pi * amplitude_m / wave_m,
                     bend_per_m = slope * 2 * std::numbers::pi / wave_m, depth_m = 3e-3;
    const struct {
        double floor_n_per_m, wall_n_per_m, floor_friction, wall_friction;
        bool textured;
    } materials[] = {{400, 900, 0, 0, true}, {900, 900, 0.15, 0.6, false}, {400, 900, 0.6, 0.15, false}};
    for (const double degrees : {60.0, 90.0, 120.0})
        for (const ProbeKind kind : every_probe)
            for (const auto& [floor_n_per_m, wall_n_per_m, floor_friction, wall_friction, textured] : materials) {
                const Wedge wedge{degrees};
                const auto texture = [&] { return textured ? sine_texture(amplitude_m, wave_m) : TextureBinding(); };
                Stroke stroke(with_probe(joined({wedge.floor(floor_n_per_m, floor_friction, texture()),
                                                 wedge.wall(wall_n_per_m, wall_friction)}),
                                         kind),
                              rest_m(kind, wedge.between()));
                stroke.to(3e-3 * wedge.between());
                wander(stroke, 8e-3, depth_m, 60, 5);
                CAPTURE(degrees, static_cast<int>(kind), textured, floor_friction, wall_friction);
                CAPTURE(stroke.largest_at_m().x, stroke.largest_at_m().y, stroke.largest_at_m().z);
                const int ends = kind == ProbeKind::gripper ? 2 : 1;
                const double friction = std::max(floor_friction, wall_friction);
                double bound_n = (floor_n_per_m + wall_n_per_m) * step_m / std::sin(wedge.radians()) * (1 + friction);
                if (textured) bound_n *= 1 + 2 * slope + 2 * depth_m * bend_per_m;
                // Held by friction the proxy is borne by one of the two, until the other takes over at once: the step
                // is that between the materials, of stiffness or of friction.
                const double farthest_m = std::sqrt(2.0) * depth_m;
                if (friction > 0)
                    bound_n += std::abs(floor_n_per_m - wall_n_per_m) * farthest_m * (1 + friction) +
                               std::abs(floor_friction - wall_friction) * wall_n_per_m * farthest_m;
                CHECK(stroke.largest_n() < ends * bound_n);
                CHECK(stroke.both() > 1000);
            }
}

TEST_CASE("no force steps in a corner of three objects, and each pushes against its own depth")
{
    const dvec3 normals[] = {{0, 0, 1}, glm::normalize(dvec3(-1, 0.2, 0.3)), glm::normalize(dvec3(-0.3, -1, -0.2))};
    const double stiffness_n_per_m[] = {250, 1200, 600};
    const double volume = glm::dot(normals[0], glm::cross(normals[1], normals[2]));
    double bound_n = 0;
    dvec3 duals[3];
    std::vector<SceneObject> objects;
    for (int i = 0; i < 3; ++i) {
        duals[i] = glm::cross(normals[(i + 1) % 3], normals[(i + 2) % 3]) / volume;
        bound_n += stiffness_n_per_m[i] * glm::length(duals[i]) * step_m;
        const dvec3 along = glm::normalize(glm::cross(normals[i], glm::cross(duals[i], normals[i]) + dvec3(0.1)));
        objects.push_back(behind(dvec3(0), normals[i], along, stiffness_n_per_m[i]));
    }
    for (const ProbeKind kind : every_probe) {
        const dvec3 into_free = glm::normalize(duals[0] + duals[1] + duals[2]);
        const dvec3 rest = kind == ProbeKind::gripper ? 0.01 * into_free : 0.05 * into_free;
        Stroke stroke(with_probe(joined(objects), kind), rest);
        stroke.to(3e-3 * into_free);
        wander(stroke, 2.5e-3, 2.5e-3, 150, 3);
        CAPTURE(static_cast<int>(kind), stroke.largest_at_m().x, stroke.largest_at_m().y, stroke.largest_at_m().z);
        CHECK(stroke.largest_n() < 1.01 * bound_n);
        CHECK(stroke.touching() > 10000);

        stroke.to(3e-3 * into_free);
        if (kind != ProbeKind::point) continue;
        const dvec3 depths_m(1e-3, 5e-4, 2e-3);
        dvec3 hand_m(0), force_n(0);
        for (int i = 0; i < 3; ++i) {
            hand_m -= depths_m[i] * normals[i];
            force_n += stiffness_n_per_m[i] * depths_m[i] * normals[i];
        }
        stroke.to(hand_m);
        CHECK(stroke.felt().contacts == 3);
        CHECK(glm::distance(stroke.force_n(), force_n) < 1e-7);
    }
}

TEST_CASE("over a seam or a ridge between two objects the force changes as over one mesh, and by their materials")
{
    constexpr double depth_m = 1e-3;
    for (const double drop_deg : {0.0, 10.0, 40.0}) // of the second's top
        for (const auto& [k1, k2] : {std::pair{500.0, 500.0}, {300.0, 900.0}, {900.0, 300.0}})
            for (const ProbeKind kind : every_probe) {
                const double drop = glm::radians(drop_deg);
                const dvec3 along(std::cos(drop), 0, -std::sin(drop)), normal(std::sin(drop), 0, std::cos(drop));
                Stroke stroke(with_probe(joined({behind({-0.05, 0, 0}, {0, 0, 1}, {1, 0, 0}, k1),
                                                 behind(0.05 * along, normal, along, k2)}),
                                         kind),
                              rest_m(kind, {0, 0, 1}));
                const double radius_m = kind == ProbeKind::sphere ? 1e-3 : 0;
                const auto over = [&](double x_m, double deep_m) {
                    return x_m <= 0 ? dvec3(x_m, 1e-3, radius_m - deep_m)
                                    : x_m * along + dvec3(0, 1e-3, 0) + (radius_m - deep_m) * normal;
                };
                stroke.to(over(-5e-3, -1e-3));
                for (const double x_m : {-5e-3, 0.0, 5e-3, 0.0, -5e-3}) stroke.to(over(x_m, depth_m));
                CAPTURE(drop_deg, k1, k2, static_cast<int>(kind), stroke.largest_at_m().x, stroke.largest_at_m().y,
                        stroke.largest_at_m().z);
                const int ends = kind == ProbeKind::gripper ? 2 : 1;
                // A proxy that comes to a ridge slides on to the foot of the hand behind it.
                const double slides_n = std::max(k1, k2) * depth_m * std::tan(drop),
                             deepest_m = depth_m / std::cos(drop);
                CHECK(stroke.largest_n() <
                      ends * (std::abs(k1 - k2) * deepest_m + slides_n + 2 * std::max(k1, k2) * step_m));
                if (drop_deg == 0 && k1 == k2) CHECK(stroke.largest_n() < 1.01 * ends * k1 * depth_m / 10);
                CHECK(stroke.touching() > 500);
            }
}

TEST_CASE("a ball rolls over the eaves of a roof that lies on a box, whichever is written first, without a step")
{
    constexpr double radius_m = 2e-3, depth_m = 5e-4, hard = 2000;
    const dvec3 eaves(0.03, 0.007, 0), slope = glm::normalize(dvec3(-1, 0, 1));
    Mesh prism;
    for (const double y : {-0.05, 0.05})
        for (const dvec3& corner : {dvec3(-0.03, y, 0), dvec3(0.03, y, 0), dvec3(0, y, 0.03)})
            prism.positions_m.push_back(corner);
    prism.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
    for (const bool roof_first : {false, true}) {
        std::vector<SceneObject> objects = {object(make_box({0.06, 0.1, 0.04}), {glm::dmat3(1), {0, 0, -0.02}}, 1000),
                                            object(prism, {}, hard)};
        if (roof_first) std::reverse(objects.begin(), objects.end());
        Scene scene = joined(std::move(objects));
        scene.probe = {ProbeKind::sphere, 0.05, radius_m};
        Stroke stroke(scene, dvec3(0));
        const double off_m = radius_m - depth_m;
        stroke.to(eaves + dvec3(5e-3, 0, -6e-3));
        stroke.to(eaves + dvec3(off_m, 0, -6e-3));
        constexpr int turns = 100;
        for (int i = 0; i <= turns; ++i) {
            const double angle = glm::radians(45.0) * i / turns;
            stroke.to(eaves + off_m * dvec3(std::cos(angle), 0, std::sin(angle)));
        }
        stroke.to(eaves + off_m * glm::normalize(dvec3(1, 0, 1)) + 5e-3 * slope);
        CAPTURE(roof_first, stroke.largest_at_m().x, stroke.largest_at_m().z);
        CHECK(stroke.largest_n() < 3 * hard * step_m);
        CHECK(stroke.touching() > 400);
    }
}

TEST_CASE("each finger of a gripper, and each end of a stylus, has the friction of what it touches itself")
{
    constexpr double stiffness_n_per_m = 500, depth_m = 1e-3, apart_m = 0.05;
    for (const ProbeKind kind : {ProbeKind::gripper, ProbeKind::stylus}) {
        Stroke stroke(with_probe(joined({behind({-0.05, 0, 0}, {0, 0, 1}, {1, 0, 0}, stiffness_n_per_m, 0.1),
                                         behind({0.05, 0, 0}, {0, 0, 1}, {1, 0, 0}, stiffness_n_per_m, 0.8)}),
                                 kind),
                      {apart_m, 0, 0});
        stroke.to({-0.5 * apart_m, 0, 1e-3});
        stroke.to({-0.5 * apart_m, 0, -depth_m});
        stroke.to({-0.5 * apart_m, 5e-3, -depth_m});
        CHECK(stroke.felt().contacts == 2);
        const double each_n = stiffness_n_per_m * depth_m;
        CHECK(glm::distance(stroke.force_n(), dvec3(0, -(0.1 + 0.8) * each_n, 2 * each_n)) < 1e-6);
    }
}

TEST_CASE("in a shallow valley of two objects a texture reaches as deep, and damps as much, as in one mesh")
{
    constexpr double stiffness = 1000, damping = 5, below_m = 1e-4, deep_m = 3e-3;
    const TextureBinding lowered = lambda_texture(
        [](const haptel_point&, dvec3& gradient) { return gradient = dvec3(0), 0.0; }, -below_m, below_m);
    const Wedge wedge{174};
    const double half = std::cos(glm::radians(3.0)); // each normal along the way out
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus}) {
        CAPTURE(static_cast<int>(kind));
        std::vector<SceneObject> objects = {wedge.floor(stiffness, 0, lowered), wedge.wall(stiffness, 0, lowered)};
        for (SceneObject& one : objects) one.material.damping_n_s_per_m = damping;
        const Scene scene = with_probe(joined(std::move(objects)), kind);
        const dvec3 rests_m = scene.probe.radius_m / half * wedge.between();
        Stroke stroke(scene, rest_m(kind, wedge.between()));
        stroke.to(rests_m + deep_m * wedge.between());
        stroke.to(rests_m - deep_m * wedge.between());
        CHECK(stroke.felt().contacts == 2);
        const double speed_m_per_s = step_m * scene.servo.rate_hz;
        const dvec3 moving_n = (stiffness * (deep_m - below_m / half) + damping * speed_m_per_s) * wedge.between();
        CHECK(glm::distance(stroke.force_n(), moving_n) < 1e-6);
        // Little deeper than the texture, and no notch on the way there.
        const dvec3 valley_m = rests_m - 3 * below_m * wedge.between();
        stroke.to(valley_m + dvec3(-2e-3, 0, 0));
        const double before_n = stroke.largest_n();
        for (int i = 0; i < 100; ++i) stroke.to(valley_m); // until its speed is forgotten
        CHECK(stroke.largest_n() == before_n);
        const dvec3 resting_n = stiffness * (3 * below_m - below_m / half) * wedge.between();
        CHECK(glm::distance(stroke.force_n(), resting_n) < 1e-6);
    }
}

TEST_CASE("a magnet beside what the hand presses on pulls without a step, and a closed path gives nothing")
{
    constexpr double stiffness = 1000;
    constexpr Magnet magnet{1, 5e-3};
    for (const double degrees : {60.0, 90.0, 120.0, 180.0})
        for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere})
            for (const bool back : {false, true}) {
                const Wedge wedge{degrees};
                std::vector<SceneObject> objects = {wedge.floor(stiffness), wedge.wall(stiffness)};
                objects[1].effects.magnet = magnet;
                Stroke stroke(with_probe(joined(std::move(objects)), kind), dvec3(0));
                const dvec3 up = {-std::cos(wedge.radians()), 0, std::sin(wedge.radians())};
                std::vector<dvec3> corners = {{-12e-3, 0, 8e-3},
                                              {-12e-3, 0, -2e-3},
                                              -2.5e-3 * wedge.between(),
                                              12e-3 * up - 1e-3 * wedge.wall_normal(),
                                              12e-3 * up + 8e-3 * wedge.wall_normal(),
                                              {-12e-3, 0, 8e-3}};
                if (back) std::reverse(corners.begin(), corners.end());
                for (const dvec3& corner : corners) stroke.to(corner);
                CAPTURE(degrees, static_cast<int>(kind), back, stroke.given_j(), stroke.largest_n());
                CHECK(stroke.largest_n() < 1.001 * stiffness * step_m); // the springs' alone
                // By the tick that the aim is behind; a spring whose force waits for the next tick gives 20 times that.
                CHECK(std::abs(stroke.given_j()) < 2e-3 * magnet.energy_j(magnet.reach_m));
                CHECK(stroke.touching() > 500);
            }
}

TEST_CASE("a magnet under an edge, or in a groove, of what the hand presses on gives nothing on closed paths")
{
    constexpr double stiffness = 1000, tick_m = 5e-6; // what the tick gives that the aim is behind falls with it
    constexpr Magnet magnet{1, 5e-3};
    for (const double degrees : {60.0, 90.0, 250.0, 290.0}) // grooves and ridges
        for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere}) {
            const Wedge wedge{degrees};
            const bool is_groove = degrees < 180;
            std::vector<SceneObject> objects = {wedge.floor(stiffness), wedge.wall(stiffness)};
            if (is_groove) { // its edge looks out of the bottom
                objects.push_back(
                    object(make_box({2e-3, 0.1, 2e-3}), {glm::dmat3(1), -2e-4 * wedge.between()}, stiffness));
            } else { // it cuts the ridge off below
                objects.push_back(behind(-3e-3 * wedge.between(), -wedge.between(), glm::dvec3(0, 1, 0), stiffness));
            }
            objects[2].effects.magnet = magnet;
            const Scene scene = with_probe(joined(std::move(objects)), kind);
            std::mt19937_64 random(11);
            std::uniform_real_distribution<double> uniform(-1, 1);
            double worst_j = 0;
            int touching = 0;
            for (int path = 0; path < test::tries(10); ++path) {
                Stroke stroke(scene, dvec3(0), tick_m);
                stroke.to(12e-3 * wedge.between());
                for (int i = 0; i < 6; ++i)
                    stroke.to({5e-3 * uniform(random), 2e-3 * uniform(random), 5e-3 * uniform(random)});
                stroke.to(12e-3 * wedge.between());
                worst_j = std::max(worst_j, stroke.given_j());
                touching += stroke.touching();
            }
            CAPTURE(degrees, static_cast<int>(kind), worst_j, touching);
            CHECK(touching > test::tries(20'000));
            CHECK(worst_j < 2e-3 * magnet.force_n * magnet.reach_m);
        }
}
