// A ball that was put down into something and goes out of it: as far as it must, not through anything.
#include "runtime/contact/sphere_contact.h"
#include "runtime/servo/allocation_count.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

Mesh both(Mesh a, const Mesh& b, const dvec3& b_at)
{
    const auto first = static_cast<uint32_t>(a.positions_m.size());
    for (const dvec3& position : b.positions_m) a.positions_m.push_back(position + b_at);
    for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({first + i, first + j, first + k});
    a.uv.clear();
    return a;
}

} // namespace

TEST_CASE("a ball moves out of a floor and of a groove by what it lacks of its radius, if that is not too much")
{
    constexpr double r = 0.05;
    SphereContact on_floor(surface_of(make_plane(5)), r);
    on_floor.update({0.1, 0, 0.03});
    CHECK_FALSE(on_floor.move_out(0.019));
    CHECK(glm::distance(on_floor.proxy_m(), {0.1, 0, 0.03}) < 1e-10);
    CHECK(on_floor.move_out(0.021));
    CHECK(glm::distance(on_floor.proxy_m(), {0.1, 0, r}) < 1e-9);
    CHECK_FALSE(on_floor.move_out(0.021)); // it is whole
    const auto touched = on_floor.update({0.1, 0, 0.03});
    REQUIRE(touched.size() == 1);
    CHECK(std::abs(touched[0].depth_m - 0.02) < 1e-9);

    // Walls that rise by 30 degrees and by 60, which meet in x = 0, z = 0, each as far from x = a, z = a.
    const double cosine = std::cos(glm::radians(30.0)), sine = std::sin(glm::radians(30.0));
    Mesh groove;
    groove.positions_m = {{0, -1, 0},         {0, 1, 0},          {cosine, 1, sine},
                          {cosine, -1, sine}, {-sine, 1, cosine}, {-sine, -1, cosine}};
    groove.triangles = {{0, 3, 2}, {0, 2, 1}, {0, 1, 4}, {0, 4, 5}};
    const dvec3 left(-sine, 0, cosine), right(cosine, 0, sine); // at right angles to each other, along the walls
    SphereContact in_groove(surface_of(groove), r);
    in_groove.update(0.03 * left + 0.04 * right);
    CHECK(in_groove.move_out(1));
    CHECK(glm::distance(in_groove.proxy_m(), r * left + r * right) < 1e-9);
    in_groove.reset();
    in_groove.update(0.03 * left + 0.2 * right); // near one of them only
    CHECK(in_groove.move_out(1));
    CHECK(glm::distance(in_groove.proxy_m(), r * left + 0.2 * right) < 1e-9);
}

TEST_CASE("a ball that was put down smaller is whole when it comes back from where it was left alone")
{
    constexpr double r = 0.05, depth_m = 0.001;
    SphereContact ball(surface_of(make_plane(5)), r);
    ball.update({0.1, 0, 0.03});
    ball.follow({0.1, 0, 10});
    ball.follow({0.1, 0, r + 0.01});
    const auto touched = ball.update({0.1, 0, r - depth_m});
    REQUIRE(touched.size() == 1);
    CHECK(std::abs(touched[0].depth_m - depth_m) < 1e-9);
}

TEST_CASE("a ball that does not fit into a slot goes to its middle, and stays in it")
{
    constexpr double r = 0.05, half = 0.04, thin = 1e-4;
    const Mesh wall = make_box({thin, 1, 1});
    const Mesh slot = both(both({}, wall, {half + 0.5 * thin, 0, 0}), wall, {-half - 0.5 * thin, 0, 0});
    for (const double x : {0.0, 0.01, -0.03, 0.0399}) {
        SphereContact contact(surface_of(slot), r);
        contact.update({x, 0.1, 0.2});
        contact.move_out(1);
        CAPTURE(x);
        CHECK(glm::distance(contact.proxy_m(), {0, 0.1, 0.2}) < 1e-4);
        for (int i = 0; i < 10; ++i) contact.update({0.3, 0.1, 0.2});
        CHECK(std::abs(contact.proxy_m().x) < 1e-4); // as large as the slot is wide
        CHECK(contact.contacts().size() == 1);
    }
}

TEST_CASE("a ball that moves out comes through nothing, and is no nearer to anything than it was or its radius")
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Mesh meshes[] = {make_bumpy_sphere(3), make_star(2), make_torus(0.4, 24, 12), make_stairs(),
                           make_box({1, 1, 2e-3})};
    for (const Mesh& mesh : meshes) {
        const auto surface = surface_of(mesh);
        const double size = 0.5 * glm::length(surface->box_maximum_m - surface->box_minimum_m);
        for (const double r : {0.05 * size, 5e-3 * size}) {
            SphereContact contact(surface, r);
            int went = 0, whole = 0, outside = 0;
            for (int i = 0; i < 300; ++i) {
                const auto face = static_cast<uint32_t>(random() % surface->faces.size());
                const dvec3 on =
                    (surface->vertex_m(face, 0) + surface->vertex_m(face, 1) + surface->vertex_m(face, 2)) / 3.0;
                const dvec3 at = on + 0.6 * r * dvec3(uniform(random), uniform(random), uniform(random));
                contact.reset();
                contact.update(at);
                const dvec3 from = contact.proxy_m();
                const Winding before = winding(*surface, from);
                const uint64_t allocated = allocations_of_this_thread();
                const bool out = contact.move_out(r);
                CHECK(allocations_of_this_thread() == allocated);
                const dvec3 to = contact.proxy_m();
                const Winding after = winding(*surface, to);
                CHECK(std::round(after.number) == std::round(before.number));
                CHECK(after.distance_m >= std::min(before.distance_m, r) * (1 - 1e-7));
                if (!out) CHECK(to == from);
                went += out;
                whole += after.distance_m > r * (1 - 1e-6);
                if (std::abs(before.number) < 0.5) ++outside;
                // What it was is a part of it now: from here the hand that goes back is held.
                if (out && after.distance_m > r * (1 - 1e-6)) {
                    contact.update(from);
                    CHECK(winding(*surface, contact.proxy_m()).distance_m > r * (1 - 1e-6));
                }
            }
            CAPTURE(mesh.triangles.size(), r, went, whole, outside);
            CHECK(went > 100);
            CHECK(whole > 100);
        }
    }
}
