// Where force shading ends: creases, and how fast shading normals turn between them.
#include "runtime/contact/contact.h"
#include "runtime/render/renderer.h"
#include "runtime/surface/corner.h"
#include "runtime/texture/shading.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using namespace haptel::tests;
using glm::dvec3;

namespace {

// A closed prism around the z axis of radius and height 1, with `sides` walls.
Mesh make_prism(uint32_t sides)
{
    Mesh mesh;
    for (double z : {-0.5, 0.5})
        for (uint32_t i = 0; i < sides; ++i) {
            const double angle = 2 * std::numbers::pi * i / sides;
            mesh.positions_m.emplace_back(std::cos(angle), std::sin(angle), z);
        }
    mesh.positions_m.insert(mesh.positions_m.end(), {{0, 0, -0.5}, {0, 0, 0.5}});
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t j = (i + 1) % sides;
        mesh.triangles.insert(
            mesh.triangles.end(),
            {{i, j, sides + j}, {i, sides + j, sides + i}, {j, i, 2 * sides}, {sides + i, sides + j, 2 * sides + 1}});
    }
    return mesh;
}

// Two walls that meet in a straight valley along y at the origin, each rising at `slope_deg`.
Mesh make_valley(double slope_deg)
{
    const double x = std::cos(glm::radians(slope_deg)), z = std::sin(glm::radians(slope_deg));
    Mesh mesh;
    mesh.positions_m = {{0, -1, 0}, {x, -1, z}, {x, 1, z}, {0, 1, 0}, {-x, -1, z}, {-x, 1, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 0, 3}, {4, 3, 5}};
    return mesh;
}

std::shared_ptr<const Surface> surface_with(const Mesh& mesh, double crease_deg)
{
    return build_surface(mesh, crease_deg).surface;
}

dvec3 random_weights(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> uniform(0, 1);
    const dvec3 w(uniform(random), uniform(random), uniform(random));
    return w / (w.x + w.y + w.z);
}

// The largest factor by which a matrix stretches, by power iteration.
double spectral_norm(const glm::dmat3& m)
{
    dvec3 v(0.6, 0.5, 0.4);
    for (int i = 0; i < 200; ++i) {
        const dvec3 next = glm::transpose(m) * (m * v);
        if (glm::length(next) == 0) return 0;
        v = glm::normalize(next);
    }
    return glm::length(m * v);
}

} // namespace

TEST_CASE("a box keeps its edges and is flat between them, unless everything is rounded")
{
    std::mt19937_64 random(2);
    const auto box = surface_with(make_box({1, 2, 3}), default_crease_deg),
               round = surface_with(make_box({1, 2, 3}), 180);
    CHECK(box->normal_turn_max_per_m == 0);
    double furthest = 0;
    for (uint32_t face = 0; face < 12; ++face)
        for (uint32_t side = 0; side < 2; ++side)
            for (int i = 0; i < 20; ++i) {
                const dvec3 w = random_weights(random);
                CHECK(shading_normal(*box, face, side, w) == box->facet_normal(face, side));
                CHECK(shade(*box, face, side, w).normal_dp == glm::dmat3(0));
                furthest = std::max(
                    furthest, glm::distance(shading_normal(*round, face, side, w), round->facet_normal(face, side)));
            }
    CHECK(furthest > 0.5);
}

TEST_CASE("the crease angle decides between a prism with corners and a round one")
{
    for (const uint32_t sides : {8u, 10u}) { // its walls meet at 45 and at 36 degrees
        const auto prism = surface_with(make_prism(sides), 40);
        for (uint32_t face = 0; face < prism->faces.size(); ++face)
            for (const uint32_t corner : {0u, 1u, 2u})
                for (const uint32_t side : {0u, 1u}) {
                    dvec3 w(0);
                    w[int(corner)] = 1;
                    const dvec3 at = prism->vertex_m(face, corner), facet = prism->facet_normal(face);
                    // On the lids, and everywhere where walls meet in creases, the facet's; else the cylinder's.
                    const bool on_lid = std::abs(facet.z) > 0.5;
                    const dvec3 expected = on_lid || sides == 8 ? facet : dvec3(at.x, at.y, 0);
                    const dvec3 found = (side ? -1.0 : 1.0) * shading_normal(*prism, face, side, w);
                    CHECK(glm::distance(found, expected) < 1e-9);
                }
    }
}

TEST_CASE("shading is continuous over smooth edges and creases are known for what they are")
{
    for (const uint32_t sides : {8u, 10u}) {
        const auto prism = surface_with(make_prism(sides), 40);
        for (uint32_t face = 0; face < prism->faces.size(); ++face)
            for (uint32_t edge = 0; edge < 3; ++edge)
                for (const uint32_t side : {0u, 1u}) {
                    const SideEdge link = prism->faces[face].link[edge][side];
                    const double angle = std::acos(std::clamp(
                        glm::dot(prism->facet_normal(face, side), prism->facet_normal(link.face(), link.side())), -1.0,
                        1.0));
                    const bool crease = glm::degrees(angle) > 40;
                    const bool same_way =
                        prism->faces[link.face()].vertex[link.edge()] == prism->faces[face].vertex[edge];
                    for (const double share : {0.2, 0.7}) {
                        dvec3 here(0), there(0);
                        here[int(edge)] = share, here[int((edge + 1) % 3)] = 1 - share;
                        there[int(link.edge())] = same_way ? share : 1 - share;
                        there[int((link.edge() + 1) % 3)] = same_way ? 1 - share : share;
                        CHECK(on_crease(*prism, face, side, here) == crease);
                        if (crease) continue;
                        CHECK(glm::distance(shading_normal(*prism, face, side, here),
                                            shading_normal(*prism, link.face(), link.side(), there)) < 1e-12);
                    }
                    CHECK_FALSE(on_crease(*prism, face, side, {0.3, 0.3, 0.4}));
                    dvec3 corner(0);
                    corner[int(edge)] = 1;
                    const dvec3 at = prism->vertex_m(face, edge);
                    CHECK(on_crease(*prism, face, side, corner) == (std::abs(at.x) + std::abs(at.y) > 0.5));
                }
    }
}

TEST_CASE("no shading normal turns faster than the surface says, and the bound is near")
{
    for (const Mesh& mesh : {make_torus(0.4, 24, 12), make_icosphere(2), make_bumpy_sphere(3), make_prism(10)}) {
        const auto surface = surface_of(mesh);
        std::mt19937_64 random(7);
        double fastest = 0;
        for (uint32_t face = 0; face < surface->faces.size(); ++face)
            for (int i = 0; i < 6; ++i) {
                const Shading shading = shade(*surface, face, uint32_t(i % 2), random_weights(random));
                const double turn = spectral_norm(shading.normal_dp);
                CHECK(turn <= surface->normal_turn_max_per_m);
                fastest = std::max(fastest, turn);
            }
        CHECK(fastest > 0.8 * surface->normal_turn_max_per_m);
    }
    // A ball of radius 20 mm.
    Mesh ball = make_icosphere(5);
    scale_to_size(ball, 0.04);
    CHECK(std::abs(surface_of(ball)->normal_turn_max_per_m - 50) < 3);
}

TEST_CASE("through a valley that is a crease the force turns without a jump")
{
    Renderer renderer([&] {
        Scene scene = bare_scene(make_valley(30));
        scene.objects[0].surface = surface_with(make_valley(30), 40);
        return shared(std::move(scene));
    }());
    renderer.tick(at(-0.3, 0.1, 0.5));
    const dvec3 right = glm::normalize(dvec3(-std::sin(std::numbers::pi / 6), 0, std::cos(std::numbers::pi / 6))),
                left(-right.x, 0, right.z);
    constexpr double depth_m = 1e-3, step_m = 1e-6;
    dvec3 last(0);
    double largest_n = 0;
    for (int i = -3000; i <= 3000; ++i) {
        const double x = i * step_m; // level, so deep below both walls in the middle
        const dvec3 hand(x, 0.1, -depth_m);
        const dvec3 force = renderer.tick({hand, hand}).force_n;
        if (i > -3000) largest_n = std::max(largest_n, glm::distance(force, last));
        last = force;
        const dvec3 to_foot = -dvec3(hand.x, 0, hand.z); // from the hand to the valley's line
        if (glm::dot(to_foot, dvec3(right.z, 0, -right.x)) > 1e-9 &&
            glm::dot(to_foot, dvec3(-left.z, 0, left.x)) > 1e-9)
            CHECK(glm::distance(force, 1000.0 * to_foot) < 1e-6);
    }
    CHECK(largest_n < 3 * 1000 * step_m);
    CHECK(last.x < -0.1); // it has passed through
}

TEST_CASE("smoothing groups part what the crease angle would round, and never round what it parts")
{
    // The walls of a round prism, alternately of two groups, but for a run of three of one group and one of none.
    Mesh mesh = make_prism(10);
    const auto group_of_wall = [](uint32_t wall) { return wall == 9 ? 0 : wall < 3 ? 1 : 1 + wall % 2; };
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        mesh.smoothing_groups.push_back(t % 4 < 2 ? group_of_wall(t / 4) : 3);
    const auto prism = surface_with(mesh, 40), angular = surface_with(mesh, 20);
    REQUIRE(prism->faces.size() == 40);
    for (uint32_t face = 0; face < 40; ++face)
        for (const uint32_t corner : {0u, 1u, 2u})
            for (const uint32_t side : {0u, 1u}) {
                dvec3 w(0);
                w[int(corner)] = 1;
                const double sign = side ? -1 : 1;
                const dvec3 facet = prism->facet_normal(face), found = sign * shading_normal(*prism, face, side, w);
                CHECK(glm::distance(sign * shading_normal(*angular, face, side, w), facet) < 1e-12);
                if (std::abs(facet.z) > 0.5) { // a lid
                    CHECK(glm::distance(found, facet) < 1e-12);
                    continue;
                }
                // The two walls that meet in the corner's line: round if they are of one group and that is not none.
                const dvec3 at = prism->vertex_m(face, corner);
                const auto wall = uint32_t(face / 4),
                           line = uint32_t(std::lround(std::atan2(at.y, at.x) / (2 * std::numbers::pi / 10) + 10)) % 10,
                           other = line == wall ? (wall + 9) % 10 : (wall + 1) % 10;
                const bool round = group_of_wall(wall) != 0 && group_of_wall(wall) == group_of_wall(other);
                CAPTURE(wall, line);
                CHECK(glm::distance(found, round ? dvec3(at.x, at.y, 0) : facet) < 1e-9);
                CHECK(on_crease(*prism, face, side, w)); // every corner is one of a lid
            }
}
