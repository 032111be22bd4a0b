// Damping acts: what is dropped on a wall leaves it as much slower as the law of the damper says; and limits are on.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <memory>
#include <utility>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

struct Drop {
    double mass_kg, stiffness_n_per_m, damping_n_s_per_m, entry_m_per_s;
};

// Exit over entry speed of a mass that flies into the plane and is thrown back by what the renderer says.
double exit_over_entry(const Drop& drop, double rate_hz)
{
    Scene scene = bare_scene(plane_mesh(10));
    scene.objects[0].material = {drop.stiffness_n_per_m, drop.damping_n_s_per_m, 0, 0};
    scene.servo.rate_hz = rate_hz;
    scene.servo.force_limit_n = 100;
    Renderer renderer(shared(std::move(scene)));
    const double period_s = 1 / rate_hz;
    double z = 0.05 * drop.entry_m_per_s, speed = -drop.entry_m_per_s; // 50 ms to go: the low-pass knows the speed
    while (z <= 0 || speed <= 0) {
        const double acceleration = renderer.tick(at(0.1, 0.2, z)).force_n.z / drop.mass_kg;
        z += (speed + 0.5 * acceleration * period_s) * period_s; // exact while the force is held
        speed += acceleration * period_s;
        REQUIRE(z > -4);
    }
    return speed / drop.entry_m_per_s;
}

// A heavy mass on a soft spring, about three seconds of contact: neither the period nor the low-pass of the speed is
// felt.
Drop slow_drop(double damping_n_s_per_m, double entry_m_per_s)
{
    constexpr double scale = 0.01; // of all forces, so that none reaches the limit
    return {1000 * scale, 1000 * scale, damping_n_s_per_m * scale, entry_m_per_s};
}

} // namespace

TEST_CASE("anchors row 6: a drop leaves a damped wall at the speed of a damped spring")
{
    // m x'' + b x' + K x = 0 from x = 0, left where the force is zero, for it never pulls: at the angle phi.
    double before = 1;
    for (const double damping_ratio : {0.0, 0.05, 0.2, 0.5, 0.8}) {
        const double z = damping_ratio, w = std::sqrt(1 - z * z), phi = std::atan2(2 * z * w, 2 * z * z - 1);
        const double expected = std::exp(-z * phi / w);
        const Drop drop = slow_drop(2 * z * 1000, 2); // 2 m deep: damping sets in over the first millimetre
        const double found = exit_over_entry(drop, 10'000);
        CAPTURE(damping_ratio, expected, found);
        CHECK(std::abs(found - expected) < 5e-4);
        CHECK((found < before || damping_ratio == 0));
        before = found;
    }
}

TEST_CASE("anchors row 6: a drop that stays shallow leaves at the speed of Hunt and Crossley")
{
    // m v dv/dx = -(K + c v) x with c = b / 1 mm; between entry v and exit e v the integral of v / (K + c v) is 0:
    // a - ln(1 + a) = -a e - ln(1 - a e) with a = c v / K.
    const double entry_m_per_s = 0.8e-3;
    double before = 1;
    for (const double damping_n_s_per_m : {100.0, 500.0, 1000.0, 3000.0}) {
        const double a = damping_n_s_per_m / full_damping_depth_m * entry_m_per_s / 1000;
        const auto difference = [a](double e) { return (-a * e - std::log(1 - a * e)) - (a - std::log(1 + a)); };
        double low = 0, high = std::min(1.0, (1 - 1e-12) / a);
        for (int i = 0; i < 100; ++i) {
            const double middle = (low + high) / 2;
            (difference(middle) < 0 ? low : high) = middle;
        }
        const double found = exit_over_entry(slow_drop(damping_n_s_per_m, entry_m_per_s), 10'000);
        CAPTURE(damping_n_s_per_m, low, found);
        CHECK(std::abs(found - low) < 5e-4);
        CHECK(found < before);
        before = found;
    }
}

TEST_CASE(
    "anchors row 6: at 1 kHz, too, a drop leaves the slower the more damping there is, that of a new scene included")
{
    for (const double stiffness_n_per_m : {200.0, 800.0, 2000.0}) {
        double before = exit_over_entry({0.1, stiffness_n_per_m, 0, 0.3}, 1000);
        for (const double damping_n_s_per_m : {Material{}.damping_n_s_per_m, 2.0, 4.0}) {
            const double found = exit_over_entry({0.1, stiffness_n_per_m, damping_n_s_per_m, 0.3}, 1000);
            CAPTURE(stiffness_n_per_m, damping_n_s_per_m, before, found);
            CHECK(found < before - 0.02);
            before = found;
        }
    }
}

TEST_CASE("anchors row 6: limits are on by default")
{
    Scene scene;
    SceneObject object;
    object.surface = build_surface(plane_mesh(10)).surface;
    scene.objects.push_back(object);
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0.1, 0.2, 0.1));
    TickResult first = renderer.tick(at(0.1, 0.2, -2)), last;
    CHECK(first.unlimited_force_n.z > 1500);
    CHECK(glm::length(first.force_n) <= 7);
    for (int i = 0; i < 1000; ++i) last = renderer.tick(at(0.1, 0.2, -2));
    CHECK(last.unlimited_force_n.z > 1500);
    CHECK(std::abs(last.force_n.z - 7) < 1e-12); // newtons, ServoSettings
}
