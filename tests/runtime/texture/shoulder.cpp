// A range of heights that was found and not proven is made true by shoulders.
#include "runtime/render/renderer.h"
#include "runtime/texture/surface_texture.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <cmath>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double true_m = 50e-6, found_m = 25e-6, shoulder_m = 10e-6; // of heights, up and down
constexpr double stiffness = 1000;                                    // N/m

double wave(const haptel_point& at, dvec3& gradient)
{
    const double a = 1500 * at.p[0] + 400 * at.p[1], b = 1100 * at.p[1];
    gradient = true_m * dvec3(1500 * std::cos(a) * std::cos(b),
                              400 * std::cos(a) * std::cos(b) - 1100 * std::sin(a) * std::sin(b), 0);
    return true_m * std::sin(a) * std::cos(b);
}

// Said to stay within half of its true range.
TextureBinding misjudged(double shoulder)
{
    TextureBinding binding = lambda_texture(wave, -found_m, found_m, HAPTEL_READS_POINT);
    binding.shoulder_m[0] = binding.shoulder_m[1] = shoulder;
    return binding;
}

SurfacePoint place(double x, double y)
{
    SurfacePoint at;
    at.p_m = {x, y, 0};
    return at;
}

// Of a loop of the hand below a textured plane, over what was pressed in.
double work_of_loop(const std::shared_ptr<const Scene>& scene, std::mt19937_64& random)
{
    const auto uniform = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    const double x = uniform(-0.03, 0.03), y = uniform(-0.03, 0.03), width_m = uniform(0.2e-3, 5e-3),
                 breadth_m = uniform(0.2e-3, 5e-3), depth_m = uniform(60e-6, 1e-3), swing = uniform(0.1, 0.9);
    Renderer renderer(scene);
    renderer.tick(at(x, y, 1e-3));
    dvec3 before_m(0), before_n(0);
    double given_j = 0;
    constexpr int steps = 20'000;
    for (int i = 0; i <= 2 * steps; ++i) {
        const double a = 2 * pi * i / steps;
        const dvec3 hand_m(x + width_m * std::cos(a), y + breadth_m * std::sin(a),
                           -depth_m * (1 + swing * std::sin(2 * a + 1)));
        const dvec3 force_n = renderer.tick(at(hand_m.x, hand_m.y, hand_m.z)).force_n;
        if (i > steps) given_j += glm::dot(0.5 * (force_n + before_n), hand_m - before_m);
        before_m = hand_m;
        before_n = force_n;
    }
    return given_j;
}

} // namespace

TEST_CASE("a height within what was found is felt as it is, and none is beyond")
{
    const TextureBinding bent = misjudged(shoulder_m);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(-0.05, 0.05);
    int inside = 0, beyond = 0;
    for (int i = 0; i < 20'000; ++i) {
        const SurfacePoint at = place(share(random), share(random));
        haptel_point point{};
        for (int k = 0; k < 3; ++k) point.p[k] = at.p_m[k];
        dvec3 gradient;
        const double height_m = wave(point, gradient);
        const TextureSample felt = sample_texture(bent, at);
        CHECK(std::fabs(felt.height_m) <= found_m);
        if (std::fabs(height_m) <= found_m - shoulder_m / 2) {
            ++inside;
            CHECK((felt.height_m == height_m && felt.gradient == gradient && felt.faults == 0));
        } else {
            ++beyond;
            CHECK(felt.faults == fault_height_bent);
        }
        CHECK(felt.envelope_m == std::min(0.0, felt.height_m - found_m));
    }
    CHECK((inside > 1000 && beyond > 1000));
}

TEST_CASE("what a shoulder bends has the gradient that differences have, and no step of its slope's change")
{
    const TextureBinding bent = misjudged(shoulder_m);
    constexpr double step_m = 1e-8;
    const auto height = [&](double x, double y) { return sample_texture(bent, place(x, y)).height_m; };
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> share(-0.05, 0.05);
    for (int i = 0; i < 5000; ++i) {
        const double x = share(random), y = share(random);
        const dvec3 gradient = sample_texture(bent, place(x, y)).gradient;
        CHECK(std::fabs((height(x + step_m, y) - height(x - step_m, y)) / (2 * step_m) - gradient.x) < 2e-7);
        CHECK(std::fabs((height(x, y + step_m) - height(x, y - step_m)) / (2 * step_m) - gradient.y) < 2e-7);
    }
    // Along a line through many shoulders the second derivative changes no faster than the wave's and the shoulder's
    // third derivatives say: 1500^3 * 50 um for the wave, and 6 slope^3 / L^2, 3 slope curvature 1.5 / L for the bend.
    constexpr double line_m = 1e-6, third_max = 1.6 * 170e3 + 6 * 0.075 * 0.075 * 0.075 / (shoulder_m * shoulder_m) +
                                                4.5 * 0.08 * 120 / shoulder_m;
    double before = 0, curvature_before = 0;
    for (int i = 0; i < 20'000; ++i) {
        const double slope = sample_texture(bent, place(i * line_m, 1e-4)).gradient.x;
        const double curvature = (slope - before) / line_m;
        if (i > 1) CHECK(std::fabs(curvature - curvature_before) <= third_max * line_m);
        before = slope;
        curvature_before = curvature;
    }
}

TEST_CASE("loops over a misjudged texture give no energy: a shoulder has a potential, a cut has none")
{
    const auto scene = [](double shoulder) { return shared(bare_scene(plane_mesh(), misjudged(shoulder))); };
    const auto bent = scene(shoulder_m), cut = scene(0);
    double most_j = 0, most_cut_j = 0;
    std::mt19937_64 random(5), same(5);
    for (int i = 0; i < tries(40); ++i) {
        most_j = std::max(most_j, std::fabs(work_of_loop(bent, random)));
        most_cut_j = std::max(most_cut_j, std::fabs(work_of_loop(cut, same)));
    }
    INFO("with a shoulder " << most_j << " J, cut " << most_cut_j << " J");
    CHECK(most_j < 1e-9);
    CHECK(most_cut_j > 10 * most_j);
}

TEST_CASE("the force over a misjudged texture is continuous, and its bent ticks are told")
{
    const auto scene = shared(bare_scene(plane_mesh(), misjudged(shoulder_m)));
    Renderer renderer(scene);
    constexpr double step_m = 1e-7, depth_m = 0.3e-3;
    renderer.tick(at(-5e-3, 1e-4, 1e-3));
    dvec3 before_n(0);
    uint32_t faults = 0;
    for (int i = 0; i < 100'000; ++i) {
        const TickResult tick = renderer.tick(at(-5e-3 + i * step_m, 1e-4, -depth_m));
        // K (slope + depth * curvature) a metre: 0.075 of slope, bent by at most 1.5 / L of its square.
        const double most_n =
            stiffness * step_m * (0.08 + (depth_m + 2 * found_m) * (115 + 1.5 * 0.08 * 0.08 / shoulder_m));
        if (i > 0) CHECK(glm::distance(tick.force_n, before_n) < most_n);
        before_n = tick.force_n;
        faults |= tick.faults;
    }
    CHECK(faults == fault_height_bent);
}

TEST_CASE("shoulders longer than the range of heights are refused")
{
    TextureBinding binding = misjudged(shoulder_m);
    CHECK(binding_fault(binding).empty());
    binding.shoulder_m[1] = 4 * found_m;
    CHECK_FALSE(binding_fault(binding).empty());
    binding.shoulder_m[1] = std::nan("");
    CHECK_FALSE(binding_fault(binding).empty());
}
