// What the hand feels: force models, friction, damping, shading, fades.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

} // namespace

TEST_CASE("displaced is minus the gradient of its potential")
{
    constexpr double amplitude_m = 80e-6, wavelength_m = 1.5e-3, stiffness = 1000;
    const double w = 2 * std::numbers::pi / wavelength_m;
    Renderer renderer(shared(bare_scene(plane_mesh(), sine_texture(amplitude_m, wavelength_m))));
    renderer.tick(at(0, 0.001, 1e-3));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x_m(-0.04, 0.04), depth_m(0, 1e-3);
    for (int i = 0; i < 1000; ++i) {
        const double x = x_m(random), d = depth_m(random);
        const double felt = std::max(0.0, d + amplitude_m * std::sin(w * x) - amplitude_m);
        const glm::dvec3 expected(-stiffness * felt * amplitude_m * w * std::cos(w * x), 0, stiffness * felt);
        const TickResult result = renderer.tick(at(x, 0.001, -d));
        CHECK(glm::length(result.force_n - expected) < 1e-8);
        CHECK(std::abs(result.depth_m - d) < 1e-12);
        CHECK(std::abs(result.height_m - amplitude_m * std::sin(w * x)) < 1e-12);
    }
}

TEST_CASE("a textured plane is first felt from zero: at most 1.001 mN at 1 um and 1000 N/m")
{
    Scene scene = bare_scene(plane_mesh(), sine_texture(60e-6, 1e-3));
    scene.objects[0].material = {1000, 1.0, 0.3, 0.2};
    const auto touched = shared(std::move(scene));
    double largest_n = 0;
    for (int i = 0; i < 2000; ++i) {
        const double x = i * 1e-6;
        Renderer renderer(touched);
        renderer.tick(at(x, 0.001, 1e-6));
        renderer.tick(at(x, 0.001, 0));
        largest_n = std::max(largest_n, glm::length(renderer.tick(at(x, 0.001, -1e-6)).force_n));
    }
    CHECK(largest_n <= 1.001e-3);
    CHECK(largest_n > 0.99e-3); // on the crests it is felt at once
}

TEST_CASE("the texture is given what it reads and nothing else")
{
    haptel_point seen = {};
    const auto look = [&](uint32_t reads) {
        Renderer renderer(shared(bare_scene(plane_mesh(), lambda_texture(
                                                              [&](const haptel_point& point, glm::dvec3&) {
                                                                  seen = point;
                                                                  return 0.0;
                                                              },
                                                              0, 0, reads))));
        renderer.tick(at(0.01, 0.02, 1e-3));
        renderer.tick(at(0.01, 0.02, -1e-3));
    };
    look(HAPTEL_READS_POINT);
    CHECK(std::abs(seen.p[0] - 0.01) < 1e-12);
    CHECK(std::abs(seen.p[2]) < 1e-12);
    CHECK((seen.n[2] == 0 && seen.uv[0] == 0 && seen.time_s == 0 && seen.uv_dp[0][0] == 0));
    look(reads_everything);
    CHECK((seen.n[0] == 0 && seen.n[1] == 0 && seen.n[2] == 1));
    CHECK(std::abs(seen.uv[0] - 0.6) < 1e-9); // the plane of side 0.1 m has uv 0 .. 1
    CHECK(std::abs(seen.uv_dp[0][0] - 10) < 1e-6);
    CHECK(std::abs(seen.uv_dp[1][1] - 10) < 1e-6);
    CHECK(std::abs(seen.uv_dp[0][1]) < 1e-6);
    CHECK(seen.time_s == 1e-3);
}

TEST_CASE("the force turns with the object")
{
    std::mt19937 random(9);
    std::uniform_real_distribution<double> part(-1, 1);
    Scene straight = bare_scene(plane_mesh(), sine_texture(60e-6, 1e-3));
    Scene turned = bare_scene(plane_mesh(), sine_texture(60e-6, 1e-3));
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
    const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
    Placement& placement = turned.objects[0].placement;
    for (int j = 0; j < 3; ++j) { // Rodrigues
        glm::dvec3 e(0);
        e[j] = 1;
        placement.rotation[j] = c * e + s * glm::cross(axis, e) + (1 - c) * glm::dot(axis, e) * axis;
    }
    placement.position_m = {0.3, -0.2, 0.1};
    for (Scene* scene : {&straight, &turned}) scene->objects[0].material = {1000, 1.0, 0.3, 0.2};
    const glm::dmat3 rotation = placement.rotation;
    const auto to_world = [p = placement](const glm::dvec3& v) { return p.rotation * v + p.position_m; };
    Renderer a(shared(std::move(straight))), b(shared(std::move(turned)));
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 tip(i * 1e-5, 0.002, i < 20 ? 1e-3 : -1e-3 + 1e-4 * part(random));
        const TickResult here = a.tick({tip, tip}), there = b.tick({to_world(tip), to_world(tip)});
        CHECK(glm::length(there.force_n - rotation * here.force_n) < 1e-7);
        CHECK(here.normal == glm::dvec3(0, 0, here.contacts > 0 ? 1 : 0));
        CHECK(glm::length(there.normal - rotation * here.normal) < 1e-7);
    }
}

TEST_CASE("the normal that a tick tells is that of the round thing for which facets stand")
{
    constexpr double size_m = 0.1;
    Renderer renderer(shared(bare_scene(ball_mesh(4, size_m))));
    double furthest = 0;
    for (int i = 0; i <= 2000; ++i) { // from its top down one side, a millimetre deep
        const double angle = i * 5e-4;
        const glm::dvec3 out(std::sin(angle), 0.01, std::cos(angle));
        const glm::dvec3 tip = (i == 0 ? 0.52 : 0.49) * size_m * glm::normalize(out);
        const TickResult result = renderer.tick({tip, tip});
        if (i > 0) furthest = std::max(furthest, glm::length(result.normal - glm::normalize(out)));
    }
    CHECK(furthest < 0.3 * std::numbers::pi / 180);
}

TEST_CASE("friction sticks up to the static coefficient and slides with the dynamic one")
{
    constexpr double stiffness = 1000, depth_m = 1e-3, mu_static = 0.4, mu_dynamic = 0.25;
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material = {stiffness, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 0, 1e-3));
    renderer.tick(at(0, 0, -depth_m));
    renderer.tick(at(0, 0, -depth_m));
    // Stick: the tangential force is the spring back to where the probe stands.
    for (double x = 0; x < 0.99 * mu_static * depth_m; x += 1e-5) {
        const glm::dvec3 force = renderer.tick(at(x, 0, -depth_m)).force_n;
        CHECK(std::abs(force.x + stiffness * x) < 1e-8);
        CHECK(std::abs(force.z - stiffness * depth_m) < 1e-8);
    }
    // Slide: against the motion, the dynamic coefficient times the normal force.
    glm::dvec3 force(0);
    for (int i = 0; i < 100; ++i) force = renderer.tick(at(1e-3 + i * 1e-4, 0, -depth_m)).force_n;
    CHECK(std::abs(force.x + mu_dynamic * stiffness * depth_m) < 1e-8);
    CHECK(std::abs(force.y) < 1e-8);
}

TEST_CASE("friction is proportional to what is felt of the depth, not to the depth below the base")
{
    constexpr double height_m = -0.1e-3, bound_m = 0.1e-3, depth_m = 0.3e-3, mu_static = 0.4, mu_dynamic = 0.25;
    Scene scene = bare_scene(
        plane_mesh(), lambda_texture([](const haptel_point&, glm::dvec3&) { return height_m; }, height_m, bound_m));
    scene.objects[0].material = {1000, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 0, 1e-3));
    for (int i = 0; i < 3; ++i) renderer.tick(at(0, 0, -depth_m));
    double largest = 0;
    glm::dvec3 force(0);
    for (int i = 0; i < 1000; ++i) {
        force = renderer.tick(at(i * 1e-6, 0, -depth_m)).force_n;
        CHECK(std::abs(force.z - 1000 * (depth_m + height_m - bound_m)) < 1e-8);
        largest = std::max(largest, -force.x);
    }
    CHECK(largest <= mu_static * force.z + 1e-8);
    CHECK(largest > 0.97 * mu_static * force.z); // steps of a micrometre
    CHECK(std::abs(force.x + mu_dynamic * force.z) < 1e-8);
    // Out of the texture, though still below the base: nothing is felt, at once.
    CHECK(renderer.tick(at(1e-3, 0, -0.1e-3)).force_n == glm::dvec3(0));
}

TEST_CASE("damping takes energy, begins without a step, and never pulls")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material.damping_n_s_per_m = 20;
    Renderer renderer(shared(std::move(scene)));
    double energy_j = 0, last_z = 0;
    TickResult last;
    for (int i = 0; i < 400; ++i) {
        const double z = 1e-3 * std::cos(2 * std::numbers::pi * i / 100.0);
        if (i > 0) energy_j += last.force_n.z * (z - last_z);
        last = renderer.tick(at(0, 0, z));
        last_z = z;
        CHECK(last.force_n.z >= 0);
        if (z > -1e-6) CHECK(last.force_n.z < 2.1e-3); // K d + b v d / 1 mm, v = 63 mm/s
    }
    CHECK(energy_j < -1e-5);
}

// A spring of k N/m that is drawn by d m gives k d back, whatever it is damped by. The hand is drawn out at 0.5 m/s, so
// that damping asks for more; it presses on what the texture leaves of the depth, with the texture's own stiffness.
TEST_CASE("damping holds nothing back that the spring does not push, textured, soft, by a shaft and in any workspace")
{
    for (const double scale : {0.25, 1.0, 4.0})
        for (const bool by_shaft : {false, true}) {
            const double below_m = 0.4e-3 * scale, soft = 0.2;
            Scene scene =
                by_shaft ? bare_scene(shape("box", 0.06 * scale))
                         : bare_scene(plane_mesh(0.1 * scale), sample_lambda(
                                                                   [&](const haptel_point&, haptel_sample& sample) {
                                                                       sample.height_m = -below_m;
                                                                       sample.stiffness_scale = soft;
                                                                   },
                                                                   -below_m, 0));
            scene.objects[0].material.damping_n_s_per_m = 50;
            if (by_shaft) scene.probe = {ProbeKind::stylus, 0.1 * scale, 0};
            HandSettings hand;
            hand.workspace.scale = scale;
            Renderer renderer(shared(std::move(scene)), hand);
            // Off a plane's middle, or off the edge along y of a box of 60 mm, which the middle of the shaft leans on.
            const glm::dvec3 normal = by_shaft ? glm::normalize(glm::dvec3(1, 0, 1)) : glm::dvec3(0, 0, 1),
                             place = by_shaft ? glm::dvec3(0.03, 0, 0.03) : glm::dvec3(0.01, 0.02, 0),
                             along = by_shaft ? 0.05 * glm::normalize(glm::dvec3(1, 0, -1)) : glm::dvec3(0);
            double least_n = 0, most_n = 0, damped = 0;
            for (int i = 0; i < 300; ++i) {
                const double up_m = i < 200 ? std::max(-1.5e-3, 1e-3 - i * 2e-5) : -1.5e-3 + (i - 199) * 5e-4;
                const glm::dvec3 middle = place + up_m * normal;
                const TickResult result = renderer.tick({middle - along, middle + along});
                const double felt_n = glm::dot(result.force_n, normal);
                const double spring_n = by_shaft ? 2 * 1000 * -up_m : soft * 1000 * (-up_m - 0.4e-3);
                least_n = std::min(least_n, felt_n);
                most_n = std::max(most_n, felt_n);
                damped += i >= 200 && result.contacts > 0 && spring_n > 0 && felt_n < 0.5 * spring_n;
            }
            CAPTURE(scale, by_shaft, least_n, most_n);
            CHECK(least_n > -1e-9);
            CHECK(most_n > 0.2);
            CHECK(damped > 0); // or nothing was held back
        }
}

TEST_CASE("after missed deadlines damping knows the speed that was, not a multiple of it")
{
    constexpr double speed_m_per_s = 0.02, damping = 5, stiffness = 1000;
    for (const uint64_t late : {uint64_t{1}, uint64_t{2}, uint64_t{10}}) {
        Scene scene = bare_scene(plane_mesh());
        scene.objects[0].material.damping_n_s_per_m = damping;
        Renderer renderer(shared(std::move(scene)));
        double period = 0, z = 2e-3;
        const auto go_on = [&](uint64_t periods) {
            period += static_cast<double>(periods);
            z = 2e-3 - speed_m_per_s * period * 1e-3;
            DevicePose pose = at(0, 0, z);
            pose.periods = periods;
            return renderer.tick(pose);
        };
        for (int i = 0; i < 160; ++i) go_on(1); // 1.2 mm below, full damping
        const TickResult result = go_on(late);
        CHECK(std::abs(result.force_n.z - (stiffness * -z + damping * speed_m_per_s)) < 1e-9);
        CHECK(std::abs(result.time_s - (159 + static_cast<double>(late)) * 1e-3) < 1e-12);
    }
}

TEST_CASE("the speed of the hand passes a low-pass of 100 Hz, at every rate and over late ticks")
{
    for (const double rate_hz : {10.0, 120.0, 1000.0, 4000.0, 1e5}) {
        HandVelocity timely(1 / rate_hz);
        timely.update(glm::dvec3(0), 1);
        for (int period = 1; period <= 100; ++period) {
            timely.update({period, -2 * period, 0}, 1);
            HandVelocity late(1 / rate_hz);
            late.update(glm::dvec3(0), 1);
            late.update({period, -2 * period, 0}, uint64_t(period));
            const double share = -std::expm1(-2 * std::numbers::pi * 100 * period / rate_hz);
            for (const HandVelocity* hand : {&timely, &late}) {
                CAPTURE(rate_hz, period, hand == &late);
                CHECK(std::abs(hand->m_per_s().x / rate_hz - share) < 1e-13 * share);
                CHECK(hand->m_per_s().y == -2 * hand->m_per_s().x);
            }
        }
    }
}

TEST_CASE("force shading makes an icosphere of 5120 triangles a sphere")
{
    Mesh mesh = make_icosphere(4);
    REQUIRE(mesh.triangles.size() == 5120);
    scale_to_size(mesh, 2.0);
    Renderer renderer(shared(bare_scene(mesh)));
    const glm::dvec3 u = glm::normalize(glm::dvec3(1, 0.3, 0.2));
    const glm::dvec3 v = glm::normalize(glm::cross(u, glm::dvec3(0.1, -0.4, 1)));
    double largest_error_deg = 0, largest_turn_deg = 0;
    glm::dvec3 last(0);
    const int ticks = 20000; // 2 m of the circle of 6.3 m
    for (int i = 0; i < ticks; ++i) {
        const double angle = i * 0.1e-3;
        const glm::dvec3 out = std::cos(angle) * u + std::sin(angle) * v;
        if (i == 0) renderer.tick({1.01 * out, 1.01 * out});
        const TickResult result = renderer.tick({0.99 * out, 0.99 * out});
        REQUIRE(result.contacts == 1);
        largest_error_deg = std::max(largest_error_deg, degrees_between(result.force_n, out));
        if (i > 0) largest_turn_deg = std::max(largest_turn_deg, degrees_between(result.force_n, last));
        last = result.force_n;
    }
    CAPTURE(largest_error_deg, largest_turn_deg);
    CHECK(largest_error_deg < 1);
    CHECK(largest_turn_deg < 0.1);
}

TEST_CASE("twin renderers give the same bits")
{
    const auto scene = [] {
        Scene s = bare_scene(plane_mesh(0.1, 8), sine_texture(60e-6, 1e-3));
        s.objects[0].material = {1000, 1.0, 0.3, 0.2};
        return shared(std::move(s));
    };
    Renderer a(scene()), b(scene());
    std::mt19937 random(1);
    std::normal_distribution<double> step(0, 3e-5);
    glm::dvec3 tip(0, 0, 1e-4);
    bool equal = true;
    for (int i = 0; i < 5000; ++i) {
        tip += glm::dvec3(step(random), step(random), step(random) - 2e-2 * tip.z - 1e-5);
        equal = equal && a.tick({tip, tip}).force_n == b.tick({tip, tip}).force_n;
    }
    CHECK(equal);
}

TEST_CASE("a hand that rests feels one texture turn into the other, height and gradient alike")
{
    constexpr double stiffness = 1000, depth_m = 1e-3, x_m = 0.3e-3;
    struct Sine {
        double amplitude_m, wave_per_m;
        double envelope_m() const { return amplitude_m * (std::sin(wave_per_m * x_m) - 1); }
        double slope() const { return amplitude_m * wave_per_m * std::cos(wave_per_m * x_m); }
    };
    const Sine a{50e-6, 2 * std::numbers::pi / 2e-3}, b{200e-6, 2 * std::numbers::pi / 3e-3};
    const auto scene = shared(bare_scene(plane_mesh(), sine_texture(50e-6, 2e-3)));
    Renderer renderer(scene);
    renderer.tick(at(x_m, 0.002, 1e-3));
    renderer.tick(at(x_m, 0.002, -depth_m));
    scene->objects[0].texture->publish(sine_texture(200e-6, 3e-3));
    for (int tick = 0; tick < 70; ++tick) {
        const double w = std::min(1.0, (tick + 1) / 50.0);
        const double felt_m = depth_m + (1 - w) * a.envelope_m() + w * b.envelope_m();
        const double slope = (1 - w) * a.slope() + w * b.slope();
        const glm::dvec3 force = renderer.tick(at(x_m, 0.002, -depth_m)).force_n;
        CHECK(glm::length(force - stiffness * felt_m * glm::dvec3(-slope, 0, 1)) < 1e-8);
    }
}

TEST_CASE("during a fade the force changes no faster than the textures and the fade allow")
{
    constexpr double stiffness = 1000, period_s = 1e-3;
    struct Wave {
        double amplitude_m, wavelength_m;
        TextureBinding binding;
    };
    std::mt19937 random(17);
    std::uniform_real_distribution<double> amplitude(0, 120e-6), wavelength(1e-3, 4e-3);
    std::vector<Wave> waves;
    for (int i = 0; i < 50; ++i) {
        const double a = amplitude(random), l = wavelength(random);
        waves.push_back({a, l, sine_texture(a, l)});
    }
    const auto make_scene = [&](const TextureBinding& binding, double friction) {
        Scene scene = bare_scene(plane_mesh(), binding);
        scene.objects[0].material.static_friction = scene.objects[0].material.dynamic_friction = friction;
        return shared(std::move(scene));
    };
    const auto hand = [](int tick) {
        const double t = tick * period_s;
        return at(0.02 * std::sin(2 * std::numbers::pi * t), 0.01 * std::cos(std::numbers::pi * t),
                  -0.6e-3 + 0.3e-3 * std::sin(3 * std::numbers::pi * t));
    };
    const auto largest_change = [&](Renderer& renderer, int ticks, const auto& allowed) {
        glm::dvec3 last(0);
        double largest = 0;
        for (int i = -2; i < ticks; ++i) {
            const TickResult result = renderer.tick(i < 0 ? at(0, 0.01, 1e-3) : hand(i));
            const double change = glm::length(result.unlimited_force_n - last);
            last = result.unlimited_force_n;
            if (i <= 0) continue; // the hand jumps onto the surface
            largest = std::max(largest, change);
            allowed(i, result, change);
        }
        return largest;
    };
    for (const double friction : {0.0, 0.3}) {
        double without_edits = 0;
        for (const Wave& wave : waves) {
            Renderer renderer(make_scene(wave.binding, friction));
            without_edits =
                std::max(without_edits, largest_change(renderer, 2000, [](int, const TickResult&, double) {}));
        }
        const auto scene = make_scene(waves[0].binding, friction);
        Renderer renderer(scene);
        uint64_t from = 1, to = 1;
        std::size_t published = 1;
        double worst_share = 0;
        largest_change(renderer, 20000, [&](int tick, const TickResult& result, double change) {
            if (result.binding != to) {
                from = to;
                to = result.binding;
            }
            const Wave &a = waves[(from - 1) % waves.size()], &b = waves[(to - 1) % waves.size()];
            // |A sin - B sin| with any phases comes as near to A + B as wanted on a long enough line.
            const double fade_n = 2 * stiffness * (a.amplitude_m + b.amplitude_m) * period_s / fade_s;
            worst_share = std::max(worst_share, change / (without_edits + fade_n));
            if (tick % 97 == 0 && published <= 200)
                scene->objects[0].texture->publish(waves[published++ % waves.size()].binding);
        });
        CHECK(published == 201);
        CAPTURE(friction, without_edits, worst_share);
        CHECK(worst_share <= 1);
    }
}
