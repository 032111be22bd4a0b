// Friction with a grain: the ellipse of what it holds, as the hand meets it along, across and aslant, by any probe.
#include "runtime/contact/grain.h"
#include "runtime/contact/probe_contact.h"
#include "runtime/contact/sphere_contact.h"
#include "runtime/contact/stylus_friction.h"
#include "tests/runtime/contact/each_probe.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

constexpr double mu_static = 0.5, mu_dynamic = 0.2, pressed_m = 1e-3;
const dvec3 up(0, 0, 1);

// Along a direction of the plane z = 0.
Friction grained(double angle, double scale)
{
    return {mu_static, mu_dynamic, grain_along({std::cos(angle), std::sin(angle), 0}, scale, up)};
}

dvec3 towards(double angle)
{
    return {std::cos(angle), std::sin(angle), 0};
}

// By maximum dissipation: of all forces f of the ellipse |S^-1 f| <= 1 the one for which f . v is greatest is
// S^2 v / |S v|.
dvec3 greatest_against(double grain_angle, double scale, const dvec3& v)
{
    const dvec3 e = towards(grain_angle), c(-e.y, e.x, 0);
    const double along = glm::dot(e, v), across = glm::dot(c, v);
    return (scale * scale * along * e + across * c) / std::hypot(scale * along, across);
}

// How much an ellipse of these half axes holds in a direction, along which it is pulled from its middle.
double holds(double grain_angle, double scale, const dvec3& direction)
{
    const dvec3 e = towards(grain_angle), c(-e.y, e.x, 0);
    return 1 / std::hypot(glm::dot(e, direction) / scale, glm::dot(c, direction));
}

std::shared_ptr<const Surface> plane_of(double side_m)
{
    Mesh mesh = make_plane();
    scale_to_size(mesh, side_m);
    return surface_of(mesh);
}

// A square of cells by cells squares of two triangles each, whose inner corners are moved within the plane.
std::shared_ptr<const Surface> grid_of(double side_m, uint32_t cells, double moved)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> aside(-moved, moved);
    Mesh mesh;
    for (uint32_t i = 0; i <= cells; ++i)
        for (uint32_t j = 0; j <= cells; ++j) {
            const bool inner = i > 0 && j > 0 && i < cells && j < cells;
            const double dx = inner ? aside(random) : 0, dy = inner ? aside(random) : 0;
            mesh.positions_m.push_back({((i + dx) / cells - 0.5) * side_m, ((j + dy) / cells - 0.5) * side_m, 0});
        }
    for (uint32_t i = 0; i < cells; ++i)
        for (uint32_t j = 0; j < cells; ++j) {
            const uint32_t a = i * (cells + 1) + j, b = a + cells + 1;
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
        }
    return surface_of(mesh);
}

struct Stroke {
    Stroke(const EachProbe& of, std::shared_ptr<const Surface> surface, const Friction& with, double rate_hz = 1000)
        : probe(of), contact(of.settings, std::move(surface), rate_hz), friction(with)
    {
        go({0, 0, 5e-3});
    }
    // The lag of the tip's end.
    dvec3 go(const dvec3& at)
    {
        const dvec3 tip = at + probe.above_m * up;
        dvec3 lag(0);
        slides = false;
        for (const Contact& contact_of : contact.update({tip, tip + probe.tail_off_m}, friction)) {
            if (contact_of.along > 0) continue;
            lag += contact_of.lag_m;
            slides = contact_of.sliding;
        }
        return lag;
    }
    const EachProbe& probe;
    ProbeContact contact;
    Friction friction;
    bool slides = false;
};

} // namespace

TEST_CASE("what friction with a grain holds is the nearest of an ellipse, and none where there is no direction")
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    for (int trial = 0; trial < 2000; ++trial) {
        const dvec3 normal = glm::normalize(any()), direction = any();
        const double scale = std::exp2(6 * u(random)), most = std::exp2(20 * u(random));
        const Grain grain = grain_along(std::exp2(300 * u(random)) * direction, scale, normal);
        const FrictionEllipse ellipse(grain, normal);
        const dvec3 e = glm::normalize(direction - glm::dot(direction, normal) * normal), c = glm::cross(normal, e);
        const auto size = [&](const dvec3& v) { return std::hypot(glm::dot(v, e) / scale, glm::dot(v, c)); };
        const double a = 10 * most * u(random), b = 10 * most * u(random);
        const dvec3 v = a * e + b * c;
        CAPTURE(trial, scale, most);
        REQUIRE(std::abs(ellipse.size(v) / size(v) - 1) < 1e-9);
        const dvec3 held = ellipse.nearest(v, most);
        REQUIRE(std::abs(glm::dot(held, normal)) < 1e-9 * most * std::max(1.0, scale));
        if (size(v) <= most) {
            REQUIRE(glm::distance(held, v) < 1e-9 * glm::length(v));
            continue;
        }
        REQUIRE(std::abs(size(held) / most - 1) < 1e-9);
        double nearest = HUGE_VAL; // of points of its edge
        for (int i = 0; i < 720; ++i)
            nearest = std::min(nearest, glm::distance(v, most * (scale * std::cos(i * std::numbers::pi / 360) * e +
                                                                 std::sin(i * std::numbers::pi / 360) * c)));
        REQUIRE(glm::distance(v, held) <= nearest * (1 + 1e-9));
    }
    // The other way round is the same; one means nothing, and crossed grains are none.
    CHECK(grain_along({1, 2, 0}, 3, up) == grain_along({-1, -2, 0}, 3, up));
    CHECK(glm::distance(grain_along({1, 2, 0}, 3, up).mixed, grain_along({1, 2, 7}, 3, up).mixed) < 1e-14);
    for (const dvec3& none : {dvec3(0), 5.0 * up, dvec3(std::nan(""), 1, 0), dvec3(HUGE_VAL, 0, 0)})
        CHECK(!grain_along(none, 3, up).is_there);
    CHECK(!grain_along({1, 2, 0}, 1, up).is_there);
    CHECK(!grain_along({1, 2, 0}, std::nan(""), up).is_there);
    const FrictionEllipse crossed(mixed(grain_along({1, 0, 0}, 3, up), grain_along({0, 1, 0}, 3, up), 0.5), up);
    for (int i = 0; i < 12; ++i) CHECK(std::abs(crossed.size(towards(i)) - 0.5) < 1e-12); // twice as much, any way
    const glm::dmat3 quarter(dvec3(0, 1, 0), dvec3(-1, 0, 0), up);
    const Grain turned_grain = turned(grain_along({2, 1, 0}, 3, up), quarter), there = grain_along({-1, 2, 0}, 3, up);
    CHECK(glm::distance(turned_grain.diagonal, there.diagonal) < 1e-14);
    CHECK(glm::distance(turned_grain.mixed, there.mixed) < 1e-14);
}

TEST_CASE("a probe that slides over a grain is held by the force of the ellipse that its motion meets most of")
{
    const std::shared_ptr<const Surface> surfaces[] = {plane_of(0.4), grid_of(0.4, 24, 0), grid_of(0.4, 24, 0.3)};
    for (const EachProbe& probe : every_probe)
        for (const auto& surface : surfaces)
            for (const double scale : {0.25, 0.5, 3.0})
                for (const double grain_angle : {0.0, 0.7})
                    for (const double off : {0.0, std::numbers::pi / 4, std::numbers::pi / 2, -0.4, 2.5}) {
                        const dvec3 along = towards(grain_angle + off);
                        Stroke stroke(probe, surface, grained(grain_angle, scale));
                        dvec3 lag = stroke.go({0, 0, -pressed_m});
                        // It comes to that force within some times the length by which friction holds.
                        for (double way = 0; way < 16e-3; way += 20e-6) lag = stroke.go(way * along - pressed_m * up);
                        const dvec3 expected = -mu_dynamic * pressed_m * greatest_against(grain_angle, scale, along);
                        CAPTURE(static_cast<int>(probe.settings.kind), scale, grain_angle, off, lag.x, lag.y, lag.z);
                        CHECK(glm::distance(lag, expected) < 1e-5 * pressed_m);
                    }
}

TEST_CASE("a probe that sticks on a grain sticks up to the edge of the ellipse in the direction that it is pulled")
{
    const auto surface = plane_of(0.4);
    for (const EachProbe& probe : every_probe)
        for (const double scale : {0.25, 3.0})
            for (const double off : {0.0, std::numbers::pi / 4, std::numbers::pi / 2, -0.4}) {
                const dvec3 along = towards(off);
                Stroke stroke(probe, surface, grained(0, scale));
                const dvec3 at(0.0113, 0.0071, -pressed_m);
                stroke.go(at + 2 * pressed_m * up);
                stroke.go(at);
                constexpr double step_m = 1e-6;
                double most_m = 0;
                for (double way = 0; way < 4 * mu_static * pressed_m && !stroke.slides; way += step_m) {
                    const double drawn_m = glm::length(stroke.go(at + way * along));
                    if (!stroke.slides) most_m = drawn_m;
                }
                const double expected_m = mu_static * pressed_m * holds(0, scale, along);
                CAPTURE(static_cast<int>(probe.settings.kind), scale, off, most_m, expected_m);
                CHECK(most_m <= expected_m + 1e-6 * pressed_m);
                CHECK(most_m > expected_m - 1.01 * step_m);
            }
}

// The mean over the stroke, as the encoder's counts make steps of every motion. Aslant these go along and across in
// turns, which lead the force by up to a count over the way that it needs to turn.
TEST_CASE("sliding over a grain is the same at any rate and through an encoder")
{
    const auto surface = plane_of(0.4);
    for (const EachProbe& probe : every_probe)
        for (const double scale : {0.25, 2.0})
            for (const double off : {0.0, std::numbers::pi / 4, std::numbers::pi / 2})
                for (const double rate_hz : {1000.0, 4000.0})
                    for (const double count_m : {0.0, 30e-6}) {
                        const dvec3 along = towards(off);
                        Stroke stroke(probe, surface, grained(0, scale), rate_hz);
                        stroke.go({0, 0, -pressed_m});
                        dvec3 drawn(0);
                        int count = 0;
                        for (double way = 0; way < 12e-3; way += 0.05 / rate_hz) {
                            const dvec3 hand = way * along - pressed_m * up;
                            const dvec3 lag = stroke.go(count_m > 0 ? glm::round(hand / count_m) * count_m : hand);
                            if (way < 6e-3) continue;
                            drawn += lag;
                            ++count;
                        }
                        const double held_m = count_m > 0 ? std::round(pressed_m / count_m) * count_m : pressed_m;
                        const dvec3 expected = -mu_dynamic * held_m * greatest_against(0, scale, along);
                        CAPTURE(static_cast<int>(probe.settings.kind), scale, off, rate_hz, count_m);
                        CHECK(glm::distance(drawn / static_cast<double>(count), expected) <
                              (count_m > 0 ? 0.02 : 1e-3) * glm::length(expected));
                    }
}

// While a hand moves the proxy stays, and the spring between them gives what it takes; then the proxy goes to where it
// is no farther from the hand. So from touch to touch no path gives energy, whatever the rule of slip is; that the rule
// takes as much as it can is shown above.
TEST_CASE("friction with a grain takes energy in every tick, over faces, edges and corners")
{
    Mesh box = make_box(), ball = make_icosphere(2), rough = make_icosphere(4);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    for (dvec3& p : rough.positions_m) p *= 1 + 0.03 * u(random);
    for (Mesh* mesh : {&box, &ball, &rough}) {
        scale_to_size(*mesh, 0.1);
        const auto surface = surface_of(*mesh);
        for (const bool by_ball : {false, true})
            for (const double scale : {1.0 / 1024, 0.1, 0.5, 1.0, 4.0, 1024.0}) {
                const std::unique_ptr<EndContact> contact =
                    by_ball ? std::make_unique<SphereContact>(surface, ball_m) : make_point(surface);
                const auto proxy_m = [&] { return surface->lattice.metres(contact->proxy().at); };
                dvec3 direction = glm::normalize(any()), hand = 0.1 * direction;
                double farther_m = 0, given = 0, height_m = 0.1;
                contact->tick(hand, {});
                int touched = 0;
                for (int i = 0; i < 20'000; ++i) { // over it and into it, and off it in the end
                    direction = glm::normalize(direction + 0.01 * any() + 0.005 * dvec3(0.3, -1, 0.5));
                    height_m += 0.05 * ((i < 19'000 ? 0.05 + 0.01 * std::sin(i / 300.0) : 0.1) - height_m);
                    const dvec3 before = hand, proxy = proxy_m();
                    hand = height_m * direction;
                    Friction friction{mu_static, mu_dynamic};
                    if (contact->contact().touching)
                        friction.grain = grain_along({1, 0.5, 0.2}, scale, contact->contact().normal);
                    contact->tick(hand, friction);
                    const double drawn = glm::distance(proxy, hand), held = glm::distance(proxy, before);
                    given += 0.5 * (held * held - drawn * drawn); // over the spring's stiffness
                    farther_m = std::max(farther_m, glm::distance(proxy_m(), hand) - drawn);
                    touched += contact->contact().touching;
                }
                CAPTURE(by_ball, scale, given, farther_m, touched, contact->counters().walks_cut,
                        contact->counters().walk_steps);
                CHECK(touched > 3000);
                CHECK(farther_m < 1e-10);
                CHECK(given + 0.5 * std::pow(glm::distance(proxy_m(), hand), 2) < -1e-6); // what it still holds
                CHECK(contact->counters().walks_cut <=
                      20); // of 20 000 ticks, as without a grain: a ball on rough facets
            }
    }
}

// The law of an end on a shaft that gives in any way: maximum dissipation is the normal of the ellipse's edge.
TEST_CASE("friction with a grain on an end of a stylus holds what is at right angles to its slip")
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    int stuck = 0, slipped = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        EndFriction end;
        end.normal = glm::normalize(any());
        const dvec3 direction = any();
        const double scale = std::exp2(3 * u(random)), depth = 1e9, most = 0.4 * depth;
        end.friction = {0.5, 0.4, grain_along(direction, scale, end.normal)};
        end.touches = end.slides = true;
        end.take_hold(false);
        glm::dmat3 give(0);
        const dvec3 one = glm::normalize(any()), two = glm::normalize(glm::cross(one, any()));
        give += glm::outerProduct(one, one);
        if (trial % 3 > 0) give += glm::outerProduct(two, two);
        if (trial % 3 > 1) give = glm::dmat3(1);
        if (trial % 2) give += 1e-6 * glm::dmat3(1);
        const dvec3 way = give * (1e9 * any()), aim = end.at - depth * end.normal;
        double change = 1;
        for (int turn = 0; turn < 20 && change > 1e-9; ++turn)
            change = end.follow(aim, end.at + way + give * end.lag, give);
        const dvec3 e = glm::normalize(direction - glm::dot(direction, end.normal) * end.normal),
                    c = glm::cross(end.normal, e), moved = way + give * end.lag;
        const double along = glm::dot(end.lag, e), across = glm::dot(end.lag, c);
        const dvec3 outward = along / (scale * scale) * e + across * c,
                    slip = glm::dot(moved, e) * e + glm::dot(moved, c) * c;
        CAPTURE(trial, scale, change);
        REQUIRE(change < 1e-6);
        REQUIRE(std::fabs(glm::dot(end.lag, end.normal)) < 1e-6 * most);
        REQUIRE(std::hypot(along / scale, across) < most * (1 + 1e-9));
        if (end.moves) {
            REQUIRE(std::hypot(along / scale, across) > most * (1 - 1e-9));
            REQUIRE(glm::distance(slip, -glm::length(slip) / glm::length(outward) * outward) < 1e-5 * depth);
        } else {
            REQUIRE(glm::length(slip) < 1e-5 * depth);
        }
        ++(end.moves ? slipped : stuck);
    }
    CHECK(stuck > 300);
    CHECK(slipped > 300);
}
