// Viscous media, held to closed forms, and what they do with energy.
#include "runtime/force/viscosity.h"
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

constexpr double tick_s = 1e-3;

Scene viscous(double damping_n_s_per_m)
{
    Scene scene = bare_scene(plane_mesh());
    Region region;
    region.damping_n_s_per_m = damping_n_s_per_m;
    scene.regions.push_back(region);
    return scene;
}

} // namespace

TEST_CASE("at a steady speed a viscous medium holds back with damping times speed")
{
    constexpr double damping = 3, speed = 0.05;
    Renderer renderer(shared(viscous(damping)));
    const double left = damping / (damping + trail_stiffness_n_per_m * tick_s);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 force = renderer.tick(at(0, i * speed * tick_s, 0.02)).force_n;
        CHECK(std::fabs(force.y + damping * speed * (1 - std::pow(left, i))) < 1e-12);
        CHECK((force.x == 0 && force.z == 0));
    }
    // Missed deadlines: as if the way had been gone evenly.
    Trail each(tick_s, trail_stiffness_n_per_m), late(tick_s, trail_stiffness_n_per_m);
    for (int i = 0; i <= 50; ++i) each.update({i * 1e-4, 0, 0}, damping, 1);
    glm::dvec3 force(0);
    for (int i = 0; i <= 50; i += 5) force = late.update({i * 1e-4, 0, 0}, damping, i == 0 ? 1 : 5);
    CHECK(glm::distance(force, each.update({50 * 1e-4, 0, 0}, damping, 1) * (damping + 0.4) / damping) < 1e-9);
}

TEST_CASE("what a viscous medium takes of a hand that goes to and fro is what its spring and damper in a row take")
{
    using Complex = std::complex<double>;
    constexpr double k = trail_stiffness_n_per_m, amplitude_m = 0.01;
    for (const double damping : {0.1, 1.0, 5.0, 50.0})
        for (const int ticks_per_cycle : {1000, 100, 20, 4}) {
            Renderer renderer(shared(viscous(damping)));
            const auto x = [&](int i) { return amplitude_m * std::cos(2 * std::numbers::pi * i / ticks_per_cycle); };
            double given_j = 0, force_n = 0;
            const int settle = 40 * ticks_per_cycle + 2000;
            for (int i = 0; i <= settle + ticks_per_cycle; ++i) {
                if (i > settle) given_j += force_n * (x(i) - x(i - 1));
                force_n = renderer.tick(at(x(i), 0, 0.02)).force_n.x;
            }
            const Complex z = std::polar(1.0, 2 * std::numbers::pi / ticks_per_cycle);
            const double left = damping / (damping + k * tick_s);
            const Complex force = -k * left * (1.0 - 1.0 / z) / (1.0 - left / z) * amplitude_m;
            const double wanted_j = ticks_per_cycle / 2.0 * std::real(force * std::conj((z - 1.0) * amplitude_m));
            CAPTURE(damping, ticks_per_cycle, given_j, wanted_j);
            CHECK(std::fabs(given_j - wanted_j) < 1e-9 * (1 + std::fabs(wanted_j)));
            const double bound_j = k / 2 * ticks_per_cycle * std::norm((z - 1.0) * amplitude_m) / 2;
            CHECK(given_j <= bound_j * (1 + 1e-9));
            if (ticks_per_cycle == 1000 && damping <= 1) {               // slow: damping times speed squared
                const double speed = amplitude_m * 2 * std::numbers::pi; // largest, in one second
                CHECK(std::fabs(given_j / (-damping * speed * speed / 2) - 1) < 0.01);
            }
        }
}

TEST_CASE("no viscosity shakes a device whose own damping holds its trail; a damper of its strength does")
{
    constexpr double mass_kg = 0.075;
    const auto speed_after = [&](double viscosity, bool by_trail, double own_damping) {
        Trail trail(tick_s, trail_stiffness_n_per_m);
        double x = 0, v = 0.3, last_x = 0, largest_j = 0;
        const double kept = std::exp(-own_damping / mass_kg * tick_s);
        for (int i = 0; i < 20000 && std::fabs(v) < 1e6; ++i) {
            const double force =
                by_trail ? trail.update({x, 0, 0}, viscosity, 1).x : -viscosity * (x - last_x) / tick_s;
            last_x = x;
            // Exact for a force that is held: m dv/dt = force - own_damping v
            const double v_end = force / own_damping;
            x += v_end * tick_s + (v - v_end) * (1 - kept) * mass_kg / own_damping;
            v = v_end + (v - v_end) * kept;
            if (i > 19000) largest_j = std::max(largest_j, mass_kg / 2 * v * v);
        }
        return std::sqrt(2 * largest_j / mass_kg) + (std::fabs(v) < 1e6 ? 0 : v * v);
    };
    for (const double viscosity : {0.5, 5.0, 50.0, 500.0, 5000.0}) {
        CAPTURE(viscosity);
        CHECK(speed_after(viscosity, true, 0.3) < 1e-3); // above k T / 2 = 0.2
    }
    CHECK(speed_after(5000, true, 0.1) > 1); // below
    CHECK(speed_after(500, false, 0.3) > 1e6);
}

TEST_CASE("a region has its medium inside, grown from its border inward")
{
    Region ball;
    ball.shape = RegionShape::ball;
    ball.half_sides_m = glm::dvec3(0.02);
    ball.edge_m = 5e-3;
    ball.placement.position_m = {0.1, 0, 0};
    Region box = ball;
    box.shape = RegionShape::box;
    box.half_sides_m = {0.02, 0.01, 0.03};
    box.placement.rotation = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}; // x to y
    const auto near = [](double a, double b) { return std::fabs(a - b) < 1e-12; };
    CHECK(near(ball.share_at({0.1, 0, 0}), 1));
    CHECK(near(ball.share_at({0.1, 0.015, 0}), 1));
    CHECK(near(ball.share_at({0.1, 0, 0.018}), 0.4));
    CHECK(ball.share_at({0.1, 0.0201, 0}) == 0);
    CHECK(near(box.share_at({0.1, 0.019, 0}), 0.2)); // its x
    CHECK(near(box.share_at({0.107, 0.0, 0}), 0.6)); // its y
    CHECK(near(box.share_at({0.1, 0.0, -0.026}), 0.8));
    CHECK(box.share_at({0.1, 0.0, -0.031}) == 0);

    Scene scene = bare_scene(plane_mesh());
    ball.damping_n_s_per_m = 4;
    scene.regions.push_back(ball);
    Renderer renderer(shared(std::move(scene)));
    constexpr double speed = 0.02;
    glm::dvec3 last(0);
    for (double x = 0.05; x < 0.15; x += speed * tick_s) {
        const glm::dvec3 force = renderer.tick(at(x, 0, 0.001)).force_n;
        if (std::fabs(x - 0.1) > 0.0205) CHECK(force == glm::dvec3(0));
        if (std::fabs(x - 0.1) < 0.005) CHECK(std::fabs(force.x + 4 * speed) < 1e-9);
        CHECK(std::fabs(force.x - last.x) < 4 * speed * (speed * tick_s / 5e-3) * 1.5);
        last = force;
    }
}

TEST_CASE("around an object the medium grows toward its surface, and is full in touch")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].effects.damping_n_s_per_m = 2;
    scene.objects[0].effects.damping_reach_m = 0.01;
    Renderer renderer(shared(std::move(scene)));
    constexpr double speed = 0.03;
    for (const double z : {0.012, 0.005, 0.002, -0.001}) {
        glm::dvec3 force(0);
        for (int i = 0; i < 400; ++i) force = renderer.tick(at(-0.01 + i * speed * tick_s, 0, z)).force_n;
        const double share = z > 0.01 ? 0 : z > 0 ? 1 - z / 0.01 : 1;
        CAPTURE(z);
        CHECK(std::fabs(force.x + 2 * share * speed) < 1e-9);
        renderer.tick(at(-0.01, 0, 0.05));
        for (int i = 0; i < 200; ++i) renderer.tick(at(-0.01, 0, z > 0 ? z : 0.0005));
    }
}
