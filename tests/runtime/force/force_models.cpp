// Force models: the published formulae, and which of them give energy away on closed paths.
#include "runtime/force/force_model.h"
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double stiffness = 1000; // N/m

// Work that the static force field does on a hand taken once around the rectangle in the xz plane (J).
double loop_work_j(Renderer& renderer, double x0, double x1, double z_shallow, double z_deep, int steps)
{
    const std::array<glm::dvec2, 5> corners{
        {{x0, z_shallow}, {x0, z_deep}, {x1, z_deep}, {x1, z_shallow}, {x0, z_shallow}}};
    double work = 0;
    for (std::size_t edge = 0; edge + 1 < corners.size(); ++edge) {
        const glm::dvec2 along = corners[edge + 1] - corners[edge];
        for (int i = 0; i <= steps; ++i) { // Simpson's rule
            const double weight = (i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / (3.0 * steps);
            const glm::dvec2 p = corners[edge] + along * (static_cast<double>(i) / steps);
            const dvec3 force = renderer.tick(at(p.x, 1e-3, p.y)).force_n;
            work += weight * (force.x * along.x + force.z * along.y);
        }
    }
    return work;
}

constexpr double amplitude_m = 0.1e-3, wavelength_m = 2e-3, wave_per_m = 2 * std::numbers::pi / wavelength_m;

// From a valley of a sine on a plane to a crest and back at another depth, refined until it changes by less than
// 1e-10 J.
double refined_loop_work_j(const ForceRule& rule, double shallow_m, double deep_m)
{
    Scene scene = bare_scene(plane_mesh(), sine_texture(amplitude_m, wavelength_m));
    scene.servo.force = rule;
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 1e-3, 1e-3)); // put down above
    double work = 0, before = 1;
    for (int steps = 16; std::abs(work - before) >= 1e-10 && steps <= 1 << 16; steps *= 2) {
        before = work;
        work = loop_work_j(renderer, -wavelength_m / 4, wavelength_m / 4, -shallow_m, -deep_m, steps);
    }
    REQUIRE(std::abs(work - before) < 1e-10);
    return work;
}

// A smooth solid by its surface: where a point projects to, how deep it is, how the normals turn there.
struct Solid {
    std::function<dvec3(const dvec3&)> foot;   // nearest point of the surface
    std::function<dvec3(const dvec3&)> normal; // outward unit normal at the foot
    double step_m = 1e-6;

    double depth(const dvec3& p) const { return glm::dot(foot(p) - p, normal(p)); }
    // How the foot moves with the hand, by differences.
    glm::dmat3 foot_dp(const dvec3& p) const
    {
        glm::dmat3 result(0);
        for (int j = 0; j < 3; ++j) {
            dvec3 step(0);
            step[j] = step_m;
            result[j] = (foot(p + step) - foot(p - step)) / (2 * step_m);
        }
        return result;
    }
};

Foot foot_at(double depth_m, const dvec3& way, const dvec3& normal)
{
    Foot foot = flat_foot(Surface(), {});
    foot.depth_m = depth_m;
    foot.way = way;
    foot.normal = foot.push = normal;
    return foot;
}

Solid ball(double radius_m)
{
    return {[=](const dvec3& p) { return radius_m * glm::normalize(p); },
            [](const dvec3& p) { return glm::normalize(p); }};
}

// Around the z axis; curved both ways, and on its inside in opposite ones.
Solid ring(double ring_m, double tube_m)
{
    const auto centre = [=](const dvec3& p) { return ring_m * glm::normalize(dvec3(p.x, p.y, 0)); };
    const auto normal = [=](const dvec3& p) { return glm::normalize(p - centre(p)); };
    return {[=](const dvec3& p) { return centre(p) + tube_m * normal(p); }, normal};
}

double solid_height(const dvec3& p)
{
    return amplitude_m * std::sin(2000 * p.x + 1300 * p.y) * std::cos(1700 * p.z);
}

dvec3 solid_gradient(const dvec3& p)
{
    const double a = 2000 * p.x + 1300 * p.y, b = 1700 * p.z;
    return amplitude_m *
           dvec3(2000 * std::cos(a) * std::cos(b), 1300 * std::cos(a) * std::cos(b), -1700 * std::sin(a) * std::sin(b));
}

dvec3 force_on(const Solid& solid, const dvec3& p, const ForceRule& rule, bool curved)
{
    const dvec3 foot = solid.foot(p), normal = solid.normal(p);
    TextureSample texture;
    texture.height_m = solid_height(foot);
    texture.envelope_m = texture.height_m - amplitude_m;
    texture.gradient = solid_gradient(foot);
    Foot felt = foot_at(solid.depth(p), normal, normal);
    if (curved) { // along two tangents, moved as the foot moves
        const glm::dmat3 moves = glm::transpose(solid.foot_dp(p));
        felt.edge_m[0] =
            glm::normalize(glm::cross(normal, std::fabs(normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
        felt.edge_m[1] = glm::cross(normal, felt.edge_m[0]);
        felt.turned_per_m2 = normal;
        felt.line_m[0] = glm::cross(moves * felt.edge_m[1], normal);
        felt.line_m[1] = glm::cross(normal, moves * felt.edge_m[0]);
    }
    return model_force(rule, felt, stiffness, texture).force_n;
}

} // namespace

TEST_CASE("force models are the published formulae")
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> part(-1, 1), positive(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 n = glm::normalize(dvec3(part(random), part(random), part(random)));
        const dvec3 facet = glm::normalize(n + 0.1 * dvec3(part(random), part(random), part(random)));
        const dvec3 dh = 2.0 * dvec3(part(random), part(random), part(random)); // the whole gradient
        const double d = 1e-3 * positive(random), h = 1e-3 * positive(random), h_max = 1e-3;
        TextureSample texture;
        texture.height_m = texture.raised_m = h;
        texture.envelope_m = h - h_max;
        texture.gradient = dh;
        texture.stiffness_scale = 0.5 + positive(random);
        const double k = stiffness * texture.stiffness_scale;
        const auto force = [&](ForceModel model) {
            return model_force({model, 0.4e-3}, foot_at(d, facet, n), stiffness, texture).force_n;
        };
        const auto near = [](const dvec3& a, const dvec3& b) { return glm::length(a - b) < 1e-12; };

        const dvec3 ap = d * facet; // from the tip A to the contact P
        const dvec3 m = n - dh + glm::dot(dh, n) * n;
        const double pressed = glm::dot(ap, n);
        CHECK(near(force(ForceModel::paper), k * pressed * m));
        CHECK(near(force(ForceModel::paper_unit), k * pressed * m / glm::length(m)));
        CHECK(std::abs(glm::length(force(ForceModel::paper_unit)) - k * pressed) < 1e-12);
        // Presence 8(5): (d - Kh) N + Kh M where d >= Kh, else d M; the texture's own scale is its K.
        CHECK(near(force(ForceModel::ho99), k * (pressed >= h ? (pressed - h) * n + h * m : pressed * m)));
        const dvec3 lateral = force(ForceModel::lateral);
        CHECK(near(tangential(lateral, n), -k * std::min(pressed, 0.4e-3) * tangential(dh, n)));
        CHECK(std::abs(glm::dot(lateral, n) - k * pressed) < 1e-12);
        CHECK(near(force(ForceModel::displaced), k * std::max(0.0, d + h - h_max) * m));
    }
}

TEST_CASE("ho99 raises a texture below zero by its bound, and leaves one above zero as it is")
{
    for (const double lowest_m : {-0.2e-3, 0.0, 0.1e-3}) {
        constexpr double depth_m = 1e-3, slope = 0.3, rise_m = 0.15e-3;
        Scene scene = bare_scene(plane_mesh(), lambda_texture(
                                                   [=](const haptel_point&, dvec3& gradient) {
                                                       gradient.x = slope;
                                                       return lowest_m + rise_m;
                                                   },
                                                   lowest_m, 1e-3));
        scene.servo.force.model = ForceModel::ho99;
        Renderer renderer(shared(std::move(scene)));
        renderer.tick(at(0, 1e-3, 1e-3));
        const dvec3 force = renderer.tick(at(0, 1e-3, -depth_m)).force_n;
        CHECK(std::abs(force.z - stiffness * depth_m) < 1e-9);
        CHECK(std::abs(force.x + stiffness * slope * (std::max(lowest_m, 0.0) + rise_m)) < 1e-9);
    }
}

TEST_CASE("on a plane each force model gives away what its formula says")
{
    // Depth 0.3 to 0.8 mm, height -0.1 to 0.1 mm.
    constexpr double deeper_m = 0.5e-3, higher_m = 2 * amplitude_m;
    const auto work = [](ForceModel model, double shallow_m, double deep_m) {
        return std::abs(refined_loop_work_j({model, 0.25e-3}, shallow_m, deep_m));
    };
    CHECK(work(ForceModel::displaced, 0.3e-3, 0.8e-3) < 1e-9);
    CHECK(std::abs(work(ForceModel::paper, 0.3e-3, 0.8e-3) - stiffness * deeper_m * higher_m) < 1e-9);
    // The integral of h' / sqrt(1 + h'^2) over the half wave.
    const double unit_rise_m = 2 * std::atan(amplitude_m * wave_per_m) / wave_per_m;
    CHECK(std::abs(work(ForceModel::paper_unit, 0.3e-3, 0.8e-3) - stiffness * deeper_m * unit_rise_m) < 1e-9);
    // Deeper than the texture is high, or than l.
    CHECK(work(ForceModel::ho99, 0.3e-3, 0.8e-3) < 1e-9);
    CHECK(work(ForceModel::lateral, 0.3e-3, 0.8e-3) < 1e-9);
    // Shallower: the integral of min(d, h) dh, and d dh.
    const auto ho_j = [](double d) { return stiffness * (d * higher_m - d * d / 2); };
    CHECK(std::abs(work(ForceModel::ho99, 0.02e-3, 0.1e-3) - (ho_j(0.1e-3) - ho_j(0.02e-3))) < 1e-9);
    CHECK(std::abs(work(ForceModel::lateral, 0.1e-3, 0.2e-3) - stiffness * 0.1e-3 * higher_m) < 1e-9);
}

TEST_CASE("on a curved base displaced is minus the gradient of its potential")
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(-1, 1);
    const std::array<Solid, 2> solids{ball(0.02), ring(0.03, 0.01)};
    for (const Solid& solid : solids) {
        const auto energy_j = [&](const dvec3& p) {
            const double felt = std::max(0.0, solid.depth(p) + solid_height(solid.foot(p)) - amplitude_m);
            return 0.5 * stiffness * felt * felt;
        };
        double largest_without = 0;
        for (int i = 0; i < 500; ++i) {
            dvec3 p(0.03 * part(random), 0.03 * part(random), 0.01 * part(random));
            p = solid.foot(p) - solid.normal(p) * 1e-3 * (1 + part(random)); // up to 2 mm deep
            dvec3 expected;
            for (int j = 0; j < 3; ++j) {
                dvec3 step(0);
                step[j] = 1e-7;
                expected[j] = -(energy_j(p + step) - energy_j(p - step)) / 2e-7;
            }
            CHECK(glm::length(force_on(solid, p, {}, true) - expected) < 1e-6);
            largest_without = std::max(largest_without, glm::length(force_on(solid, p, {}, false) - expected));
        }
        CHECK(largest_without > 1e-2); // N: what the factor is for
    }
}
