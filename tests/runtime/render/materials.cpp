// Materials from point to point: stiffness and friction of objects and of textures, sticking and sliding.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double stiffness = 1000, mu_static = 0.4, mu_dynamic = 0.25; // N/m, no unit

// A flat plane whose material scales depend on x.
template <class Scale>
Scene scaled_scene(Scale&& friction_scale, Scale&& stiffness_scale)
{
    Scene scene = bare_scene(plane_mesh(), sample_lambda(
                                               [=](const haptel_point& at, haptel_sample& sample) {
                                                   sample.friction_scale = friction_scale(at.p[0]);
                                                   sample.stiffness_scale = stiffness_scale(at.p[0]);
                                               },
                                               0, 0, HAPTEL_READS_POINT));
    scene.objects[0].material = {stiffness, 0, mu_static, mu_dynamic};
    return scene;
}

// Puts the probe down at x and presses it in.
void press(Renderer& renderer, double x, double depth_m)
{
    renderer.tick(at(x, 0, 1e-3));
    for (int i = 0; i < 3; ++i) renderer.tick(at(x, 0, -depth_m));
}

} // namespace

TEST_CASE("sliding friction follows the texture's friction scale from point to point")
{
    using Scale = double (*)(double);
    const Scale rubber = [](double x) { return 1.5 + std::sin(x / 2e-3); }, one = [](double) { return 1.0; };
    Renderer renderer(shared(scaled_scene(rubber, one)));
    constexpr double depth_m = 1e-3, step_m = 2e-6;
    press(renderer, -0.02, depth_m);
    double before = 0;
    for (int i = 0; i < 15000; ++i) {
        const double x = -0.02 + i * step_m;
        const dvec3 force = renderer.tick(at(x, 0, -depth_m)).force_n;
        CHECK(std::abs(force.z - stiffness * depth_m) < 1e-8);
        if (i > 1000) { // it slides; the proxy lags by what friction holds, and its scale is that of the tick before
            const double proxy_before = x - step_m + before / stiffness;
            CHECK(std::abs(force.x + mu_dynamic * rubber(proxy_before) * force.z) < 1e-8);
        }
        before = force.x;
    }
}

TEST_CASE("sticking friction holds up to the texture's share of the static coefficient")
{
    using Scale = double (*)(double);
    const Scale one = [](double) { return 1.0; };
    const std::pair<Scale, double> scales[] = {
        {[](double) { return 0.0; }, 0.0}, {[](double) { return 0.5; }, 0.5}, {[](double) { return 2.5; }, 2.5}};
    for (const auto& [scale, value] : scales) {
        Renderer renderer(shared(scaled_scene(scale, one)));
        constexpr double depth_m = 1e-3, step_m = 1e-6;
        press(renderer, 0, depth_m);
        double largest_n = 0;
        for (int i = 0; i < 3000; ++i)
            largest_n = std::max(largest_n, -renderer.tick(at(i * step_m, 0, -depth_m)).force_n.x);
        CAPTURE(value, largest_n);
        CHECK(largest_n <= mu_static * value * stiffness * depth_m + 1e-8);
        CHECK(largest_n >= mu_static * value * stiffness * depth_m - stiffness * step_m - 1e-8);
    }
}

TEST_CASE("stiffness is the object's times the texture's, for normal and sideways force alike")
{
    using Scale = double (*)(double);
    const Scale one = [](double) { return 1.0; }, soft = [](double x) { return 0.6 + 20 * x; };
    Renderer renderer(shared(scaled_scene(one, soft)));
    constexpr double depth_m = 0.5e-3;
    for (const double x : {-0.02, 0.0, 0.015}) {
        press(renderer, x, depth_m);
        const double k = stiffness * soft(x);
        const dvec3 straight = renderer.tick(at(x, 0, -depth_m)).force_n;
        CHECK(std::abs(straight.z - k * depth_m) < 1e-8);
        const double aside_m = 0.5 * mu_static * depth_m; // it sticks
        const dvec3 aside = renderer.tick(at(x + aside_m, 0, -depth_m)).force_n;
        CHECK(std::abs(aside.x + k * aside_m) < 1e-8);
        CHECK(std::abs(aside.z - k * depth_m) < 1e-8);
        renderer.tick(at(x, 0, 2e-3));
    }
    for (const double per_m : {200.0, 3000.0}) { // of the object
        Scene scene = bare_scene(plane_mesh());
        scene.objects[0].material.stiffness_n_per_m = per_m;
        Renderer other(shared(std::move(scene)));
        press(other, 0, depth_m);
        CHECK(std::abs(other.tick(at(0, 0, -depth_m)).force_n.z - per_m * depth_m) < 1e-8);
    }
}

TEST_CASE("a probe that sticks does not creep, whatever trembles below the limit")
{
    Scene scene = bare_scene(plane_mesh(), sine_texture(40e-6, 2e-3));
    scene.objects[0].material = {stiffness, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    constexpr double x = 0.3e-3, depth_m = 1e-3;
    press(renderer, x, depth_m);
    const dvec3 at_first = renderer.tick(at(x, 0, -depth_m)).force_n;
    std::mt19937 random(1);
    // Held is what is felt below the texture: up to 0.9 mm here.
    std::uniform_real_distribution<double> aside_m(-0.2e-3, 0.2e-3), deeper_m(0, 0.2e-3);
    for (int i = 0; i < 200'000; ++i)
        renderer.tick(at(x + aside_m(random), aside_m(random), -depth_m - deeper_m(random)));
    CHECK(renderer.tick(at(x, 0, -depth_m)).force_n == at_first); // to the last bit
}

TEST_CASE("the end of a stylus has its friction while the shaft rests on an edge")
{
    // It lies on a plate, with its tip beyond the border, and is drawn along that: the border has no friction.
    constexpr double stiffness = 1000, mu = 0.3, depth_m = 1e-3;
    Scene scene = bare_scene(plane_mesh());
    scene.probe = {ProbeKind::stylus, 0.06};
    scene.objects[0].material = {stiffness, 0, mu, mu};
    Renderer renderer(shared(std::move(scene)));
    const auto hand = [](double y, double z) { return DevicePose{{0.07, y, z}, {0.01, y, z}}; };
    renderer.tick(hand(0, 1e-3));
    TickResult result;
    for (int i = 0; i < 100; ++i) result = renderer.tick(hand(i * 1e-4, -depth_m));
    // Two unknown pushes raise both ends by the depth: at the tail all that the border, 2/3 along, does not raise.
    const double border = depth_m / (2.0 / 3), tail = depth_m - border / 3;
    CHECK(std::abs(result.force_n.z - stiffness * (border + tail)) < 1e-4);
    CHECK(std::abs(result.force_n.y + mu * stiffness * tail) < 2e-4); // its radius is a micrometre
}

TEST_CASE("what has slid sticks again once the hand has come back, not when it rests, and then needs the static force")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material = {stiffness, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    constexpr double depth_m = 1e-3, normal_n = stiffness * depth_m, step_m = 1e-6;
    press(renderer, 0, depth_m);
    double x = 0;
    for (int turn = 0; turn < 3; ++turn) {
        double largest_n = 0, last_n = 0;
        for (int i = 0; i < 1000; ++i) {
            last_n = -renderer.tick(at(x += step_m, 0, -depth_m)).force_n.x;
            largest_n = std::max(largest_n, last_n);
        }
        CHECK(largest_n <= mu_static * normal_n + 1e-8);
        CHECK(largest_n > mu_static * normal_n - 2 * stiffness * step_m);
        CHECK(std::abs(last_n - mu_dynamic * normal_n) < 1e-8);
        for (int i = 0; i < 3; ++i) last_n = -renderer.tick(at(x, 0, -depth_m)).force_n.x; // rest
        CHECK(std::abs(last_n - mu_dynamic * normal_n) < 1e-8);
        for (int i = 0; i < 100; ++i) last_n = -renderer.tick(at(x += step_m, 0, -depth_m)).force_n.x;
        CHECK(std::abs(last_n - mu_dynamic * normal_n) < 1e-8);
        x -= 0.6 * mu_dynamic * depth_m; // back
        renderer.tick(at(x, 0, -depth_m));
    }
}

TEST_CASE("friction grows with the force that presses")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material = {stiffness, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    press(renderer, 0, 0.2e-3);
    double x = 0;
    for (const double depth_m : {0.2e-3, 0.5e-3, 1e-3, 2e-3, 0.3e-3}) {
        dvec3 force(0);
        for (int i = 0; i < 2000; ++i) force = renderer.tick(at(x += 5e-6, 0, -depth_m)).force_n;
        CHECK(std::abs(force.z - stiffness * depth_m) < 1e-8);
        CHECK(std::abs(force.x + mu_dynamic * force.z) < 1e-8);
    }
}

TEST_CASE("a texture is not evaluated again where nothing has changed that it reads")
{
    uint64_t evaluated = 0;
    const auto texture = [&](uint32_t reads) {
        return sample_lambda(
            [&evaluated](const haptel_point& at, haptel_sample& sample) {
                ++evaluated;
                sample.height_m = 20e-6 * std::sin(1000 * at.p[0] + at.time_s);
            },
            -20e-6, 20e-6, HAPTEL_READS_POINT | reads);
    };
    Scene scene = bare_scene(plane_mesh(), texture(0));
    scene.objects[0].material = {stiffness, 0, mu_static, mu_dynamic};
    const std::shared_ptr<TextureSlot> slot = scene.objects[0].texture;
    Renderer renderer(shared(std::move(scene)));
    constexpr double depth_m = 1e-3;
    double x = 0;
    press(renderer, x, depth_m);
    const auto evaluations = [&](double step_m) { // of ten ticks
        const uint64_t before = evaluated;
        for (int i = 0; i < 10; ++i) renderer.tick(at(x += step_m, 0, -depth_m));
        return evaluated - before;
    };
    CHECK(evaluations(0) == 0);    // it rests
    CHECK(evaluations(1e-6) == 0); // it sticks
    evaluations(100e-6);
    CHECK(evaluations(100e-6) == 10); // it slides
    slot->publish(texture(0));
    CHECK(evaluations(0) > 0);
    for (int i = 0; i < 10; ++i) evaluations(0); // until it has faded
    CHECK(evaluations(0) == 0);
    slot->publish(texture(HAPTEL_READS_TIME));
    for (int i = 0; i < 10; ++i) evaluations(0);
    CHECK(evaluations(0) == 10);
}
