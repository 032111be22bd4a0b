// Objects that move in all ways, and a hand that comes to them in all ways.
#pragma once

#include "runtime/scene/motion.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace haptel::tests {

// Any function of time, of which nobody knows where it goes.
class Unforeseen final : public runtime::Motion {
public:
    using Script = std::function<std::optional<runtime::Placement>(double)>;
    explicit Unforeseen(Script script) : script_(std::move(script)) {}
    std::optional<runtime::Placement> at(double time_s) const noexcept override { return script_(time_s); }

private:
    Script script_;
};

inline glm::dmat3 turn_about(const glm::dvec3& axis, double angle_rad)
{
    return glm::dmat3(glm::rotate(glm::dmat4(1), angle_rad, axis));
}

// 36 objects, 3 cm to 30 cm from each other: boxes and balls with effects and without, at rest, turning and swinging
// slowly and fast, too fast for a tick, about axes through them and beside them, and going where nobody knows.
inline runtime::Scene moving_field(unsigned seed)
{
    using namespace runtime;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double size) {
        return size * glm::dvec3(uniform(random), uniform(random), uniform(random));
    };
    Scene scene = bare_scene(shape("box", 0.02));
    SceneObject first = scene.objects[0];
    first.material = {1000, 4, 0.3, 0.2};
    scene.objects.clear();
    Mesh beside = shape("icosphere", 0.02); // its axis
    for (glm::dvec3& position : beside.positions_m) position += glm::dvec3(0.04, 0, 0.01);
    const std::shared_ptr<const Surface> surfaces[] = {first.surface, build_surface(beside).surface,
                                                       build_surface(shape("icosphere", 0.03)).surface};
    for (int i = 0; i < 36; ++i) {
        SceneObject object = first;
        object.surface = surfaces[i % 3];
        object.texture = std::make_shared<TextureSlot>();
        object.placement = {turn_about(vector(1), uniform(random)), glm::dvec3(0.1 * (i % 6), 0.1 * (i / 6), 0)};
        if (i % 7 == 1) object.effects.magnet = {0.5, 0.02};
        if (i % 7 == 2) object.effects.damping_n_s_per_m = 1, object.effects.damping_reach_m = 0.02;
        if (i % 7 == 3) object.effects.vibration = {0.3, 40, {0, 0, 1}}, object.effects.vibration_reach_m = 0.02;
        const double fast = std::pow(10.0, 1.5 * uniform(random));
        const Placement start = object.placement;
        const glm::dvec3 axis = vector(1), swing_m = vector(0.02);
        const SteadyMotion steady(start, {axis, i % 4 ? fast : 0, i % 3 ? swing_m : glm::dvec3(0), 0.3 * fast});
        if (i % 5 < 3) object.motion = std::make_shared<SteadyMotion>(steady);
        if (i % 5 == 3)
            object.motion = std::make_shared<Unforeseen>([=](double time_s) -> std::optional<Placement> {
                const long tick = std::lround(time_s * 1000);
                if (tick % 11 == 3) return std::nullopt;
                if (tick % 11 == 7) return Placement{glm::dmat3(std::numeric_limits<double>::quiet_NaN()), {}};
                Placement now = *steady.at(time_s);
                if (tick / 500 % 3 == 1) now.position_m += 0.3 * std::sin(time_s) * axis;
                return now;
            });
        if (i == 20) object.motion = std::make_shared<SteadyMotion>(start, SteadyMotion::Figures{axis, 300, {}, 0});
        scene.objects.push_back(std::move(object));
    }
    return scene;
}

// Slowly from object to object and into them, away and back, with jumps, late ticks, poses that are none, and breaks.
inline std::vector<runtime::DevicePose> wild_hand(unsigned seed, int ticks, const runtime::ProbeSettings& probe)
{
    std::mt19937 random(seed + 100);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<runtime::DevicePose> poses;
    glm::dvec3 place(0), goal(0), along(0, 0, 1), lean(0, 0, 1);
    double step_m = 1e-4;
    for (int i = 0; i < ticks; ++i) {
        if (i % 150 == 0) {
            goal = {0.1 * std::floor(6 * uniform(random)), 0.1 * std::floor(6 * uniform(random)), 0};
            goal += 0.03 * glm::dvec3(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
            if (uniform(random) < 0.2) goal.z += 2 * uniform(random);
            lean = glm::normalize(glm::dvec3(uniform(random) - 0.5, uniform(random) - 0.5, 0.2 + uniform(random)));
            step_m = std::pow(10.0, -4 + 3.5 * uniform(random));
        }
        const glm::dvec3 way = goal - place;
        const double length = glm::length(way);
        place = length <= step_m ? goal : place + way * (step_m / length);
        along = glm::normalize(along + 0.01 * (lean - along));
        runtime::DevicePose pose{place, place + probe.length_m * along};
        if (i % 400 == 399) pose.periods = static_cast<uint64_t>(1 + std::floor(200 * std::pow(uniform(random), 4)));
        if (i % 900 == 450) pose.interrupted = true;
        if (i % 700 > 697) pose.tip_m.x = std::numeric_limits<double>::quiet_NaN();
        poses.push_back(pose);
    }
    return poses;
}

} // namespace haptel::tests
