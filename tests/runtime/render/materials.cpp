// Materials from point to point: stiffness and friction of objects and of textures, sticking and sliding.
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
using glm::dvec3;

namespace {

constexpr double mu_static = 0.4, mu_dynamic = 0.25;

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
    scene.objects[0].material = {spring_n_per_m, 0, mu_static, mu_dynamic};
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
        CHECK(std::abs(force.z - spring_n_per_m * depth_m) < 1e-8);
        if (i > 1000) { // it slides; the proxy lags by what friction holds, and its scale is that of the tick before
            const double proxy_before = x - step_m + before / spring_n_per_m;
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
        CHECK(largest_n <= mu_static * value * spring_n_per_m * depth_m + 1e-8);
        CHECK(largest_n >= mu_static * value * spring_n_per_m * depth_m - spring_n_per_m * step_m - 1e-8);
    }
}

TEST_CASE("static and dynamic friction have scales of their own, and dynamic friction is held at most static")
{
    constexpr double depth_m = 1e-3, step_m = 1e-6, of_both = 0.5;
    for (const auto& [rest, slide] : {std::pair(2.0, 0.5), {1.0, 0.0}, {3.0, 1.5}, {0.5, 4.0}, {0.0, 1.0}}) {
        Scene scene = bare_scene(plane_mesh(), sample_lambda(
                                                   [rest, slide](const haptel_point&, haptel_sample& sample) {
                                                       sample.friction_scale = of_both;
                                                       sample.static_friction_scale = rest;
                                                       sample.dynamic_friction_scale = slide;
                                                   },
                                                   0, 0, HAPTEL_READS_POINT));
        scene.objects[0].material = {spring_n_per_m, 0, mu_static, mu_dynamic};
        Renderer renderer(shared(std::move(scene)));
        press(renderer, 0, depth_m);
        double largest_n = 0;
        dvec3 force(0);
        for (int i = 0; i < 3000; ++i) {
            force = renderer.tick(at(i * step_m, 0, -depth_m)).force_n;
            largest_n = std::max(largest_n, -force.x);
        }
        const double sticks_n = mu_static * of_both * rest * spring_n_per_m * depth_m,
                     slides_n = std::min(mu_dynamic * of_both * slide * spring_n_per_m * depth_m, sticks_n);
        CAPTURE(rest, slide, largest_n);
        CHECK(largest_n <= sticks_n + 1e-8);
        CHECK(largest_n >= sticks_n - spring_n_per_m * step_m - 1e-8);
        CHECK(std::abs(force.x + slides_n) < 1e-8);
    }
}

// b s v d / 1 mm while pressing at the speed v, with the scale s of the place; where the hand leaves it is held back by
// no more than the spring.
TEST_CASE("damping is the object's times the texture's, and takes energy on closed paths wherever it changes")
{
    constexpr double b = 4, speed_m_per_s = 0.05;
    const auto scale = [](double x) { return 1 + std::sin(x / 1e-3); };
    const auto damped_scene = [&] {
        Scene scene = bare_scene(
            plane_mesh(),
            sample_lambda([=](const haptel_point& at, haptel_sample& sample) { sample.damping_scale = scale(at.p[0]); },
                          0, 0, HAPTEL_READS_POINT));
        scene.objects[0].material = {spring_n_per_m, b, 0, 0};
        return scene;
    };
    for (const double x : {-0.011, 0.0, 0.0047, 0.0013}) {
        Renderer renderer(shared(damped_scene()));
        for (int i = 0; i < 200; ++i) {
            const double z = 5e-3 - i * 1e-3 * speed_m_per_s;
            const dvec3 force = renderer.tick(at(x, 0, z)).force_n;
            if (z < -1e-6 && i > 110) // its speed is known
                CHECK(std::abs(force.z - spring_n_per_m * -z -
                               b * scale(x) * speed_m_per_s * std::min(1.0, -z / 1e-3)) < 1e-8);
        }
    }
    Renderer renderer(shared(damped_scene()));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
    for (int loop = 0; loop < 20; ++loop) {
        const double first = phase(random), second = phase(random);
        const auto place = [&](int i) {
            const double t = 2 * std::numbers::pi * i / 2000.0;
            return dvec3(4e-3 * std::sin(t + first), 3e-3 * std::sin(2 * t + second), -1e-3 + 0.9e-3 * std::cos(3 * t));
        };
        renderer.tick(at(0, 0, 1e-3));
        for (int i = -20; i < 0; ++i) renderer.tick({place(i), place(i)});
        double given_j = 0;
        dvec3 before = renderer.tick({place(0), place(0)}).force_n;
        for (int i = 1; i <= 2000; ++i) {
            const dvec3 force = renderer.tick({place(i), place(i)}).force_n;
            given_j += 0.5 * glm::dot(force + before, place(i) - place(i - 1));
            before = force;
        }
        CHECK(given_j < -1e-7);
    }
}

TEST_CASE(
    "a scale that is no number or below 0 counts as 1 and is told, one that is huge makes no force that is not finite")
{
    constexpr double huge = 1e308;
    for (const double value : {std::nan(""), HUGE_VAL, -1.0, huge})
        for (double haptel_sample::* scale :
             {&haptel_sample::stiffness_scale, &haptel_sample::friction_scale, &haptel_sample::static_friction_scale,
              &haptel_sample::dynamic_friction_scale, &haptel_sample::damping_scale}) {
            const auto felt = [&](bool spoilt) {
                Scene scene = bare_scene(plane_mesh(), sample_lambda(
                                                           [=](const haptel_point&, haptel_sample& sample) {
                                                               if (spoilt) sample.*scale = value;
                                                           },
                                                           0, 0, HAPTEL_READS_POINT));
                scene.objects[0].material = {spring_n_per_m, 3, mu_static, mu_dynamic};
                Renderer renderer(shared(std::move(scene)));
                std::vector<TickResult> results;
                for (int i = 0; i < 300; ++i)
                    results.push_back(renderer.tick(at(i * 1e-5, 0, -1e-3 + 1.5e-3 * std::cos(i / 15.0))));
                return results;
            };
            const std::vector<TickResult> sound = felt(false), found = felt(true);
            uint32_t faults = 0;
            for (size_t i = 0; i < found.size(); ++i) {
                CHECK(finite(found[i].force_n));
                if (value != huge) CHECK(found[i].force_n == sound[i].force_n);
                faults |= found[i].faults;
            }
            CHECK(((faults & HAPTEL_FAULT_OUTPUT_NOT_FINITE) != 0) == (value != huge));
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
        const double k = spring_n_per_m * soft(x);
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
    scene.objects[0].material = {spring_n_per_m, 0, mu_static, mu_dynamic};
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
    constexpr double mu = 0.3, depth_m = 1e-3;
    Scene scene = bare_scene(plane_mesh());
    scene.probe = {ProbeKind::stylus, 0.06};
    scene.objects[0].material = {spring_n_per_m, 0, mu, mu};
    Renderer renderer(shared(std::move(scene)));
    const auto hand = [](double y, double z) { return DevicePose{{0.07, y, z}, {0.01, y, z}}; };
    renderer.tick(hand(0, 1e-3));
    TickResult result;
    for (int i = 0; i < 100; ++i) result = renderer.tick(hand(i * 1e-4, -depth_m));
    // Two unknown pushes raise both ends by the depth: at the tail all that the border, 2/3 along, does not raise.
    const double border = depth_m / (2.0 / 3), tail = depth_m - border / 3;
    CHECK(std::abs(result.force_n.z - spring_n_per_m * (border + tail)) < 1e-4);
    CHECK(std::abs(result.force_n.y + mu * spring_n_per_m * tail) < 2e-4); // its radius is a micrometre
}

TEST_CASE("what has slid sticks again once the hand has come back, not when it rests, and then needs the static force")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material = {spring_n_per_m, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    constexpr double depth_m = 1e-3, normal_n = spring_n_per_m * depth_m, step_m = 1e-6;
    press(renderer, 0, depth_m);
    double x = 0;
    for (int turn = 0; turn < 3; ++turn) {
        double largest_n = 0, last_n = 0;
        for (int i = 0; i < 1000; ++i) {
            last_n = -renderer.tick(at(x += step_m, 0, -depth_m)).force_n.x;
            largest_n = std::max(largest_n, last_n);
        }
        CHECK(largest_n <= mu_static * normal_n + 1e-8);
        CHECK(largest_n > mu_static * normal_n - 2 * spring_n_per_m * step_m);
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
    scene.objects[0].material = {spring_n_per_m, 0, mu_static, mu_dynamic};
    Renderer renderer(shared(std::move(scene)));
    press(renderer, 0, 0.2e-3);
    double x = 0;
    for (const double depth_m : {0.2e-3, 0.5e-3, 1e-3, 2e-3, 0.3e-3}) {
        dvec3 force(0);
        for (int i = 0; i < 2000; ++i) force = renderer.tick(at(x += 5e-6, 0, -depth_m)).force_n;
        CHECK(std::abs(force.z - spring_n_per_m * depth_m) < 1e-8);
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
    scene.objects[0].material = {spring_n_per_m, 0, mu_static, mu_dynamic};
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
