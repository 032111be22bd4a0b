// What is felt beside contact, held to closed forms, and what it does with energy.
#include "runtime/allocation_count.h"
#include "runtime/renderer.h"
#include "runtime/surface_distance.h"
#include "runtime/viscosity.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

constexpr double pi = 3.141592653589793;
constexpr double period_s = 1e-3;

// By projection on the plane and on the three edges: not how the runtime does it.
double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const auto inside = [&](const glm::dvec3& u, const glm::dvec3& v) {
        return glm::dot(glm::cross(v - u, p - u), n) >= 0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) return std::fabs(glm::dot(p - a, n)) / glm::length(n);
    const auto to_edge = [&](const glm::dvec3& u, const glm::dvec3& v) {
        const double t = std::clamp(glm::dot(p - u, v - u) / glm::dot(v - u, v - u), 0.0, 1.0);
        return glm::distance(p, u + t * (v - u));
    };
    return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

double distance_to(const Surface& surface, const glm::dvec3& p)
{
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t face = 0; face < surface.faces.size(); ++face)
        least = std::min(least, distance_to_triangle(p, surface.vertex_m(face, 0), surface.vertex_m(face, 1),
                                                     surface.vertex_m(face, 2)));
    return least;
}

Mesh shape(const char* name, double size_m)
{
    Mesh mesh = *make_shape(name);
    scale_to_size(mesh, size_m);
    return mesh;
}

Scene magnet_scene(const Mesh& mesh, double force_n, double reach_m)
{
    Scene scene = bare_scene(mesh);
    scene.objects[0].effects.magnet = {force_n, reach_m};
    return scene;
}

Scene vibrating(const Mesh& mesh, double force_n, double frequency_hz, double reach_m)
{
    Scene scene = bare_scene(mesh);
    scene.objects[0].effects.vibration = {force_n, frequency_hz, {1, 0, 0}};
    scene.objects[0].effects.vibration_reach_m = reach_m;
    return scene;
}

Scene viscous(double damping_n_s_per_m)
{
    Scene scene = bare_scene(plane_mesh());
    Region region;
    region.damping_n_s_per_m = damping_n_s_per_m;
    scene.regions.push_back(region);
    return scene;
}

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
        glm::dvec3 p(0.06, 0, 0.02);
        double worst_m = 0;
        int within = 0, wrong = 0;
        constexpr double reach_m = 0.03;
        for (int i = 0; i < 1000; ++i) {
            p = 0.99 * p + (i % 50 == 0 ? 0.03 : 0.002) * glm::dvec3(normal(random), normal(random), normal(random));
            const double truth_m = distance_to(*surface, p);
            const auto found = distance.within(p, reach_m);
            wrong += found.has_value() != (truth_m <= reach_m);
            if (!found) continue;
            ++within;
            worst_m = std::max({worst_m, std::fabs(found->distance_m - truth_m),
                                std::fabs(glm::distance(p, found->point_m) - truth_m)});
        }
        CAPTURE(name, worst_m, distance.queries(), distance.triangles());
        CHECK(wrong == 0);
        CHECK(within > 300);
        CHECK(worst_m < 1e-12);
        CHECK(distance.queries() <= 1000);
        CHECK(distance.triangles() < 150 * distance.queries()); // of 20 480
    }
}

TEST_CASE("a surface that is out of reach is asked once for a long way")
{
    const auto surface = build_surface(shape("icosphere", 0.1)).surface;
    SurfaceDistance distance(surface);
    for (int i = 0; i < 1000; ++i) CHECK_FALSE(distance.within({0.08 + 1e-6 * i, 0, 0}, 0.01));
    CHECK(distance.queries() == 1);
    // In its centre all triangles are equally near: a bound on the work holds, not one on the answer.
    SurfaceDistance inside(build_surface(make_icosphere(6)).surface);
    REQUIRE(inside.within({0, 0, 0}, 2));
    CHECK(inside.triangles() == SurfaceDistance::triangles_max);
    CHECK(std::fabs(inside.within({0, 0, 0}, 2)->distance_m - 0.5) < 1e-3);
}

TEST_CASE("a magnet pulls toward a plate as its potential says, from its reach to the surface")
{
    constexpr double force_n = 2, reach_m = 5e-3;
    Renderer renderer(shared(magnet_scene(plane_mesh(), force_n, reach_m)));
    const Magnet magnet{force_n, reach_m};
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
        if (x > 0.01 && x < 0.99) { // minus the derivative of the energy
            const double slope_n = (magnet.energy_j(z + 1e-7) - magnet.energy_j(z - 1e-7)) / 2e-7;
            CHECK(std::fabs(force.z + slope_n) < 1e-6);
        }
    }
    CHECK(std::fabs(largest_n - force_n) < 1e-4);
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
            const double t = 2 * pi * i / steps;
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
            const double t = 2 * pi * i / steps, r = 0.08 + 0.02 * std::sin(3 * t);
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

TEST_CASE("at a steady speed a viscous medium holds back with damping times speed")
{
    constexpr double damping = 3, speed = 0.05;
    Renderer renderer(shared(viscous(damping)));
    const double left = damping / (damping + trail_stiffness_n_per_m * period_s);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 force = renderer.tick(at(0, i * speed * period_s, 0.02)).force_n;
        CHECK(std::fabs(force.y + damping * speed * (1 - std::pow(left, i))) < 1e-12);
        CHECK((force.x == 0 && force.z == 0));
    }
    // Missed deadlines: as if the way had been gone evenly.
    Trail each(period_s, trail_stiffness_n_per_m), late(period_s, trail_stiffness_n_per_m);
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
            const auto x = [&](int i) { return amplitude_m * std::cos(2 * pi * i / ticks_per_cycle); };
            double given_j = 0, force_n = 0;
            const int settle = 40 * ticks_per_cycle + 2000;
            for (int i = 0; i <= settle + ticks_per_cycle; ++i) {
                if (i > settle) given_j += force_n * (x(i) - x(i - 1));
                force_n = renderer.tick(at(x(i), 0, 0.02)).force_n.x;
            }
            const Complex z = std::polar(1.0, 2 * pi / ticks_per_cycle);
            const double left = damping / (damping + k * period_s);
            const Complex force = -k * left * (1.0 - 1.0 / z) / (1.0 - left / z) * amplitude_m;
            const double wanted_j = ticks_per_cycle / 2.0 * std::real(force * std::conj((z - 1.0) * amplitude_m));
            CAPTURE(damping, ticks_per_cycle, given_j, wanted_j);
            CHECK(std::fabs(given_j - wanted_j) < 1e-9 * (1 + std::fabs(wanted_j)));
            const double bound_j = k / 2 * ticks_per_cycle * std::norm((z - 1.0) * amplitude_m) / 2;
            CHECK(given_j <= bound_j * (1 + 1e-9));
            if (ticks_per_cycle == 1000 && damping <= 1) { // slow: damping times speed squared
                const double speed = amplitude_m * 2 * pi; // largest, in one second
                CHECK(std::fabs(given_j / (-damping * speed * speed / 2) - 1) < 0.01);
            }
        }
}

TEST_CASE("a stylus feels by its tip what a point feels, and its grip feels the torque of that")
{
    const auto scene = [](ProbeKind probe) {
        Scene s = magnet_scene(shape("icosphere", 0.1), 1, 0.02);
        s.objects[0].effects.damping_n_s_per_m = 2;
        s.objects[0].effects.damping_reach_m = 0.03;
        Region region;
        region.damping_n_s_per_m = 1;
        s.regions.push_back(region);
        s.probe = {probe, 0.1, 0};
        return shared(std::move(s));
    };
    Renderer point(scene(ProbeKind::point)), stylus(scene(ProbeKind::stylus));
    double largest_n = 0;
    for (int i = 0; i < 1000; ++i) {
        const double t = i * 0.003;
        const glm::dvec3 tip = (0.062 + 0.008 * std::sin(5 * t)) * glm::dvec3(std::cos(t), std::sin(t), 0);
        const glm::dvec3 tail = tip * (1 + 0.1 / glm::length(tip));
        const TickResult a = point.tick({tip, tail}), b = stylus.tick({tip, tail});
        REQUIRE(b.contacts == 0);
        CHECK(glm::distance(a.force_n, b.force_n) < 1e-12);
        CHECK(glm::distance(b.torque_n_m, glm::cross(tip - tail, b.force_n)) < 1e-12); // held at its tail
        largest_n = std::max(largest_n, glm::length(glm::cross(tip - tail, b.force_n)));
    }
    CHECK(largest_n > 0.005);
}

TEST_CASE("no viscosity shakes a device whose own damping holds its trail; a damper of its strength does")
{
    constexpr double mass_kg = 0.075;
    const auto speed_after = [&](double viscosity, bool by_trail, double own_damping) {
        Trail trail(period_s, trail_stiffness_n_per_m);
        double x = 0, v = 0.3, last_x = 0, largest_j = 0;
        const double kept = std::exp(-own_damping / mass_kg * period_s);
        for (int i = 0; i < 20000 && std::fabs(v) < 1e6; ++i) {
            const double force =
                by_trail ? trail.update({x, 0, 0}, viscosity, 1).x : -viscosity * (x - last_x) / period_s;
            last_x = x;
            // Exact for a force that is held: m dv/dt = force - own_damping v
            const double v_end = force / own_damping;
            x += v_end * period_s + (v - v_end) * (1 - kept) * mass_kg / own_damping;
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
    for (double x = 0.05; x < 0.15; x += speed * period_s) {
        const glm::dvec3 force = renderer.tick(at(x, 0, 0.001)).force_n;
        if (std::fabs(x - 0.1) > 0.0205) CHECK(force == glm::dvec3(0));
        if (std::fabs(x - 0.1) < 0.005) CHECK(std::fabs(force.x + 4 * speed) < 1e-9);
        CHECK(std::fabs(force.x - last.x) < 4 * speed * (speed * period_s / 5e-3) * 1.5);
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
        for (int i = 0; i < 400; ++i) force = renderer.tick(at(-0.01 + i * speed * period_s, 0, z)).force_n;
        const double share = z > 0.01 ? 0 : z > 0 ? 1 - z / 0.01 : 1;
        CAPTURE(z);
        CHECK(std::fabs(force.x + 2 * share * speed) < 1e-9);
        renderer.tick(at(-0.01, 0, 0.05));
        for (int i = 0; i < 200; ++i) renderer.tick(at(-0.01, 0, z > 0 ? z : 0.0005));
    }
}

TEST_CASE("a vibration swings in touch with its amplitude and frequency, comes and goes by a ramp")
{
    constexpr double force_n = 0.5, frequency_hz = 80;
    Renderer renderer(shared(vibrating(plane_mesh(), force_n, frequency_hz, 0)));
    double last_n = 0;
    for (int i = 0; i < 600; ++i) {
        const bool touching = i >= 100 && i < 400;
        const glm::dvec3 force = renderer.tick(at(0, 0, touching ? -1e-3 : 1e-3)).force_n;
        const double level = touching  ? std::min(1.0, (i - 99) / 20.0)
                             : i < 100 ? 0
                                       : std::max(0.0, 1 - (i - 399) / 20.0);
        const double wanted_n = level * force_n * std::sin(2 * pi * frequency_hz * i * period_s);
        CHECK(std::fabs(force.x - wanted_n) < 1e-9);
        CHECK(std::fabs(force.z - (touching ? 1 : 0)) < 1e-8);
        CHECK(std::fabs(force.x - last_n) <=
              force_n * (2 * pi * frequency_hz * period_s + period_s / vibration_ramp_s));
        last_n = force.x;
    }
}

TEST_CASE("a vibration is felt within its reach, weaker with the distance, and turns with its object")
{
    Scene scene = vibrating(plane_mesh(), 1, 50, 0.01);
    scene.objects[0].placement.rotation = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}; // x to y
    Renderer renderer(shared(std::move(scene)));
    double largest_n = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 force = renderer.tick(at(0, 0, 0.004)).force_n;
        CHECK(std::fabs(force.x) < 1e-12);
        if (i > 50) largest_n = std::max(largest_n, std::fabs(force.y));
    }
    CHECK(std::fabs(largest_n - 0.6) < 1e-9); // 5 ms to the crest: a tick falls on it
    // Away in one leap: it rings down where the hand is now, and is silent then.
    int sounding = 0;
    for (int i = 0; i < 100; ++i) sounding += renderer.tick(at(0, 0, 0.5)).force_n != glm::dvec3(0);
    CHECK(sounding >= 9);
    CHECK(sounding <= 12);
    CHECK(renderer.skipped().objects > 80);
}

TEST_CASE("effects are within the force limit and rise like all forces")
{
    Scene scene = vibrating(plane_mesh(), 50, 100, 0.01);
    scene.objects[0].effects.magnet = {40, 0.01};
    scene.servo.force_limit_n = 3;
    scene.servo.force_rise_s = 0.1;
    Renderer renderer(shared(std::move(scene)));
    double largest_n = 0;
    for (int i = 0; i < 300; ++i) {
        const TickResult result = renderer.tick(at(0, 0, 0.003));
        const double force_n = glm::length(result.force_n);
        CHECK(force_n <= std::min(3.0, i / 100.0 * glm::length(result.unlimited_force_n)) + 1e-12);
        largest_n = std::max(largest_n, force_n);
    }
    CHECK(std::fabs(largest_n - 3) < 1e-12);
}

TEST_CASE("what acts at a distance wakes its object in time, however the hand comes")
{
    constexpr double force_n = 2, reach_m = 5e-3;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> height(-0.01, 0.3);
    Scene scene = magnet_scene(plane_mesh(), force_n, reach_m);
    for (int i = 1; i < 20; ++i) {
        SceneObject other = scene.objects[0];
        other.placement.position_m = {0, 0, -0.2 * i};
        scene.objects.push_back(other);
    }
    Renderer renderer(shared(std::move(scene)));
    for (int i = 0; i < 2000; ++i) {
        const double z = std::fabs(height(random));
        const double x = z / reach_m;
        const TickResult result = renderer.tick(at(0.01, 0, z));
        CHECK(std::fabs(result.force_n.z + (x < 1 ? 4 * force_n * x * (1 - x) : 0)) < 1e-8);
    }
    CHECK(renderer.skipped().objects > 2000 * 16);
    const uint64_t queries = renderer.work().queries;
    for (int i = 0; i < 1000; ++i) renderer.tick(at(1e-5 * i, 0, 0.3));
    CHECK(renderer.work().queries <= queries + 10); // out of reach: nobody is asked
}

TEST_CASE("no force is sent before it is small, where the scene waits for that")
{
    constexpr double force_n = 2, reach_m = 0.01, small_n = 0.5;
    Scene scene = magnet_scene(plane_mesh(), force_n, reach_m);
    scene.servo.wait_for_small_force_n = small_n;
    scene.servo.force_rise_s = 0.02;
    Renderer renderer(shared(std::move(scene)));
    const auto pull_n = [&](double z) { return 4 * force_n * z / reach_m * (1 - z / reach_m); };
    const auto waits = [&](double z, bool interrupted = false) {
        DevicePose pose = at(0, 0, z);
        pose.interrupted = interrupted;
        const TickResult result = renderer.tick(pose);
        CHECK(result.waiting);
        CHECK(result.force_n == glm::dvec3(0));
    };
    for (int i = 0; i < 500; ++i) waits(0.005);
    waits(0.009 - 2.5e-3); // 1.82 N
    constexpr double there_m = 0.0095;
    REQUIRE(pull_n(there_m) < small_n);
    for (int i = 0; i < 40; ++i) {
        const TickResult result = renderer.tick(at(0, 0, there_m));
        CHECK_FALSE(result.waiting);
        CHECK(std::fabs(result.force_n.z + std::min(1.0, i / 20.0) * pull_n(there_m)) < 1e-9);
    }
    CHECK(std::fabs(renderer.tick(at(0, 0, 0.005)).force_n.z + 2) < 1e-9); // it waits no more

    // The device was away: what the hand presses meanwhile does not come back before the hand lets go.
    renderer.tick(at(0, 0, -2e-3));
    waits(-2e-3, true);
    for (int i = 0; i < 500; ++i) waits(-2e-3);
    renderer.tick(at(std::nan(""), 0, 0));
    waits(-2e-3);
    CHECK_FALSE(renderer.tick(at(0, 0, -0.4e-3)).waiting);
    for (int i = 0; i < 20; ++i) renderer.tick(at(0, 0, -0.4e-3));
    CHECK(std::fabs(renderer.tick(at(0, 0, -2e-3)).force_n.z - 2) < 1e-8);
}

TEST_CASE("effects allocate nothing in a tick, and twins give the same bits")
{
    const auto scene = [] {
        Scene s = vibrating(shape("torus", 0.1), 0.3, 130, 0.005);
        s.objects[0].effects.magnet = {1, 0.01};
        s.objects[0].effects.damping_n_s_per_m = 2;
        s.objects[0].effects.damping_reach_m = 0.02;
        Region region;
        region.damping_n_s_per_m = 1;
        region.vibration = {0.1, 30, {0, 1, 0}};
        s.regions.push_back(region);
        return shared(std::move(s));
    };
    Renderer a(scene()), b(scene());
    std::mt19937 random(2);
    std::normal_distribution<double> step(0, 2e-4);
    glm::dvec3 tip(0.07, 0, 0);
    int different = 0;
    const uint64_t before = allocations_of_this_thread();
    for (int i = 0; i < 5000; ++i) {
        tip = 0.999 * tip + glm::dvec3(step(random), step(random), step(random));
        different += a.tick({tip, tip}).force_n != b.tick({tip, tip}).force_n;
    }
    CHECK(allocations_of_this_thread() == before);
    CHECK(different == 0);
}
