// Where the proxy is, against closed forms: planes, edges, spheres, friction.
#include "runtime/contact/stylus_contact.h"
#include "runtime/contact/walk_contact.h"

#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// A walk of the hand over the unit sphere of directions, with momentum.
struct Stroll {
    std::mt19937_64 random{1};
    dvec3 at{0, 0, 1}, heading{glm::normalize(dvec3(1, 0.3, 0.1))};

    dvec3 next(double step)
    {
        std::normal_distribution<double> normal;
        heading = glm::normalize(heading + 0.01 * dvec3(normal(random), normal(random), normal(random)));
        heading = glm::normalize(heading - glm::dot(heading, at) * at);
        return at = glm::normalize(at + step * heading);
    }
};

struct Forces {
    double mean_n = 0, max_n = 0;
    int above = 0, lost = 0; // ticks above 1.5 times the ideal force, ticks without contact
};

// The probe is held 0.02 m deep under a smooth bumpy sphere, so the force should stay near 500 * 0.02 = 10 N.
Forces stroke_bumpy_sphere(const std::shared_ptr<const Surface>& surface, double step, const Friction& friction,
                           int ticks)
{
    WalkContact contact(surface);
    Stroll stroll;
    contact.update(1.2 * stroll.at);
    Forces forces;
    for (int i = 0; i < ticks; ++i) {
        const dvec3 d = stroll.next(step), hand = d * (bumpy_radius(d) - 0.02);
        const Contact& touch = contact.update(hand, friction);
        const double force = 500 * glm::length(touch.proxy_m - hand);
        forces.mean_n += force / ticks;
        forces.max_n = std::max(forces.max_n, force);
        forces.above += force > 15;
        forces.lost += !touch.touching;
    }
    return forces;
}

} // namespace

TEST_CASE("the proxy never wedges in the creases of a bumpy sphere")
{
    const auto surface = surface_of(make_bumpy_sphere(4)); // 5120 triangles
    for (double step : {2e-4, 1e-3})
        for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}}) {
            const Forces forces = stroke_bumpy_sphere(surface, step, friction, 7000);
            CAPTURE(step, friction.static_coefficient, forces.max_n);
            CHECK(forces.above == 0);
            CHECK(forces.lost == 0);
            const double ideal = 10 * std::hypot(1, friction.dynamic_coefficient);
            CHECK(std::abs(forces.mean_n - ideal) < 0.06 * ideal); // a facet's sagitta is up to 0.0005 of the 0.02
        }
}

TEST_CASE("the proxy never wedges in the creases of a bumpy sphere: long run", "[.long]")
{
    for (uint32_t subdivisions : {4u, 6u, 8u}) {
        const auto surface = surface_of(make_bumpy_sphere(subdivisions));
        for (double step : {2e-4, 1e-3})
            for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}}) {
                const Forces forces = stroke_bumpy_sphere(surface, step, friction, 200000);
                WARN(surface->faces.size()
                     << " triangles, step " << step << " m, static friction " << friction.static_coefficient
                     << ": mean " << forces.mean_n << " N, max " << forces.max_n << " N, above 15 N: " << forces.above);
                CHECK(forces.above == 0);
                CHECK(forces.lost == 0);
            }
    }
}

TEST_CASE("without friction a plane pushes straight up at any speed")
{
    for (uint32_t cells : {1u, 7u, 64u}) {
        WalkContact contact(surface_of(make_plane(cells)));
        std::mt19937_64 random(cells);
        std::uniform_real_distribution<double> uniform(-0.45, 0.45);
        contact.update({0, 0, 0.1});
        for (int i = 0; i < 2000; ++i) {
            const dvec3 hand(uniform(random), uniform(random), -0.01); // up to 1.2 m per tick
            const Contact& touch = contact.update(hand);
            const dvec3 force = 1000.0 * (touch.proxy_m - hand);
            REQUIRE(touch.touching);
            REQUIRE(std::abs(force.z - 10) < 1e-8);
            REQUIRE(std::hypot(force.x, force.y) < 1e-7);
            REQUIRE(std::abs(touch.depth_m - 0.01) < 1e-11);
            REQUIRE(glm::length(touch.lag_m) < 1e-10);
        }
    }
}

TEST_CASE("the first force is stiffness times approach, with no dead zone and no step")
{
    WalkContact contact(surface_of(make_plane(3)));
    double before_n = 0;
    bool touched = false;
    for (int i = -20; i <= 20; ++i) { // 1 um per tick
        const double height = -1e-6 * (i - 0.37);
        const Contact& touch = contact.update({0.123, 0.071, height});
        const double force_n = touch.touching ? 1000 * touch.depth_m : 0;
        CHECK(force_n - before_n < 1.001e-3);
        CHECK(std::abs(force_n - 1000 * std::max(0.0, -height)) < 1e-8);
        if (force_n > 0 && !touched) {
            touched = true;
            CHECK(force_n < 1e-3);
        }
        before_n = force_n;
    }
    CHECK(touched);
    // And off again: no stickiness.
    CHECK(contact.update({0.123, 0.071, 1e-9}).touching == false);
}

TEST_CASE("depth and normal at a box: face, edge and corner")
{
    WalkContact contact(surface_of(make_box()));
    const auto touch_from = [&](const dvec3& start, const dvec3& hand) {
        contact.reset();
        contact.update(start);
        return contact.update(hand);
    };
    const Contact face = touch_from({0.1, 0.2, 0.7}, {0.15, 0.22, 0.4});
    CHECK(face.touching);
    CHECK(glm::length(face.proxy_m - dvec3(0.15, 0.22, 0.5)) < 1e-10);
    CHECK(glm::length(face.normal - dvec3(0, 0, 1)) < 1e-14);
    CHECK(std::abs(face.depth_m - 0.1) < 1e-10);
    CHECK(face.side == 0);

    // The hand passes over the edge beside the box's top: from there the nearest point is on the other side.
    contact.update({0.45, 0.2, 0.3});
    CHECK(glm::length(contact.contact().proxy_m - dvec3(0.45, 0.2, 0.5)) < 1e-10); // keeps to the top: no pop through
    contact.update({0.55, 0.2, 0.3});
    CHECK_FALSE(contact.contact().touching); // past the edge it is free

    // In the groove of the stairs, hand below both walls: the proxy is in the crease and pushes between the walls.
    WalkContact groove(surface_of(make_stairs()));
    groove.update({4, 2.5, 2.2});
    const Contact& crease = groove.update({4, 0.5, 2.2});
    CHECK(glm::length(crease.proxy_m - dvec3(4, 1, 2.2)) < 1e-9);
    CHECK(glm::length(crease.normal - dvec3(0, 1, 0)) < 1e-9);
    CHECK(std::abs(crease.depth_m - 0.5) < 1e-9);

    // On the border edge of a plate, hand beside and below: free. On the rim, straight below the edge: held.
    WalkContact plate(surface_of(make_plane()));
    plate.update({0.49, 0, 0.01});
    CHECK(plate.update({0.49, 0, -0.01}).touching);
    CHECK_FALSE(plate.update({0.51, 0, -0.01}).touching);
    // Back from below: the plate is felt on its other side.
    CHECK_FALSE(plate.update({0.4, 0, -0.02}).touching);
    CHECK(plate.update({0.4, 0, 0.02}).side == 1);
    CHECK(plate.contact().facet_normal.z == -1);
}

TEST_CASE("a hand that starts inside feels the wall from within")
{
    WalkContact contact(surface_of(make_icosphere(4)));
    CHECK_FALSE(contact.update({0, 0, 0}).touching);
    const Contact& touch = contact.update({0, 0.1, 0.8});
    CHECK(touch.touching);
    CHECK(touch.side == 1);
    CHECK(glm::length(touch.proxy_m) < 0.5001);
    CHECK(glm::dot(touch.normal, touch.proxy_m) < 0);
}

TEST_CASE("Coulomb friction on a plane: sticks to the static cone, slides at the dynamic one")
{
    const Friction friction{0.5, 0.3};
    const double depth = 0.01, step = 1e-4;
    WalkContact contact(surface_of(make_plane(5)));
    contact.update({0.0173, 0.011, 0.1}, friction);
    contact.update({0.0173, 0.011, -depth}, friction);
    const dvec3 start = contact.contact().proxy_m;
    bool sliding = false;
    for (int i = 1; i <= 200; ++i) {
        const double travel = i * step;
        const dvec3 hand(0.0173 + travel, 0.011, -depth);
        const Contact& touch = contact.update(hand, friction);
        const double lateral_n_per_stiffness = hand.x - touch.proxy_m.x;
        CAPTURE(i);
        if (travel < 0.5 * depth - 1e-9) {
            CHECK(touch.proxy_m == start);
            CHECK_FALSE(touch.sliding);
        } else if (travel > 0.5 * depth + 1e-9) {
            CHECK(std::abs(lateral_n_per_stiffness - 0.3 * depth) < 1e-10);
            CHECK(touch.sliding);
            sliding = true;
        }
        CHECK(std::abs(touch.depth_m - depth) < 1e-10);
        CHECK(std::abs(glm::length(touch.lag_m) - lateral_n_per_stiffness) < 1e-10);
    }
    CHECK(sliding);
    // While the hand rests dynamic friction goes on holding. On its way back the proxy sticks, until the static cone is
    // left again, backwards this time.
    const dvec3 rest = contact.contact().proxy_m;
    const double hand_x = 0.0173 + 200 * step;
    CHECK(contact.update({hand_x, 0.011, -depth}, friction).sliding);
    CHECK(contact.update({rest.x - 0.49 * depth, 0.011, -depth}, friction).proxy_m == rest);
    CHECK_FALSE(contact.contact().sliding);
    CHECK(contact.update({rest.x - 0.51 * depth, 0.011, -depth}, friction).sliding);
    // Less pressure, same tangential pull: slips.
    const dvec3 again = contact.contact().proxy_m;
    contact.update({again.x + 0.2 * depth, 0.011, -depth}, friction);
    CHECK(contact.update({again.x + 0.2 * depth, 0.011, -0.1 * depth}, friction).sliding);
}

TEST_CASE("a hand pressed straight down on a slope slides if the slope is steeper than the friction cone")
{
    for (double degrees : {5.0, 15.0, 25.0, 35.0, 50.0}) {
        Mesh mesh = make_plane(4);
        const double slope = glm::radians(degrees);
        for (dvec3& p : mesh.positions_m) p = {p.x * std::cos(slope), p.y, p.x * std::sin(slope)};
        const Friction friction{0.6, 0.4};
        WalkContact contact(surface_of(mesh));
        contact.update({0, 0.03, 0.1}, friction);
        const Contact& touch = contact.update({0, 0.03, -0.02}, friction);
        // The proxy lands at the height 0 of the slope; the pull along the slope is 0.02 sin, the depth 0.02 cos.
        const double pull = 0.02 * std::sin(slope), depth = 0.02 * std::cos(slope);
        const double way = std::tan(slope) > 0.6 ? pull - 0.4 * depth : 0;
        const dvec3 expected = -way * dvec3(std::cos(slope), 0, std::sin(slope)) + dvec3(0, 0.03, 0);
        CAPTURE(degrees);
        CHECK(glm::length(touch.proxy_m - expected) < 1e-10);
        CHECK(touch.sliding == (way > 0));
    }
}

TEST_CASE("friction that is not a number, negative or reversed does no harm")
{
    const auto surface = surface_of(make_plane());
    const auto slid = [&](const Friction& friction) {
        WalkContact contact(surface);
        contact.update({0, 0.01, 0.1}, friction);
        contact.update({0, 0.01, -0.01}, friction);
        return contact.update({0.1, 0.01, -0.01}, friction).proxy_m.x;
    };
    CHECK(std::abs(slid({NAN, NAN}) - 0.1) < 1e-10);
    CHECK(std::abs(slid({-1, -2}) - 0.1) < 1e-10);
    CHECK(std::abs(slid({0.2, 0.9}) - (0.1 - 0.2 * 0.01)) < 1e-10);
    CHECK(std::abs(slid({INFINITY, 0}) - 0.1) < 1e-10);
}

TEST_CASE("a pose that is not a number holds the last good one, and contact goes on")
{
    WalkContact contact(surface_of(make_plane()));
    CHECK_FALSE(contact.update({NAN, 0, 0}).touching);
    contact.update({0, 0, 0.1});
    const dvec3 before = contact.update({0.01, 0.02, -0.01}).proxy_m;
    for (const dvec3& broken : {dvec3(NAN, 0, 0), dvec3(0, INFINITY, 0), dvec3(0, 0, -INFINITY)}) {
        const Contact& touch = contact.update(broken);
        CHECK(touch.touching);
        CHECK(touch.proxy_m == before);
        CHECK(std::abs(touch.depth_m - 0.01) < 1e-11);
    }
    CHECK(std::abs(contact.update({0.01, 0.02, -0.011}).depth_m - 0.011) < 1e-11);
    // A pose that is finite but absurd is clamped, and the plane still holds.
    const Contact& far = contact.update({1e300, -1e300, -1e300});
    CHECK(far.depth_m < 4);
    CHECK(std::isfinite(glm::length(far.proxy_m)));
}

TEST_CASE("equal poses give equal bits")
{
    const auto surface = surface_of(make_star(3));
    WalkContact one(surface), two(surface);
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    dvec3 hand(0, 0, 1.2);
    int touching = 0;
    for (int i = 0; i < 5000; ++i) {
        hand = 0.999 * hand + 0.02 * dvec3(normal(random), normal(random), normal(random));
        const Contact& a = one.update(hand, {0.3, 0.2});
        one.look_around(); // which changes no contact
        const Contact& b = two.update(hand, {0.3, 0.2});
        REQUIRE(a.touching == b.touching);
        REQUIRE(a.proxy_m == b.proxy_m);
        REQUIRE(a.normal == b.normal);
        REQUIRE(a.depth_m == b.depth_m);
        REQUIRE(a.face == b.face);
        touching += a.touching;
    }
    CHECK(touching > 500);
    CHECK(touching < 4500);
    CHECK(one.counters().sweeps < two.counters().sweeps - 100); // two does not look around
}

TEST_CASE("a known clearance spares queries and never hides the surface")
{
    const auto surface = surface_of(make_icosphere(5));
    WalkContact contact(surface);
    double last_free = 1;
    for (int i = 0; i <= 2000; ++i) { // 0.2 mm per tick toward the sphere of radius 0.5
        const double height = 0.9 - 2e-4 * i;
        if (!contact.update({0.01, 0.02, height}).touching) last_free = height;
        contact.look_around();
    }
    CHECK(contact.contact().touching == false);
    contact.update({0.01, 0.02, 0.49});
    CHECK(contact.contact().touching);
    CHECK(std::abs(last_free - 0.5) < 1e-3);
    CHECK(contact.counters().sweeps < 500); // of 2 000 ticks
}

TEST_CASE("a clearance is over once the point has left it, though its hand comes back at once")
{
    WalkContact contact(surface_of(make_plane(3))); // 1 m wide, in z = 0
    for (int i = 0; i < 4; ++i) {
        contact.update({0, 0, 0.4 + 1e-3 * i});
        contact.look_around();
    }
    CHECK_FALSE(contact.update({1.2, 0, -0.4}).touching); // past the border, below
    CHECK(contact.update({0.1, 0, 0.2}).touching);        // up through the plate
}

TEST_CASE("a stylus put down with its tip inside touches where it entered, and gives torque about its grip")
{
    StylusContact stylus(surface_of(make_plane(3)));
    const Contact& touch = stylus.update({0.1, 0.05, -0.02}, {0.1, 0.05, 0.13});
    CHECK(touch.touching);
    CHECK(glm::length(touch.proxy_m - dvec3(0.1, 0.05, 0)) < 1e-11);
    CHECK(std::abs(touch.depth_m - 0.02) < 1e-11);
    const dvec3 force = 500 * touch.depth_m * touch.normal; // 10 N up
    const dvec3 torque = torque_about({0.0, 0.05, 0.13}, touch.proxy_m, force);
    CHECK(glm::length(torque - dvec3(0, -1, 0)) < 1e-8); // r = (0.1, 0, -0.13), r x F = (0, -0.1 * 10, 0)
}

TEST_CASE("a stylus whose tail is inside, or whose shaft crosses the surface, is safe")
{
    const auto surface = surface_of(make_icosphere(4));
    StylusContact stylus(surface);
    // Tail inside, tip outside.
    CHECK_FALSE(stylus.update({0, 0, 0.7}, {0, 0, 0}).touching);
    // Both outside, the shaft right through.
    CHECK_FALSE(stylus.update({0, 0, 0.7}, {0, 0, -0.7}).touching);
    // Clear of it.
    CHECK_FALSE(stylus.update({0, 0, 0.7}, {0, 0, 0.9}).touching);
    // The tip presses: contact, whatever the tail does, NaN included.
    CHECK(stylus.update({0, 0, 0.45}, {0, 0, 0.6}).touching);
    CHECK(stylus.update({0, 0, 0.45}, {NAN, 0, 0.6}).touching);
    CHECK(stylus.update({0, 0, 0.45}, {0, 0, -0.6}).touching);
    // Both inside from the start.
    StylusContact inside(surface);
    CHECK_FALSE(inside.update({0, 0, 0.1}, {0, 0, -0.1}).touching);
}

TEST_CASE("a stylus far from the surface is spared the query, its shaft included")
{
    StylusContact stylus(surface_of(make_icosphere(4)));
    for (int i = 0; i < 1000; ++i) {
        stylus.update({0, 0, 2 + i * 1e-5}, {0, 0, 2.2 + i * 1e-5});
        stylus.look_around();
    }
    CHECK(stylus.counters().sweeps < 50); // of 1 000 ticks
}

TEST_CASE("what comes down anew is held by static friction, however it slid before it left")
{
    WalkContact contact(surface_of(make_plane()));
    const Friction friction{0.5, 0.1};
    const auto go = [&](double x_m, double z_m) -> const Contact& {
        return contact.update({x_m, 0.01, z_m}, friction);
    };
    go(0.4, 0.01);
    go(0.4, -0.01);
    CHECK(go(0.45, -0.01).sliding);
    REQUIRE_FALSE(go(0.6, -0.01).touching); // it slid over the border
    REQUIRE_FALSE(go(0.6, 0.01).touching);
    REQUIRE_FALSE(go(0.4, 1e-6).touching);
    const Contact& touch = go(0.404, -0.01);
    CHECK(touch.touching);
    CHECK_FALSE(touch.sliding);
    CHECK(std::abs(touch.lag_m.x + 0.004) < 1e-6);
}
