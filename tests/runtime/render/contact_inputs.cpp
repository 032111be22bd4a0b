// What a texture is told of the contact itself, and the vibration that it may ask for.
#include "lang/abi/contact_limits.h"
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double depth_m = 1e-3;
constexpr uint32_t reads_contact = HAPTEL_READS_POINT | HAPTEL_READS_VELOCITY | HAPTEL_READS_NORMAL_FORCE |
                                   HAPTEL_READS_TOOL_RADIUS | HAPTEL_READS_TANGENT | HAPTEL_READS_CURVATURE;

Scene plane_with(SampleFunction function, double rate_hz = 1000)
{
    Scene scene = bare_scene(plane_mesh(), sample_lambda(std::move(function), 0, 0, reads_contact));
    scene.objects[0].material = {spring_n_per_m, 0, 0, 0};
    scene.servo.rate_hz = rate_hz;
    return scene;
}

} // namespace

TEST_CASE("a texture is told how fast the hand slides, how hard it presses and with what")
{
    haptel_point last{};
    Renderer renderer(shared(plane_with([&](const haptel_point& at, haptel_sample&) { last = at; })));
    double x = 0;
    renderer.tick(at(x, 0, 1e-3));
    for (int i = 0; i < 200; ++i) {
        x += 50e-6;
        renderer.tick(at(x, -2 * x, -depth_m - 1e-7 * i));
    }
    CHECK(std::abs(last.velocity[0] - 0.05) < 1e-6); // 50 um in each millisecond
    CHECK(std::abs(last.velocity[1] + 0.10) < 1e-6);
    CHECK(last.velocity[2] == 0); // along the surface, although the hand sinks
    CHECK(std::abs(last.normal_force_n - spring_n_per_m * (depth_m + 199e-7)) < 1e-9);
    CHECK(last.tool_radius_m == 0);
    CHECK(last.curvature_per_m == 0);

    x = 0; // no hand is as fast
    for (int i = 0; i < 300; ++i) renderer.tick(at(x += (i % 2 ? -1 : 1) * 0.03 + 1e-5, 0, -depth_m));
    CHECK(std::hypot(last.velocity[0], last.velocity[1]) <= contact_speed_max_m_per_s * (1 + 1e-12));
}

TEST_CASE("a vibration swings at its frequency and amplitude, and its phase has no step where the frequency changes")
{
    for (const double rate_hz : {1000.0, 4000.0}) {
        double hz = 60;
        Renderer renderer(shared(plane_with(
            [&](const haptel_point&, haptel_sample& sample) {
                sample.vibration_n = 0.2;
                sample.vibration_hz = hz;
            },
            rate_hz)));
        renderer.tick(at(0, 0, 1e-3));
        std::vector<double> swing_n;
        double x = 0; // on the move, so that the texture is asked again
        for (int i = 0; i < 3 * rate_hz; ++i) {
            if (i == rate_hz) hz = 97.5;
            swing_n.push_back(renderer.tick(at(x += 1e-9, 0, -depth_m)).unlimited_force_n.z - spring_n_per_m * depth_m);
        }
        // The amplitude at each frequency, by the definition of Fourier's sum over one second.
        const auto amplitude = [&](double frequency, int from) {
            double real = 0, imaginary = 0;
            const int count = static_cast<int>(rate_hz);
            for (int i = 0; i < count; ++i) {
                const double turn = 2 * std::numbers::pi * frequency * i / rate_hz;
                real += swing_n[from + i] * std::cos(turn);
                imaginary += swing_n[from + i] * std::sin(turn);
            }
            return 2 * std::hypot(real, imaginary) / count;
        };
        const int second = static_cast<int>(rate_hz);
        CAPTURE(rate_hz);
        CHECK(std::abs(amplitude(60, 0) - 0.2) < 2e-3);
        CHECK(std::abs(amplitude(98, second + second / 2) + amplitude(97, second + second / 2)) > 0.2);
        double step_n = 0;
        for (std::size_t i = 1; i < swing_n.size(); ++i)
            step_n = std::max(step_n, std::abs(swing_n[i] - swing_n[i - 1]));
        CHECK(step_n <= 0.2 * 2 * std::numbers::pi * 97.5 / rate_hz * (1 + 1e-9));
        CHECK(*std::ranges::max_element(swing_n) <= 0.2 * (1 + 1e-12));
    }
}

TEST_CASE("a vibration begins at nothing, never pulls, and is left out where the servo is too slow for it")
{
    double hz = 100;
    Renderer renderer(shared(plane_with([&](const haptel_point&, haptel_sample& sample) {
        sample.vibration_n = 5; // more than what presses
        sample.vibration_hz = hz;
    })));
    renderer.tick(at(0, 0, 1e-3));
    double least_n = 0;
    for (int i = 0; i < 2000; ++i) {
        const double z = -1e-6 * i;
        const double force_n = renderer.tick(at(1e-7 * i, 0, z)).unlimited_force_n.z;
        least_n = std::min(least_n, force_n);
        CHECK(force_n <= 2 * spring_n_per_m * -z + 1e-9);
    }
    CHECK(least_n == 0);
    hz = 500.5;
    const TickResult fast = renderer.tick(at(1e-3, 0, -depth_m));
    CHECK((fast.faults & fault_vibration_too_fast) != 0);
    CHECK(std::abs(fast.unlimited_force_n.z - spring_n_per_m * depth_m) < 1e-9);
}

TEST_CASE("a vibration gives a hand no more than its amplitude times the way that the hand goes")
{
    Renderer renderer(shared(plane_with([&](const haptel_point& at, haptel_sample& sample) {
        sample.vibration_n = 0.3;
        sample.vibration_hz = 40 + 1000 * std::abs(at.velocity[0]);
    })));
    renderer.tick(at(0, 0, 1e-3));
    double given_j = 0, way_m = 0, before_z = 0;
    for (int i = 0; i < 20000; ++i) { // a hand that gives way to the vibration
        const double z = -depth_m + 2e-4 * std::sin(2 * std::numbers::pi * 40e-3 * i);
        const double force_n = renderer.tick(at(1e-5 * std::sin(i / 50.0), 0, z)).unlimited_force_n.z;
        if (i > 0) {
            given_j += (force_n + spring_n_per_m * z) * (z - before_z); // beside the spring
            way_m += std::abs(z - before_z);
        }
        before_z = z;
    }
    CHECK(std::abs(given_j) <= 0.3 * way_m);
}

TEST_CASE("tangents follow the mesh's coordinates, and the curvature is that of the ball")
{
    haptel_point last{};
    Scene scene =
        bare_scene(ball_mesh(4, 0.1),
                   sample_lambda([&](const haptel_point& at, haptel_sample&) { last = at; }, 0, 0, reads_contact));
    Renderer renderer(shared(std::move(scene)));
    for (double r : {0.06, 0.0495, 0.0495}) renderer.tick(at(r * 0.48, r * 0.6, r * 0.64));
    CHECK(std::abs(last.curvature_per_m - 20) < 0.6);                              // 1 / 50 mm
    CHECK((last.tangent[0] == 0 && last.tangent[1] == 0 && last.tangent[2] == 0)); // it has no coordinates

    // u = 30 x + 40 y and v = 10 x on the plane: u grows alone along +y, v alone along (4, -3) / 5.
    SurfacePoint place;
    place.shading.uv_dp = glm::dmat3x2(30, 10, 40, 0, 0, 0);
    const TextureBinding binding =
        sample_lambda([&](const haptel_point& at, haptel_sample&) { last = at; }, 0, 0, HAPTEL_READS_TANGENT);
    sample_texture(binding, place);
    CHECK(glm::distance(dvec3(last.tangent[0], last.tangent[1], last.tangent[2]), dvec3(0, 1, 0)) < 1e-15);
    CHECK(glm::distance(dvec3(last.bitangent[0], last.bitangent[1], last.bitangent[2]), dvec3(0.8, -0.6, 0)) < 1e-15);
}
