// What a ball sees: nearest points of triangles, and the faces near it.
#include "runtime/contact/near_faces.h"
#include "runtime/geometry/nearest_point.h"
#include "tests/runtime/surface/distance.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

TEST_CASE("the nearest point of a triangle is in it, and no nearer one is")
{
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 20000; ++trial) {
        dvec3 corner[4];
        for (dvec3& c : corner) c = {normal(random), normal(random), normal(random)};
        if (trial % 3 == 0) corner[2] = 0.5 * (corner[0] + corner[1]) + 1e-9 * corner[2]; // a sliver
        const NearestPoint found = nearest_point(corner[0], corner[1], corner[2], corner[3]);
        for (int i = 0; i < 3; ++i) CHECK(found.barycentric[i] >= 0);
        CHECK(std::abs(found.barycentric.x + found.barycentric.y + found.barycentric.z - 1) < 1e-14);
        CHECK(std::abs(glm::distance(found.at, corner[3]) - distance_to(corner[0], corner[1], corner[2], corner[3])) <
              (trial % 3 == 0 ? 1e-8 : 1e-12));
    }
}

TEST_CASE("near faces are all found, and each lies behind its plane wherever that was laid from")
{
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const Mesh& mesh : {make_bumpy_sphere(3), make_star(2), make_stairs(), make_box({1, 1, 2e-6})}) {
        const auto surface = surface_of(mesh);
        const auto corner = [&](uint32_t face, int i) { return surface->vertices[surface->faces[face].vertex[i]]; };
        const auto distance = [&](uint32_t face, const dvec3& p) {
            return distance_to(corner(face, 0), corner(face, 1), corner(face, 2), p);
        };
        // Lattice units. A plane is turned by what rounding moves the point touched by (1e-2), over the distance.
        constexpr double slack = 4;
        constexpr double rises = 1024; // by so much one may rise above the plane of another that it is left out for
        NearFaces near(*surface);
        for (int trial = 0; trial < haptel::test::tries(200); ++trial) {
            // Somewhere over a face, and from there a few steps within the margin.
            const auto over = static_cast<uint32_t>(random() % surface->faces.size());
            const double radius = Lattice::extent * std::pow(10.0, -3 * uniform(random));
            const double margin = 0.3 * uniform(random) * radius;
            dvec3 centre = corner(over, 0) + 1.1 * radius * random_direction(random);
            const dvec3 start = centre;
            REQUIRE(near.find(centre, radius + margin));
            for (int step = 0; step < 4; ++step) {
                const double room = margin - glm::distance(start, centre), reach = uniform(random) * room;
                near.pick(centre, radius, reach, NearFaces::Screened::yes, NearFaces::Laid::here);
                std::vector<uint32_t> picked;
                for (uint32_t i = 0; i < near.rows().size(); ++i) {
                    picked.push_back(near.face(i));
                    const HalfSpace& space = near.rows()[i];
                    const double turned = 1e-2 * 2 * Lattice::extent / distance(near.face(i), centre);
                    for (int c = 0; c < 3; ++c)
                        REQUIRE(glm::dot(space.normal, corner(near.face(i), c)) <=
                                space.offset - radius + slack + turned);
                    // Laid from here: it is as far as the triangle.
                    REQUIRE(std::abs(glm::dot(space.normal, centre) - space.offset + radius -
                                     distance(near.face(i), centre)) < slack + rises);
                }
                double least = INFINITY;
                for (uint32_t face = 0; face < surface->faces.size(); ++face) {
                    const double away = distance(face, centre);
                    least = std::min(least, away);
                    const bool is_picked = std::find(picked.begin(), picked.end(), face) != picked.end();
                    const double turned = 1e-2 * 2 * Lattice::extent / radius;
                    const auto is_behind = [&](const HalfSpace& space) {
                        double highest = -INFINITY;
                        for (int c = 0; c < 3; ++c)
                            highest = std::max(highest, glm::dot(space.normal, corner(face, c)));
                        return highest <= space.offset - radius + slack + rises + turned;
                    };
                    if (away < radius + reach)
                        REQUIRE((is_picked || std::any_of(near.rows().begin(), near.rows().end(), is_behind)));
                    if (away > radius + reach + slack) REQUIRE(!is_picked);
                }
                REQUIRE(std::abs(near.distance(centre, radius) - std::min(least, radius)) < slack);
                centre += uniform(random) * room * random_direction(random);
            }
        }
    }
}

TEST_CASE("what is known in groups keeps a ball off every triangle, and holds it by triangles alone")
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::size_t entries = 0, around = 0;
    for (const Mesh& mesh : {make_bumpy_sphere(5), make_star(4), make_stairs()}) {
        const auto surface = surface_of(mesh);
        const auto corner = [&](uint32_t face, int i) { return surface->vertices[surface->faces[face].vertex[i]]; };
        const auto distance = [&](uint32_t face, const dvec3& p) {
            return distance_to(corner(face, 0), corner(face, 1), corner(face, 2), p);
        };
        constexpr double slack = 4; // lattice units, as above
        NearFaces near(*surface), listed(*surface);
        for (int trial = 0; trial < haptel::test::tries(60); ++trial) {
            const auto over = static_cast<uint32_t>(random() % surface->faces.size());
            dvec3 centre = corner(over, 0) + uniform(random) * Lattice::extent * random_direction(random);
            double radius = INFINITY;
            for (uint32_t face = 0; face < surface->faces.size(); ++face)
                radius = std::min(radius, distance(face, centre));
            if (radius < 1e-4 * Lattice::extent) continue;
            radius *= trial % 2 == 0 ? 1 - 1e-9 : uniform(random); // it touches, or does not
            const double margin = 0.3 * radius;
            REQUIRE(near.find_groups(centre, radius, radius + margin));
            (void)near.boxes(); // from here on it may look into so many more
            near.pick(centre, radius, margin, NearFaces::Screened::no, NearFaces::Laid::here);
            entries += near.count();
            const double turned = 1e-2 * 2 * Lattice::extent / radius;
            for (uint32_t face = 0; face < surface->faces.size(); ++face) {
                if (distance(face, centre) > radius + margin) continue;
                ++around;
                REQUIRE(std::any_of(near.rows().begin(), near.rows().end(), [&](const HalfSpace& row) {
                    double highest = -INFINITY;
                    for (int c = 0; c < 3; ++c) highest = std::max(highest, glm::dot(row.normal, corner(face, c)));
                    return highest <= row.offset - radius + slack + turned;
                }));
            }
            // It goes as near to the hand as planes of all triangles let it, or nearer.
            const dvec3 hand = centre + margin * uniform(random) * random_direction(random);
            const Projection<dvec3> held = project(near, hand, centre, distance_rounding);
            for (std::size_t i = 0; i < held.count; ++i) REQUIRE(!near.is_solid(held.active[i]));
            for (uint32_t face = 0; face < surface->faces.size(); ++face)
                REQUIRE(distance(face, held.at) > radius - slack);
            REQUIRE(listed.find(centre, radius + margin));
            listed.pick(centre, radius, margin, NearFaces::Screened::no, NearFaces::Laid::here);
            const dvec3 there = project(listed.rows(), hand, centre, distance_rounding).at;
            REQUIRE(glm::distance(held.at, hand) <= glm::distance(there, hand) + slack);
        }
    }
    CAPTURE(entries, around);
    CHECK(2 * entries < around); // they are groups
}
