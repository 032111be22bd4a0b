// The stylus against closed forms of its geometry.
#include "runtime/contact/stylus_contact.h"

#include "tests/runtime/contact/ends.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec2;
using glm::dvec3;

namespace {

Ends between(const Ends& a, const Ends& b, double share)
{
    return {a.tip + share * (b.tip - a.tip), a.tail + share * (b.tail - a.tail)};
}

Ends moved(const Ends& pose, const dvec3& by)
{
    return {pose.tip + by, pose.tail + by};
}

void drive(StylusContact& stylus, const Ends& from, const Ends& to, int ticks)
{
    for (int i = 0; i <= ticks; ++i) {
        const Ends pose = between(from, to, double(i) / ticks);
        stylus.update(pose.tip, pose.tail);
    }
}

// Of springs of 1 N/m: in metres, and square metres about the tail.
struct Wrench {
    dvec3 force{0}, torque{0};
};

Wrench wrench(const StylusContact& stylus, const Ends& hand)
{
    Wrench sum;
    for (const Contact& contact : stylus.contacts()) {
        const dvec3 force = contact.depth_m * contact.normal + contact.lag_m;
        sum.force += force;
        sum.torque += torque_about(hand.tail, hand.tip + contact.along * (hand.tail - hand.tip), force);
    }
    return sum;
}

Wrench pulled(const Ends& hand, const Ends& ideal)
{
    return {ideal.tip - hand.tip + ideal.tail - hand.tail, glm::cross(hand.tip - hand.tail, ideal.tip - hand.tip)};
}

// Seen along an edge, the shaft is a line that has to pass by a point: of all lines through it the one with the
// smallest sum of squared distances to the ends, which is along the principal axis of their moments.
Ends on_edge(const Ends& hand, const dvec3& point, const dvec3& edge)
{
    const dvec3 e = glm::normalize(edge),
                u = glm::normalize(glm::cross(e, std::fabs(e.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0))),
                v = glm::cross(e, u);
    double uu = 0, uv = 0, vv = 0;
    for (const dvec3& end : {hand.tip, hand.tail}) {
        const double a = glm::dot(end - point, u), b = glm::dot(end - point, v);
        uu += a * a, uv += a * b, vv += b * b;
    }
    const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
    const dvec3 normal = -std::sin(angle) * u + std::cos(angle) * v;
    const auto onto = [&](const dvec3& end) { return end - glm::dot(end - point, normal) * normal; };
    return {onto(hand.tip), onto(hand.tail)};
}

// A plate that hangs from a line.
Mesh upright(const Ends& upper_edge, double height = 0.3)
{
    Mesh mesh;
    const dvec3 down(0, 0, -height);
    mesh.positions_m = {upper_edge.tip, upper_edge.tail, upper_edge.tail + down, upper_edge.tip + down};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

Mesh joined(Mesh a, const Mesh& b)
{
    const auto first = static_cast<uint32_t>(a.positions_m.size());
    a.uv.clear();
    a.positions_m.insert(a.positions_m.end(), b.positions_m.begin(), b.positions_m.end());
    for (auto triangle : b.triangles) {
        for (uint32_t& corner : triangle) corner += first;
        a.triangles.push_back(triangle);
    }
    return a;
}

bool near(const Wrench& a, const Wrench& b, double tolerance)
{
    return glm::length(a.force - b.force) < tolerance && glm::length(a.torque - b.torque) < tolerance;
}

} // namespace

TEST_CASE("a shaft on the edge of a box is a lever: force and torque at every share, slope and slant")
{
    const auto surface = surface_of(make_box());
    const dvec3 corner(0.5, 0.03, 0.5), edge(0, 1, 0);
    for (const double share : {0.05, 0.25, 0.5, 0.7, 0.95})
        for (const double slope : {0.3, 0.8, 1.2})
            for (const double slant : {0.0, -0.5, 0.9})
                for (const double depth : {1e-4, 0.01}) {
                    const dvec3 normal(std::sin(slope), 0, std::cos(slope));
                    const dvec3 along =
                        std::cos(slant) * dvec3(std::cos(slope), 0, -std::sin(slope)) + std::sin(slant) * edge;
                    const dvec3 at = corner - depth * normal;
                    const Ends hand{at - share * 0.6 * along, at + (1 - share) * 0.6 * along};
                    StylusContact stylus(surface);
                    drive(stylus, moved(hand, 0.2 * normal), hand, 40);
                    CAPTURE(share, slope, slant, depth);
                    REQUIRE(stylus.contacts().size() == 1);
                    const Contact& contact = stylus.contacts()[0];
                    CHECK(contact.by_shaft);
                    CHECK(std::abs(contact.proxy_m.x - 0.5) + std::abs(contact.proxy_m.z - 0.5) < 1e-9);
                    const Wrench expected = pulled(hand, on_edge(hand, corner, edge));
                    CHECK(near(wrench(stylus, hand), expected, 1e-9));
                    // To first order in the depth it is the depth over (1 - s)^2 + s^2.
                    const double lever = (1 - share) * (1 - share) + share * share;
                    CHECK(std::abs(contact.depth_m * lever / depth - 1) < 5 * depth);
                }
}

TEST_CASE("a shaft across two edges rests on both: it is the line through them")
{
    const auto surface =
        surface_of(joined(upright({{-0.1, -0.3, 0}, {-0.1, 0.3, 0}}), upright({{0.1, -0.3, 0.02}, {0.1, 0.3, 0.02}})));
    for (const dvec2 depth : {dvec2(0.01, 0.02), dvec2(0.004, 0.003), dvec2(1e-4, 1e-4)}) {
        const double rise = 0.1; // of the line through both
        const Ends hand{{-0.3, 0.02, 0.01 - 0.3 * rise - depth.x}, {0.25, -0.04, 0.01 + 0.25 * rise - depth.y}};
        StylusContact stylus(surface);
        drive(stylus, moved(hand, {0, 0, 0.1}), hand, 50);
        REQUIRE(stylus.contacts().size() == 2);
        const dvec3 normal = glm::normalize(dvec3(-rise, 0, 1));
        const Ends ideal{hand.tip + depth.x * normal.z * normal, hand.tail + depth.y * normal.z * normal};
        CHECK(near(wrench(stylus, hand), pulled(hand, ideal), 1e-9));
        CHECK(glm::distance(stylus.contacts()[0].proxy_m, stylus.contacts()[1].proxy_m) > 0.2);
    }
}

TEST_CASE("a tip on a plane with its shaft on an edge is held by both: the best line by search")
{
    const dvec2 edge(0.1, 0.05); // x and z
    const auto surface =
        surface_of(joined(make_plane(4), upright({{edge.x, -0.3, edge.y}, {edge.x, 0.3, edge.y}}, 0.04)));
    const Ends hand{{-0.1, 0.01, -0.005}, {0.35, 0.02, -0.005 + 0.45 * 0.255}};
    StylusContact stylus(surface);
    drive(stylus, moved(hand, {0, 0, 0.2}), hand, 100);
    REQUIRE(stylus.contacts().size() == 2);
    CHECK(!stylus.contacts().empty());
    CHECK(stylus.contacts()[1].by_shaft);
    // Of the lines through the edge's point the one that moves the ends least, its tip not below the plane.
    const auto held_at = [&](double angle) {
        const dvec2 along(std::cos(angle), std::sin(angle));
        const auto onto = [&](const dvec3& end) {
            const dvec2 at = edge + glm::dot(dvec2(end.x, end.z) - edge, along) * along;
            return dvec3(at.x, end.y, at.y);
        };
        Ends held{onto(hand.tip), onto(hand.tail)};
        if (held.tip.z < 0) held.tip = {edge.x - edge.y / std::tan(angle), hand.tip.y, 0};
        return held;
    };
    const auto cost = [&](double angle) {
        const Ends held = held_at(angle);
        const dvec3 a = held.tip - hand.tip, b = held.tail - hand.tail;
        return glm::dot(a, a) + glm::dot(b, b);
    };
    double low = 0.1, high = 0.6;
    for (int i = 0; i < 200; ++i) {
        const double a = low + 0.382 * (high - low), b = high - 0.382 * (high - low);
        (cost(a) < cost(b) ? high : low) = cost(a) < cost(b) ? b : a;
    }
    CHECK(near(wrench(stylus, hand), pulled(hand, held_at(low)), 1e-8)); // a search finds a minimum's place to its root
}

TEST_CASE("a shaft slides from edge to edge without a step, and rests in the vertex of two")
{
    // Straight on: the border of a plate in 16 edges. Nothing changes from one to the next.
    Mesh plate = make_plane(16);
    for (dvec3& p : plate.positions_m) p = {0, p.x, p.y - 0.5}; // its upper border is the y axis
    StylusContact straight(surface_of(plate));
    const Ends pressed{{-0.2, -0.4, -0.01}, {0.3, -0.38, -0.012}};
    drive(straight, moved(pressed, {0, 0, 0.1}), pressed, 50);
    const Wrench first = wrench(straight, pressed);
    CHECK(first.force.z > 0.01);
    for (int i = 0; i <= 4000; ++i) {
        const Ends hand = moved(pressed, {0, 2e-4 * i, 0});
        straight.update(hand.tip, hand.tail);
        REQUIRE(near(wrench(straight, hand), first, 1e-9));
    }
    // Down into a valley and out of it: no force changes faster than the hand moves, since what is free is convex.
    StylusContact valley(
        surface_of(joined(upright({{0, -0.3, 0.06}, {0, 0, 0}}), upright({{0, 0, 0}, {0, 0.3, 0.06}}))));
    const Ends start{{-0.2, -0.2, 0.02}, {0.2, -0.2, 0.02}};
    drive(valley, moved(start, {0, 0, 0.1}), start, 50);
    const double step = 1e-4;
    Wrench last = wrench(valley, start);
    for (int i = 1; i <= 4000; ++i) {
        const Ends hand = moved(start, {0, step * i, 0});
        valley.update(hand.tip, hand.tail);
        const Wrench now = wrench(valley, hand);
        REQUIRE(glm::distance(now.force, last.force) <= 2 * step + 1e-9);
        last = now;
    }
    const Ends over_vertex{{-0.2, 0, -0.01}, {0.2, 0, -0.01}};
    drive(valley, moved(over_vertex, {0, 0, 0.1}), over_vertex, 50);
    drive(valley, over_vertex, moved(over_vertex, {0, 0.001, 0}), 10);
    const dvec3 held = wrench(valley, moved(over_vertex, {0, 0.001, 0})).force;
    CHECK(glm::distance(held, dvec3(0, -0.002, 0.02)) < 1e-9); // both ends by (0, -0.001, 0.01): back to the vertex
    CHECK(valley.contacts().size() == 2);
}

TEST_CASE("without friction closed paths of the stylus gain nothing: the work falls with the square of the step")
{
    struct Setting {
        const char* name;
        std::shared_ptr<const Surface> surface;
        Ends centre;
    };
    const Setting settings[] = {
        {"on an edge", surface_of(make_box()), {{0.35, 0.03, 0.535}, {0.85, 0.1, 0.36}}},
        {"on two edges",
         surface_of(joined(upright({{-0.1, -0.3, 0}, {-0.1, 0.3, 0}}), upright({{0.1, -0.3, 0.02}, {0.1, 0.3, 0.02}}))),
         {{-0.3, 0.02, -0.03}, {0.25, -0.04, 0.02}}},
        {"tip and shaft",
         surface_of(joined(make_plane(4), upright({{0.1, -0.3, 0.05}, {0.1, 0.3, 0.05}}, 0.04))),
         {{-0.1, 0.01, -0.008}, {0.35, 0.02, 0.104}}}};
    for (const Setting& setting : settings) {
        const auto loop = [&](int steps) {
            const auto at = [&](int i) {
                const double t = 2 * 3.14159265358979323846 * i / steps;
                Ends pose = setting.centre; // both ends on closed curves of their own, 3 mm wide
                pose.tip += 3e-3 * dvec3(std::sin(t), std::cos(2 * t), std::sin(t + 1));
                pose.tail += 3e-3 * dvec3(std::cos(t), std::sin(t), std::cos(t - 0.5));
                return pose;
            };
            StylusContact stylus(setting.surface);
            drive(stylus, moved(at(0), {0, 0, 0.2}), at(0), 100);
            // The force on each end, of which force and torque are the sums.
            const auto ends = [&] {
                Ends sum;
                for (const Contact& contact : stylus.contacts()) {
                    const dvec3 force = contact.depth_m * contact.normal + contact.lag_m;
                    sum.tip += (1 - contact.along) * force;
                    sum.tail += contact.along * force;
                }
                return sum;
            };
            double work = 0;
            int touching = 0;
            for (int i = 0; i < steps; ++i) {
                const Ends from = at(i), to = at(i + 1), before = ends();
                stylus.update(to.tip, to.tail);
                const Ends after = ends();
                work += 0.5 * glm::dot(before.tip + after.tip, to.tip - from.tip) +
                        0.5 * glm::dot(before.tail + after.tail, to.tail - from.tail);
                touching += !stylus.contacts().empty();
            }
            CHECK(touching == steps);
            return std::fabs(work);
        };
        const double coarse = loop(50), finer = loop(200), finest = loop(800);
        CAPTURE(setting.name, coarse * 1e12, finer * 1e12, finest * 1e12);
        CHECK(coarse < 1e-6);              // of some 1e-4 that go in and out
        CHECK(finer < coarse / 8 + 1e-13); // 16
        CHECK(finest < finer / 8 + 1e-13);
    }
}

TEST_CASE("a stylus is held through poses that are no numbers, and far away it is free")
{
    const auto surface = surface_of(make_box());
    const Ends hand{{0.35, 0.03, 0.535}, {0.85, 0.1, 0.36}};
    StylusContact stylus(surface), twin(surface);
    drive(stylus, moved(hand, {0, 0, 0.1}), hand, 20);
    const Wrench held = wrench(stylus, hand);
    CHECK(glm::length(held.force) > 1e-3);
    stylus.update({NAN, 0, 0}, hand.tail);
    CHECK(near(wrench(stylus, hand), held, 0x1p-80));
    stylus.update(hand.tip, hand.tail);
    CHECK(near(wrench(stylus, hand), held, 1e-9));
    for (const double far_m : {10.0, 1e4, 1e12, 1e300}) {
        stylus.update(moved(hand, {far_m, 0, 0}).tip, moved(hand, {far_m, 0, 0}).tail);
        CHECK(stylus.contacts().empty());
    }
    // It comes back from beyond the workspace as if put down: from above it is held again.
    drive(stylus, moved(hand, {0, 0, 1}), hand, 50);
    CHECK(near(wrench(stylus, hand), held, 1e-9));
    // A tail that is no number is none: the tip is a point.
    stylus.update(hand.tip, {0, INFINITY, 0});
    CHECK(stylus.contacts().empty());

    // A stylus of which the tail is far beyond the workspace of a small object is as long as it is.
    Mesh small = make_box();
    scale_to_size(small, 1e-3);
    StylusContact large(surface_of(small));
    const dvec3 normal = glm::normalize(dvec3(1, 0, 1)), along(normal.z, 0, -normal.x), corner(5e-4, 0, 5e-4);
    const Ends long_hand{corner - 1e-5 * normal - 0.001 * along, corner - 1e-5 * normal + 0.149 * along};
    drive(large, moved(long_hand, 1e-3 * normal), long_hand, 20);
    CHECK(near(wrench(large, long_hand), pulled(long_hand, on_edge(long_hand, corner, {0, 1, 0})), 1e-12));
}

TEST_CASE("a stylus with an end so far out that it has no direction has no shaft, and nothing of it stays")
{
    const auto surface = surface_of(make_box());
    const Ends hand{{0.35, 0.03, 0.535}, {0.85, 0.1, 0.36}}, above = moved(hand, {0, 0, 0.1});
    for (const double far_m : {1e160, 1e300, 1e308})
        for (const Ends& far :
             {Ends{{far_m, -0.88, -0.41}, {-0.34, 0.44, -1.4}}, Ends{{0.5, -0.8, 0}, {far_m, far_m, 1}}}) {
            StylusContact stylus(surface), clean(surface);
            stylus.update(far.tip, far.tail);
            CHECK(!stylus.ideal());
            for (StylusContact* each : {&stylus, &clean}) {
                each->update(above.tip, above.tail);
                drive(*each, above, hand, 20);
            }
            CHECK(near(wrench(stylus, hand), wrench(clean, hand), 1e-9));
            CHECK(clean.contacts().size() > 0);
        }
}

TEST_CASE("a shaft that jumps past a thin pole in one tick is caught by it, at any speed")
{
    Mesh pole = make_box({1e-4, 1e-4, 1}); // metres: as thin as a hair
    const auto surface = surface_of(pole);
    for (const double jump_m : {1e-3, 0.02, 0.2})
        for (const double turn : {0.0, 0.4}) {
            StylusContact stylus(surface);
            const Ends before{{-0.3, -0.5 * jump_m, 0.01}, {0.3, -0.5 * jump_m, 0.02}};
            const Ends after{{-0.3, 0.5 * jump_m, 0.01}, {0.3, (0.5 + turn) * jump_m, 0.02}};
            stylus.update(before.tip, before.tail);
            for (int i = 0; i < 10; ++i) {
                stylus.update(after.tip, after.tail);
                CAPTURE(jump_m, turn, i);
                REQUIRE(stylus.ideal());
                const dvec3 tip = surface->lattice.metres(stylus.ideal()->tip),
                            tail = surface->lattice.metres(stylus.ideal()->tail);
                CHECK(tip.y + tip.x / (tip.x - tail.x) * (tail.y - tip.y) < 0); // passes it where it came from
            }
            CHECK(wrench(stylus, after).force.y < -0.8 * jump_m); // back, about twice half of the jump
        }
}

TEST_CASE("a shaft whose ends go round either border of a rail in one tick stays on it")
{
    Mesh rail;
    rail.positions_m = {{-2e-3, -0.15, 0}, {2e-3, -0.15, 0}, {2e-3, 0.15, 0}, {-2e-3, 0.15, 0}};
    rail.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto surface = surface_of(rail);
    for (const double mu : {0.0, 0.3}) {
        StylusContact stylus(surface);
        const Friction friction{mu, mu};
        for (const double z : {5e-3, 1e-3, 0.0, -5e-4}) stylus.update({0, -0.05, z}, {0, 0.05, z}, friction);
        REQUIRE(stylus.ideal());
        const auto middle_z = [&] { return surface->lattice.metres(stylus.ideal()->at(0.5)).z; };
        CHECK(middle_z() > 0);
        for (int i = 0; i < 50; ++i) {
            stylus.update({-4e-3, -0.05, -3e-3}, {4e-3, 0.05, -3e-3}, friction);
            CAPTURE(mu, i);
            if (stylus.ideal()) CHECK(middle_z() > 0);
        }
    }
}

TEST_CASE("a shaft lies on a plate of fine cells, and is not let go of")
{
    Mesh plate = make_plane(256);
    scale_to_size(plate, 0.1);
    const auto surface = build_surface(plate).surface;
    for (const double degrees : {0.0, 10.0, 45.0}) {
        const dvec3 along(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)), 0);
        StylusContact stylus(surface);
        for (int tick = 0; tick < 300; ++tick) {
            const dvec3 tip = -0.04 * along + dvec3(0, 2e-5 * tick, std::max(-1e-3, 1e-3 - 5e-5 * tick));
            stylus.update(tip, tip + 0.08 * along, {});
        }
        CAPTURE(degrees, stylus.counters().walks_cut);
        CHECK(stylus.ideal().has_value());
        double pushes_m = 0; // of both ends together
        for (const Contact& contact : stylus.contacts()) pushes_m += contact.depth_m * contact.normal.z;
        CHECK(pushes_m == Approx(2e-3).epsilon(1e-6));
    }
}

TEST_CASE("the tail of a stylus in the air over a fine mesh asks the tree now and then, not in each tick")
{
    // The tip slides on the ball, the tail is a quarter of a diameter above it, where the next face is farther than it
    // goes in many ticks.
    const auto surface = surface_of(make_icosphere(5));
    StylusContact contact(surface);
    const auto pose = [](int i) {
        const dvec3 d(std::cos(2e-3 * i), std::sin(2e-3 * i), 0);
        return std::pair(0.49 * d, 0.75 * d + dvec3(0, 0, 0.1));
    };
    contact.update(1.1 * pose(0).first, 1.1 * pose(0).second);
    for (int i = 0; i < 100; ++i) contact.update(pose(i).first, pose(i).second);
    const ContactCounters before = contact.counters();
    for (int i = 100; i < 1100; ++i) CHECK(contact.update(pose(i).first, pose(i).second).touching);
    CHECK(contact.counters().sweeps - before.sweeps < 1300); // the shaft looks for itself once a tick
}
