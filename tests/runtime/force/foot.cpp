// The smooth surface for which facets stand: its force is that of one potential, and near that of the true shape.
#include "runtime/force/foot.h"
#include "runtime/contact/walk_contact.h"
#include "runtime/render/renderer.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double size_m = 0.1, ball_m = size_m / 2;

// Held by contact off the facets, and the smooth foot of that; or none.
class Stroke {
public:
    explicit Stroke(std::shared_ptr<const Surface> surface) : surface_(surface), contact_(std::move(surface)) {}

    const FacetLines& lines() const { return lines_; } // of that foot

    std::optional<Foot> foot(const dvec3& hand_m)
    {
        contact_.tick(hand_m, {});
        const Contact& contact = contact_.contact();
        if (!contact.touching || contact.depth_m == 0) return std::nullopt;
        const Foot foot = smooth_foot(*surface_, contact, hand_below(contact), lines_);
        return foot.share > 0 ? std::optional(foot) : std::nullopt;
    }

private:
    std::shared_ptr<const Surface> surface_;
    WalkContact contact_;
    FacetLines lines_;
};

Mesh bumpy_mesh(uint32_t subdivisions)
{
    Mesh mesh = make_bumpy_sphere(subdivisions);
    scale_to_size(mesh, size_m);
    return mesh;
}

} // namespace

TEST_CASE("what a foot says of its changes is what differences say")
{
    // Coarse, so that lines meet within reach and `share` is between 0 and 1, too.
    int compared = 0, shared_ones = 0;
    for (const Mesh& mesh : {ball_mesh(1, size_m), bumpy_mesh(3), shape("torus", size_m)}) {
        const auto surface = surface_of(mesh);
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> uniform(-1, 1);
        for (int i = 0; i < tries(4000); ++i) {
            const auto face = static_cast<uint32_t>(random() % surface->faces.size());
            const dvec3 middle_m =
                (surface->vertex_m(face, 0) + surface->vertex_m(face, 1) + surface->vertex_m(face, 2)) / 3.0;
            const dvec3 normal = surface->facet_normal(face);
            Stroke stroke(surface);
            stroke.foot(middle_m + 1e-3 * normal);
            const double deep_m = std::exp(uniform(random) * 2.3 - 5.3); // 0.5 to 50 mm
            const dvec3 hand_m = middle_m - deep_m * normal + 0.3 * deep_m * dvec3(uniform(random), uniform(random), 0);
            const auto here = stroke.foot(hand_m);
            if (!here) continue;
            const glm::dmat3 turns = turning(stroke.lines(), *here);
            constexpr double step_m = 1e-7;
            dvec3 depth_dp, share_dp;
            glm::dmat3 at_dp, normal_dp;
            bool same = true; // contact clicks from one facet to another
            for (int j = 0; j < 3 && same; ++j) {
                dvec3 step(0);
                step[j] = step_m;
                const auto ahead = stroke.foot(hand_m + step), behind = stroke.foot(hand_m - step);
                same = ahead && behind && ahead->face == here->face && behind->face == here->face &&
                       std::fabs(ahead->depth_m - behind->depth_m) < 10 * step_m;
                if (!same) break;
                depth_dp[j] = (ahead->depth_m - behind->depth_m) / (2 * step_m);
                share_dp[j] = (ahead->share - behind->share) / (2 * step_m);
                at_dp[j] = (ahead->at_m - behind->at_m) / (2 * step_m);
                normal_dp[j] = (ahead->normal - behind->normal) / (2 * step_m);
            }
            if (!same) continue;
            ++compared;
            shared_ones += here->share < 1;
            const double scale = 1 + glm::length(here->push);
            CAPTURE(i, face, deep_m, here->share);
            CHECK(glm::distance(here->push, -depth_dp) < 1e-4 * scale);
            if (here->share < 1) CHECK(glm::distance(here->share_dp, share_dp) < 3e-4 * (1 + glm::length(share_dp)));
            const dvec3 g(uniform(random), uniform(random), uniform(random)); // of a height
            CHECK(glm::distance(here->felt(g), g * at_dp) < 1e-4 * (1 + glm::length(here->felt(g))));
            CHECK(glm::distance(turns * g, normal_dp * g) < 1e-4 * (1 + glm::length(turns * g)));
        }
    }
    CHECK(compared > tries(4000));
    CHECK(shared_ones > tries(100));
}

TEST_CASE("beyond borders and corners of an open surface a foot says of its changes what differences say")
{
    Mesh cap = ball_mesh(1, size_m); // of which the triangles above stay
    std::erase_if(cap.triangles, [&](const auto& triangle) {
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](uint32_t corner) { return cap.positions_m[corner].z < 0.2 * size_m; });
    });
    const auto surface = surface_of(cap);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int beyond_borders = 0, beyond_corners = 0;
    for (int i = 0; i < tries(20'000); ++i) {
        Contact contact;
        contact.touching = true;
        contact.face = static_cast<uint32_t>(random() % surface->faces.size());
        contact.barycentric = dvec3(1, 1, 1) / 3.0;
        contact.normal = contact.facet_normal = surface->facet_normal(contact.face);
        const uint32_t corner = static_cast<uint32_t>(random() % 3);
        const dvec3 hand_m = surface->vertex_m(contact.face, corner) - 2e-3 * contact.normal +
                             4e-3 * dvec3(uniform(random), uniform(random), uniform(random));
        const auto foot_of = [&](const dvec3& hand) {
            FacetLines lines;
            return smooth_foot(*surface, contact, hand, lines);
        };
        FacetLines lines;
        const Foot here = smooth_foot(*surface, contact, hand_m, lines);
        const int borders = static_cast<int>(here.barycentric.x == 0) + static_cast<int>(here.barycentric.y == 0) +
                            static_cast<int>(here.barycentric.z == 0);
        if (here.share == 0 || borders == 0) continue;
        const dvec3 g(uniform(random), uniform(random), uniform(random)); // of a height
        constexpr double step_m = 1e-8;
        dvec3 felt(0), depth_dp(0);
        glm::dmat3 normal_dp;
        bool same = true; // and not at the place where another facet begins
        for (int j = 0; j < 3; ++j) {
            dvec3 step(0);
            step[j] = step_m;
            const Foot ahead = foot_of(hand_m + step), behind = foot_of(hand_m - step);
            same = same && ahead.face == here.face && behind.face == here.face && ahead.share > 0 && behind.share > 0 &&
                   glm::equal(ahead.barycentric, dvec3(0)) == glm::equal(here.barycentric, dvec3(0)) &&
                   glm::equal(behind.barycentric, dvec3(0)) == glm::equal(here.barycentric, dvec3(0));
            felt[j] = glm::dot(g, ahead.at_m - behind.at_m) / (2 * step_m);
            depth_dp[j] = (ahead.depth_m - behind.depth_m) / (2 * step_m);
            normal_dp[j] = (ahead.normal - behind.normal) / (2 * step_m);
        }
        if (!same) continue;
        (borders == 2 ? beyond_corners : beyond_borders) += 1;
        CAPTURE(i, borders);
        CHECK(glm::distance(here.felt(g), felt) < 1e-5);
        CHECK(glm::distance(here.push, -depth_dp) < 1e-5 * (1 + glm::length(here.push)));
        const glm::dvec3 turned = turning(lines, here) * g;
        CHECK(glm::distance(turned, normal_dp * g) < 1e-4 * (1 + glm::length(turned)));
    }
    CHECK(beyond_borders > tries(100));
    CHECK(beyond_corners > tries(20));
}

TEST_CASE("on a ball of 5 120 triangles the force is that of the ball")
{
    Renderer renderer(shared(bare_scene(ball_mesh(4, size_m))));
    renderer.tick(at(0, 0, 1.1 * ball_m));
    for (const double deep_m : {0.5e-3, 1e-3, 2.5e-3, 5e-3}) {
        CAPTURE(deep_m);
        const double radius_m = ball_m - deep_m, tick_m = 1e-4, turn = tick_m / radius_m;
        double most_degrees = 0, most_change = 0, most_off = 0;
        dvec3 before_n(0);
        for (int i = 0; i < 20'000; ++i) { // at 0.1 m/s, on a circle that turns from pole to pole
            const double a = turn * i, b = 0.02 * a;
            const dvec3 d(std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a));
            const dvec3 force_n = renderer.tick({radius_m * d, radius_m * d}).force_n;
            most_degrees = std::max(most_degrees, degrees_between(force_n, d));
            most_off = std::max(most_off, std::fabs(glm::length(force_n) / (spring_n_per_m * deep_m) - 1));
            if (i > 0) most_change = std::max(most_change, glm::distance(force_n, before_n));
            before_n = force_n;
        }
        CHECK(most_degrees < 0.3);
        CHECK(most_off < 1e-3);
        CHECK(most_change < 1.2 * spring_n_per_m * deep_m * turn);
    }
}

TEST_CASE("on a ball of 5 120 triangles the force is minus the gradient of the work that pressing in took")
{
    const TextureBinding waves = lambda_texture(
        [](const haptel_point& at, dvec3& gradient) {
            gradient = 25e-6 * 2000 * std::cos(2000 * at.p[0]) * dvec3(1, 0, 0);
            return 25e-6 * std::sin(2000 * at.p[0]);
        },
        -25e-6, 25e-6, HAPTEL_READS_POINT);
    for (const TextureBinding& texture : {TextureBinding(), waves})
        for (const double radius_m : {0.0, 2.5e-3}) {
            Scene scene = bare_scene(ball_mesh(4, size_m), texture);
            scene.probe = {radius_m > 0 ? ProbeKind::sphere : ProbeKind::point, 0.15, radius_m};
            const auto touched = shared(std::move(scene));
            // Straight in from outside, toward the middle.
            const auto pressed = [&](const dvec3& hand_m) {
                constexpr int steps = 4000;
                Renderer renderer(touched);
                const dvec3 from_m = (ball_m + radius_m + 1e-5) * glm::normalize(hand_m),
                            step_m = (hand_m - from_m) / double(steps);
                renderer.tick({from_m, from_m});
                dvec3 force_n(0);
                double work_j = 0;
                for (int i = 1; i <= steps; ++i) {
                    const dvec3 at_m = from_m + double(i) * step_m, before_n = force_n;
                    force_n = renderer.tick({at_m, at_m}).force_n;
                    work_j -= glm::dot(0.5 * (before_n + force_n), step_m);
                }
                return std::pair(work_j, force_n);
            };
            std::mt19937_64 random(11);
            std::normal_distribution<double> normal;
            std::uniform_real_distribution<double> uniform(0.2e-3, 5e-3);
            for (int i = 0; i < tries(30); ++i) {
                const dvec3 d(normal(random), normal(random), normal(random));
                const dvec3 hand_m = (ball_m + radius_m - uniform(random)) * glm::normalize(d);
                dvec3 gradient;
                for (int j = 0; j < 3; ++j) {
                    dvec3 step(0);
                    step[j] = 2e-6;
                    gradient[j] = (pressed(hand_m + step).first - pressed(hand_m - step).first) / 4e-6;
                }
                const dvec3 force_n = pressed(hand_m).second;
                CAPTURE(radius_m, i, glm::length(force_n));
                CHECK(glm::distance(force_n, -gradient) < 1e-4 * glm::length(force_n));
            }
        }
}

TEST_CASE("from the first touch on, the force of a ball of triangles turns as a ball's")
{
    for (const uint32_t subdivisions : {2u, 3u, 4u}) {
        Renderer renderer(shared(bare_scene(ball_mesh(subdivisions, size_m))));
        renderer.tick(at(0, 0, 1.1 * ball_m));
        const double edge_m = 1.1 * ball_m / (1 << subdivisions), facets_degrees = 46.0 / (1 << subdivisions);
        int felt = 0;
        for (const double deep : {1e-3, 1e-2, 3e-2, 0.1, 0.3}) { // edges
            const double radius_m = ball_m - deep * edge_m, step_m = 2e-6;
            double most_off = 0, most_turn = 0;
            dvec3 before_n(0);
            for (int i = 0; i < 40'000; ++i) {
                const double a = step_m / radius_m * i;
                const dvec3 d = glm::normalize(dvec3(std::cos(a), 0.3 * std::cos(a), std::sin(a)));
                const dvec3 force_n = renderer.tick({radius_m * d, radius_m * d}).force_n;
                if (glm::length(force_n) > 0) {
                    ++felt;
                    most_off = std::max(most_off, degrees_between(force_n, d));
                    if (glm::length(before_n) > 0) most_turn = std::max(most_turn, degrees_between(force_n, before_n));
                }
                before_n = force_n;
            }
            CAPTURE(subdivisions, deep);
            CHECK(most_off < 0.25 * facets_degrees);
            CHECK(most_turn < 0.4 * facets_degrees);
        }
        CHECK(felt > 40'000);
    }
}

TEST_CASE("a texture on a round surface is where the hand is, at any depth")
{
    // A grating by the angle about an axis that no edge follows.
    constexpr int waves = 157;
    const dvec3 axis = glm::normalize(dvec3(1, 2, 3)), east = glm::normalize(glm::cross(axis, dvec3(1, 0, 0))),
                north = glm::cross(axis, east);
    const TextureBinding grating = lambda_texture(
        [=](const haptel_point& at, dvec3& gradient) {
            const dvec3 p(at.p[0], at.p[1], at.p[2]);
            const double x = glm::dot(p, east), y = glm::dot(p, north), a = waves * std::atan2(y, x);
            gradient = 1e-5 * waves * std::cos(a) / (x * x + y * y) * (x * north - y * east);
            return 1e-5 * std::sin(a);
        },
        -1e-5, 1e-5, HAPTEL_READS_POINT);
    Renderer renderer(shared(bare_scene(ball_mesh(4, size_m), grating)));
    for (const double deep_m : {0.1e-3, 0.5e-3, 2.5e-3, 5e-3}) {
        CAPTURE(deep_m);
        const auto hand = [&](double a) { return (ball_m - deep_m) * (std::cos(a) * east + std::sin(a) * north); };
        renderer.tick({1.1 * hand(0), {}});
        renderer.tick({hand(0), {}});
        constexpr int ticks = 200'000;
        double before_m = 0, crossed = -1, widest = 0, narrowest = 1e9;
        for (int i = 1; i <= ticks; ++i) {
            const double a = 2 * std::numbers::pi * i / ticks, height_m = renderer.tick({hand(a), {}}).height_m;
            if (before_m < 0 && height_m >= 0) {
                const double here = a - 2 * std::numbers::pi / ticks * height_m / (height_m - before_m);
                if (crossed >= 0)
                    widest = std::max(widest, here - crossed), narrowest = std::min(narrowest, here - crossed);
                crossed = here;
            }
            before_m = height_m;
        }
        CHECK(widest * waves / (2 * std::numbers::pi) < 1.005);
        CHECK(narrowest * waves / (2 * std::numbers::pi) > 0.995);
    }
}

TEST_CASE("where a texture is felt moves as the hand does")
{
    for (const Mesh& mesh : {ball_mesh(4, size_m), shape("torus", size_m)}) {
        const auto surface = surface_of(mesh);
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> uniform(-1, 1);
        for (int i = 0; i < tries(100); ++i) {
            const auto face = static_cast<uint32_t>(random() % surface->faces.size());
            const dvec3 normal = surface->facet_normal(face), from_m = surface->vertex_m(face, 0);
            const dvec3 along = glm::normalize(surface->vertex_m(face, 1) - surface->vertex_m(face, 2));
            // To a twentieth of the least radius of curvature.
            const double least_m = i % 2 ? 1e-4 : 5e-4, way_m = 1e-5;
            Stroke stroke(surface);
            stroke.foot(from_m + 1e-3 * normal);
            std::optional<Foot> before;
            for (int k = 0; k < 400; ++k) {
                const auto foot = stroke.foot(from_m + k * way_m * along - least_m * normal);
                if (foot && before) CHECK(glm::distance(foot->at_m, before->at_m) <= 1.5 * way_m);
                before = foot;
            }
        }
    }
}
