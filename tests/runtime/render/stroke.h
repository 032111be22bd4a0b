// Strokes of the hand over objects at rest that meet, and the largest change of the force between ticks.
#pragma once

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

namespace haptel::tests {

using namespace haptel::runtime;
using glm::dvec3;

inline constexpr double step_m = 20e-6; // of the hand in a tick
inline constexpr ProbeKind every_probe[] = {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus, ProbeKind::gripper};

inline SceneObject object(const Mesh& mesh, const Placement& placement, double stiffness_n_per_m, double friction = 0,
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
inline Scene joined(std::vector<SceneObject> objects)
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
inline SceneObject behind(const dvec3& place_m, const dvec3& normal, const dvec3& along, double stiffness_n_per_m,
                          double friction = 0, TextureBinding texture = {})
{
    constexpr double size_m = 0.1;
    const glm::dmat3 rotation(along, glm::cross(normal, along), normal);
    return object(make_box(dvec3(size_m)), {rotation, place_m - 0.5 * size_m * normal}, stiffness_n_per_m, friction,
                  std::move(texture));
}

inline Scene with_probe(Scene scene, ProbeKind kind)
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

inline dvec3 rest_m(ProbeKind kind, const dvec3& shaft)
{
    return kind == ProbeKind::gripper ? dvec3(0, 0.01, 0) : 0.05 * shaft;
}

// Everywhere around the line from -reach to reach on the y axis, in and out of what is there.
inline void wander(Stroke& stroke, double reach_m, double depth_m, int strokes, uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < strokes; ++i)
        stroke.to({depth_m * uniform(random), reach_m * uniform(random), depth_m * uniform(random)});
}

} // namespace haptel::tests
