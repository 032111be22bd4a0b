// A ball as probe: closed forms on simple shapes, and that nothing comes nearer to its centre than its radius.
#include "runtime/contact/sphere_contact.h"
#include "tests/runtime/surface/distance.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

dvec3 elastic(std::span<const Contact> contacts)
{
    dvec3 sum(0);
    for (const Contact& contact : contacts) sum += contact.depth_m * contact.normal;
    return sum;
}

} // namespace

TEST_CASE("a ball that an object swings against looks at so many triangles in a tick and no more")
{
    // Through the air, where it has learned to look far around, into a fine mesh in one tick; and through that.
    const auto surface = surface_of(make_bumpy_sphere(6));
    std::mt19937_64 random(8);
    uint64_t most = 0, met = 0;
    for (int run = 0; run < tries(20); ++run) {
        for (const double r : {0.01, 0.05, 0.1, 0.2}) {
            SphereContact contact(surface, r);
            const dvec3 d = random_direction(random), e = random_direction(random);
            for (int i = 0; i < 60; ++i) {
                const double x = run % 2 ? (i < 40 ? 0 : 0.6) : 0.5 * (1 - std::cos(0.1 * i));
                const uint64_t before = contact.counters().triangles_tested;
                met += !contact.update(d * (1.2 + r - x) + 0.3 * x * e).empty();
                most = std::max(most, contact.counters().triangles_tested - before);
                if (i % 10 == 0) CHECK(distance_to(*surface, contact.proxy_m()) > r * (1 - 1e-8));
            }
        }
    }
    CHECK(met > tries(1000u));
    CHECK(most > 2048); // it is put off
    CHECK(most < 4096);
}

TEST_CASE("a ball is spared the search where its hand rests or nothing is nearer than it goes, and only there")
{
    SphereContact contact(surface_of(make_icosphere(4)), 0.05);
    const auto spared = [&](double z, const dvec3& step) { // to and fro
        int ticks = 0;
        for (int i = 0; i < 100; ++i) {
            const ContactCounters before = contact.counters();
            CHECK(contact.update(dvec3(0, 0, z) + static_cast<double>(i % 2) * step).empty());
            ticks += contact.counters().walk_steps == before.walk_steps;
        }
        return ticks;
    };
    CHECK(spared(2, {0, 0, 1e-3}) >= 98);
    CHECK(spared(0.552, {0, 0, 1e-5}) >= 97);
    CHECK(spared(0.552, {1e-2, 0, 0}) <= 1); // farther than it is off
    CHECK(spared(0.553, dvec3(0)) >= 99);
}

TEST_CASE("a ball rests on a plane, an edge and a corner at its radius")
{
    constexpr double r = 0.1;
    SphereContact contact(surface_of(make_box({1, 1, 1})), r);
    const struct {
        dvec3 hand, nearest; // nearest point of the box
    } cases[] = {{{0.1, 0.2, 0.55}, {0.1, 0.2, 0.5}},
                 {{0.53, 0.1, 0.54}, {0.5, 0.1, 0.5}},
                 {{0.53, 0.54, 0.52}, {0.5, 0.5, 0.5}}};
    for (const auto& [hand, nearest] : cases) {
        contact.reset();
        CHECK(contact.update(hand + 2.0 * r * glm::normalize(hand - nearest)).empty());
        std::span<const Contact> touched;
        for (int i = 0; i < 4; ++i) touched = contact.update(hand);
        REQUIRE(touched.size() == 1);
        const dvec3 normal = glm::normalize(hand - nearest);
        CHECK(glm::length(touched[0].proxy_m - nearest) < 1e-9);
        CHECK(glm::length(touched[0].normal - normal) < 1e-8);
        CHECK(std::abs(touched[0].depth_m - (r - glm::distance(hand, nearest))) < 1e-9);
        CHECK(glm::length(contact.proxy_m() - (nearest + r * normal)) < 1e-8);
        CHECK(touched[0].side == 0);
    }
}

TEST_CASE("a ball in a groove is held by both walls, each by its share")
{
    // Walls at 45 degrees that meet in x = 0, z = 0: the ball's centre rests at z = r sqrt(2).
    constexpr double r = 0.05;
    Mesh groove;
    groove.positions_m = {{0, -1, 0}, {0, 1, 0}, {1, 1, 1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}};
    groove.triangles = {{0, 3, 2}, {0, 2, 1}, {0, 1, 4}, {0, 4, 5}};
    SphereContact contact(surface_of(groove), r);
    contact.update({0.01, 0, 0.5});
    std::span<const Contact> touched;
    for (const double x : {0.004, -0.004, 0.0}) {
        const dvec3 hand(x, 0.1, 0.02), rest(0, 0.1, r * std::sqrt(2));
        for (int i = 0; i < 3; ++i) touched = contact.update(hand);
        REQUIRE(touched.size() == 2);
        CHECK(glm::length(contact.proxy_m() - rest) < 1e-9);
        CHECK(glm::length(elastic(touched) - (rest - hand)) < 1e-9);
        // rest - hand = a (1, 0, 1) / sqrt(2) + b (-1, 0, 1) / sqrt(2)
        const double a = ((rest - hand).z + (rest - hand).x) / std::sqrt(2),
                     b = ((rest - hand).z - (rest - hand).x) / std::sqrt(2);
        CHECK(std::abs(touched[0].depth_m - std::max(a, b)) < 1e-9);
        CHECK(std::abs(touched[1].depth_m - std::min(a, b)) < 1e-9);
    }
}

TEST_CASE("without friction a plane pushes a ball straight up at any speed, whatever its triangles")
{
    for (const uint32_t cells : {1u, 7u, 64u}) {
        SphereContact contact(surface_of(make_plane(cells)), 0.05);
        std::mt19937_64 random(cells);
        std::uniform_real_distribution<double> uniform(-0.4, 0.4);
        contact.update({0, 0, 0.1});
        int behind = 0;
        for (int i = 0; i < 500; ++i) {
            const dvec3 hand(uniform(random), uniform(random), 0.03);
            std::span<const Contact> touched;
            for (int wait = 0; wait < 12; ++wait) touched = contact.update(hand); // 20 radii: not in one tick
            REQUIRE(touched.size() >= 1);
            behind += glm::length(contact.proxy_m() - dvec3(hand.x, hand.y, 0.05)) > 1e-9;
            CHECK(glm::length(elastic(touched) - dvec3(0, 0, 0.02)) < 1e-9);
        }
        CHECK(behind == 0);
    }
}

TEST_CASE("a ball that cannot keep up with the hand is not pushed harder, and lets go of what the hand has left")
{
    constexpr double radius = 0.05, depth = 1e-3;
    SphereContact contact(surface_of(make_plane(256)), radius); // 12 of its triangles fit into the radius
    const auto press = [&](const dvec3& hand) { return glm::length(elastic(contact.update(hand))); };
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-0.45, 0.45);
    contact.update({0, 0, 0.1});
    for (int wait = 0; wait < 3; ++wait) press({0, 0, radius - depth});
    const uint64_t cut = contact.counters().walks_cut;
    for (int i = 0; i < 2000; ++i) { // up to 18 radii a tick
        REQUIRE(press({place(random), place(random), radius - depth}) < 1.01 * depth);
    }
    CHECK(contact.counters().walks_cut > cut + 1000);
    for (int wait = 0; wait < 20; ++wait) press({0.1, 0.2, radius - depth});
    CHECK(std::abs(press({0.1, 0.2, radius - depth}) - depth) < 1e-9);
    CHECK(press({-0.4, -0.4, 2}) == 0); // and away
}

TEST_CASE("a ball is pushed by no more than its way from the hand, whatever it could not finish")
{
    for (const NamedMesh& mesh : {NamedMesh{"star", make_star(4)}, NamedMesh{"crossing", make_crossing_boxes()}}) {
        const auto surface = surface_of(mesh.mesh);
        const double size = Lattice::extent * surface->lattice.unit_m;
        SphereContact contact(surface, 0.1 * size);
        std::mt19937_64 random(7);
        std::normal_distribution<double> normal;
        dvec3 hand(0, 0, 0.7 * size);
        const Friction friction{0.3, 0.2};
        for (int tick = 0; tick < 20'000; ++tick) {
            const double step = random() % 4 == 0 ? 0.2 : 0.01;
            hand = 0.98 * (hand + step * size * dvec3(normal(random), normal(random), normal(random)));
            dvec3 told(0);
            for (const Contact& one : contact.update(hand, friction)) told += one.depth_m * one.normal + one.lag_m;
            CAPTURE(mesh.name, tick);
            REQUIRE(glm::length(told) < (1 + 1e-6) * glm::distance(hand, contact.proxy_m()) + 1e-9 * size);
        }
        CHECK(contact.counters().walks_cut > 5);
    }
}

TEST_CASE("no ball comes nearer to a mesh than its radius, however wild the hand and bad the mesh")
{
    std::mt19937_64 random(31);
    std::uniform_real_distribution<double> uniform(0, 1);
    const Mesh meshes[] = {make_bumpy_sphere(3), make_star(2),           make_torus(0.4, 24, 12),
                           make_stairs(),        make_box({1, 1, 2e-6}), make_crossing_boxes()};
    for (const Mesh& mesh : meshes) {
        const auto surface = surface_of(mesh);
        const dvec3 centre = 0.5 * (surface->box_minimum_m + surface->box_maximum_m);
        const double size = 0.5 * glm::length(surface->box_maximum_m - surface->box_minimum_m);
        for (const double r : {0.05 * size, 1e-3 * size}) {
            SphereContact contact(surface, r);
            dvec3 hand = centre + dvec3(2, 0.1, 0.2) * size;
            contact.update(hand);
            int touched = 0, inside = 0;
            double nearest = INFINITY;
            for (int i = 0; i < 1500; ++i) {
                const double habit = uniform(random);
                if (habit < 0.1) {
                    hand = centre + 3.0 * size * (dvec3(uniform(random), uniform(random), uniform(random)) - 0.5);
                } else if (habit < 0.2) {
                    hand = surface->vertex_m(static_cast<uint32_t>(random() % surface->faces.size()), 0);
                } else {
                    hand += std::pow(10.0, -4 * uniform(random)) * 0.3 * size * random_direction(random);
                    hand = centre + 0.98 * (hand - centre);
                }
                touched += !contact.update(hand).empty();
                if (i % 4 != 0) continue;
                const dvec3 at = contact.proxy_m();
                nearest = std::min(nearest, distance_to(*surface, at));
                inside += std::abs(winding(*surface, at).number) > 0.5;
            }
            CAPTURE(mesh.triangles.size(), r);
            CHECK(nearest > r * (1 - 1e-8) - 1e-11 * size);
            CHECK(nearest < r * (1 + 1e-6)); // it did touch
            CHECK(inside == 0);
            CHECK(touched > 200);
        }
    }
}

TEST_CASE("a ball on a bumpy sphere is never wedged")
{
    // Held 0.02 deep: 10 N. Between bumps a ball of 0.02 stands off a little; the force stays near that all the same.
    const auto surface = surface_of(make_bumpy_sphere(4));
    constexpr double r = 0.02;
    for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}}) {
        SphereContact contact(surface, r);
        dvec3 at(0, 0, 1), heading(1, 0, 0);
        contact.update(1.3 * at);
        double worst = 0, mean = 0;
        int lost = 0;
        std::mt19937_64 random(2);
        constexpr int ticks = 4000;
        for (int i = 0; i < ticks; ++i) {
            heading = glm::normalize(heading + 0.1 * random_direction(random));
            heading = glm::normalize(heading - glm::dot(heading, at) * at);
            at = glm::normalize(at + 5e-4 * heading);
            const dvec3 hand = at * (bumpy_radius(at) + r - 0.02);
            lost += contact.update(hand, friction).empty();
            if (i < 20) continue;
            const double force = 500 * glm::distance(contact.proxy_m(), hand);
            worst = std::max(worst, force);
            mean += force / (ticks - 20);
        }
        const double ideal = 10 * std::hypot(1, friction.dynamic_coefficient);
        CAPTURE(friction.static_coefficient, worst, mean);
        CHECK(worst < 1.5 * ideal);
        CHECK(std::abs(mean - ideal) < 0.1 * ideal);
        CHECK(lost == 0);
    }
}

TEST_CASE("friction holds a ball up to the static coefficient and lets it slide with the dynamic one")
{
    constexpr double r = 0.05, depth = 0.01;
    SphereContact contact(surface_of(make_plane(5)), r);
    const Friction friction{0.4, 0.25};
    contact.update({0, 0, 0.2}, friction);
    contact.update({0, 0, r - depth}, friction);
    double largest = 0, last = 0;
    for (int i = 0; i <= 200; ++i) {
        const auto touched = contact.update({i * 1e-4, 0, r - depth}, friction);
        REQUIRE(touched.size() == 1);
        CHECK(std::abs(touched[0].depth_m - depth) < 1e-9);
        last = -touched[0].lag_m.x;
        if (i * 1e-4 < 0.4 * depth - 1e-9) CHECK(std::abs(last - i * 1e-4) < 1e-9); // it sticks: a spring
        largest = std::max(largest, last);
    }
    CHECK(largest <= 0.4 * depth + 1e-9);
    CHECK(largest > 0.4 * depth - 1.1e-4);
    CHECK(std::abs(last - 0.25 * depth) < 1e-9);
}

TEST_CASE("a ball put down into something does not jump out of it, and is whole once it has left")
{
    constexpr double r = 0.05;
    const auto surface = surface_of(make_plane(3));
    SphereContact contact(surface, r);
    CHECK(contact.update({0, 0, 0.01}).empty());
    CHECK(contact.update({0, 0, 0.01}).empty()); // no push
    const auto inside = contact.update({0.1, 0, 0.008});
    REQUIRE(inside.size() == 1);
    CHECK(std::abs(inside[0].radius_m - 0.01) < 1e-9); // as large as it has room
    CHECK(contact.update({0.1, 0, 0.3}).empty());
    CHECK(contact.radius() == SphereContact(surface, r).radius()); // to the last bit, or it grows in each tick
    const auto touched = contact.update({0.1, 0, 0.04});
    REQUIRE(touched.size() == 1);
    CHECK(std::abs(touched[0].depth_m - 0.01) < 1e-9);
    CHECK(std::abs(touched[0].radius_m - r) < 1e-12);
}

TEST_CASE("a ball put down between walls tells by each of them the same centre and how large it is")
{
    Mesh valley; // z = |x|
    valley.positions_m = {{-1, -1, 1}, {-1, 1, 1}, {0, -1, 0}, {0, 1, 0}, {1, -1, 1}, {1, 1, 1}};
    valley.triangles = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}};
    SphereContact contact(surface_of(valley), 0.05);
    contact.update({0, 0.1, 0.02});
    const auto touched = contact.update({0.001, 0.1, 0.018});
    REQUIRE(touched.size() == 2);
    for (const Contact& wall : touched) {
        CHECK(std::abs(wall.radius_m - 0.02 * std::sqrt(0.5)) < 1e-8);
        CHECK(glm::distance(wall.proxy_m + wall.radius_m * wall.normal, contact.proxy_m()) < 1e-8);
    }
}

TEST_CASE("a ball's pose that is not a number holds the contact, and equal poses give equal bits")
{
    const auto surface = surface_of(make_bumpy_sphere(3));
    SphereContact first(surface, 0.03), second(surface, 0.03);
    std::mt19937_64 random(9);
    dvec3 hand(0, 0, 1.2);
    for (int i = 0; i < 3000; ++i) {
        hand = 0.999 * hand + 0.01 * random_direction(random);
        const auto a = first.update(hand, {0.3, 0.2});
        const auto b = second.update(hand, {0.3, 0.2});
        REQUIRE(a.size() == b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
            REQUIRE(a[k].proxy_m == b[k].proxy_m);
            REQUIRE(a[k].depth_m == b[k].depth_m);
            REQUIRE(a[k].lag_m == b[k].lag_m);
        }
        const std::size_t count = a.size();
        const dvec3 at = first.proxy_m();
        const auto held = first.update({std::nan(""), 0, 0}, {0.3, 0.2});
        REQUIRE(held.size() == count);
        REQUIRE(first.proxy_m() == at);
        second.update({0, INFINITY, 0}, {0.3, 0.2});
    }
}

TEST_CASE("a probe lands where there is more around than a tick looks at twice")
{
    Mesh fan; // a disc of thin triangles: the boxes of hundreds hold any one place
    constexpr uint32_t sides = 8'000;
    fan.positions_m.emplace_back(0, 0, 0);
    for (uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        fan.positions_m.emplace_back(std::cos(angle), std::sin(angle), 0);
        fan.triangles.push_back({0, i + 1, (i + 1) % sides + 1});
    }
    const auto surface = surface_of(fan);
    for (const std::optional<double> r :
         {std::optional<double>(), std::optional(Lattice::point_radius * surface->lattice.unit_m), std::optional(0.05),
          std::optional(0.3)}) {
        CAPTURE(r.value_or(0));
        SphereContact contact(surface, r);
        const dvec3 over(0.3, 0.17, 0);
        contact.update(over + dvec3(0, 0, 1));
        for (int i = 0; i < 8; ++i) contact.update(over + dvec3(0, 0, -0.01));
        REQUIRE(contact.contacts().size() >= 1);
        CHECK(contact.contact().depth_m > 0.009);
    }
}
