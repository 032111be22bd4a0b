// The stylus against closed forms of its geometry, and its ideal shaft against all triangles in exact arithmetic.
#include "runtime/stylus_contact.h"

#include "tests/runtime/exact_mesh.h"
#include "tests/runtime/meshes.h"
#include "tests/runtime/wild_hand.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec2;
using glm::dvec3;

namespace {

struct Pose {
    dvec3 tip{0}, tail{0};
};

Pose between(const Pose& a, const Pose& b, double share)
{
    return {a.tip + share * (b.tip - a.tip), a.tail + share * (b.tail - a.tail)};
}

Pose moved(const Pose& pose, const dvec3& by)
{
    return {pose.tip + by, pose.tail + by};
}

void drive(StylusContact& stylus, const Pose& from, const Pose& to, int ticks)
{
    for (int i = 0; i <= ticks; ++i) {
        const Pose pose = between(from, to, double(i) / ticks);
        stylus.update(pose.tip, pose.tail);
    }
}

// Of springs of 1 N/m: in metres, and square metres about the tail.
struct Wrench {
    dvec3 force{0}, torque{0};
};

Wrench wrench(const StylusContact& stylus, const Pose& hand)
{
    Wrench sum;
    for (const Contact& contact : stylus.contacts()) {
        const dvec3 force = contact.depth_m * contact.normal + contact.lag_m;
        sum.force += force;
        sum.torque += torque_about(hand.tail, hand.tip + contact.along * (hand.tail - hand.tip), force);
    }
    return sum;
}

Wrench pulled(const Pose& hand, const Pose& ideal)
{
    return {ideal.tip - hand.tip + ideal.tail - hand.tail, glm::cross(hand.tip - hand.tail, ideal.tip - hand.tip)};
}

// Seen along an edge, the shaft is a line that has to pass by a point: of all lines through it the one with the
// smallest sum of squared distances to the ends, which is along the principal axis of their moments.
Pose on_edge(const Pose& hand, const dvec3& point, const dvec3& edge)
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
                    const Pose hand{at - share * 0.6 * along, at + (1 - share) * 0.6 * along};
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

TEST_CASE("the ideal stylus crosses no triangle, however wildly the hand moves")
{
    struct Named {
        const char* name;
        Mesh mesh;
    };
    const Named meshes[] = {
        {"icosphere", make_icosphere(2)}, {"box", make_box({1, 0.6, 0.3})},     {"torus", make_torus(0.4, 24, 12)},
        {"plate", make_plane(3)},         {"bumpy ball", make_bumpy_sphere(3)}, {"star", make_star(2)},
        {"stairs", make_stairs()}};
    for (const Named& named : meshes) {
        const auto surface = surface_of(named.mesh);
        const ExactMesh exact(*surface);
        StylusContact stylus(surface);
        WildHand tip(*surface, 11), tail(*surface, 12);
        std::mt19937_64 random(13);
        uint64_t tracked = 0, sides = 0, crossed = 0;
        dvec3 lean(0, 0, 1);
        const int ticks = 4000;
        for (int i = 0; i < ticks; ++i) {
            Pose hand{tip.next(), {}};
            if (i / 500 % 2) {
                std::normal_distribution<double> d;
                lean = glm::normalize(lean + 0.05 * dvec3(d(random), d(random), d(random)));
                hand.tail = hand.tip + 1.5 * tip.size() * lean;
            } else {
                hand.tail = tail.next();
            }
            stylus.update(hand.tip, hand.tail);
            for (const Contact& contact : stylus.contacts()) {
                sides += contact.by_shaft;
                if (!(contact.depth_m >= 0 &&
                      std::isfinite(contact.depth_m + glm::dot(contact.normal, contact.proxy_m))))
                    FAIL("not finite");
            }
            const auto ideal = stylus.ideal();
            if (!ideal) continue;
            ++tracked;
            crossed += exact.first_crossing(ideal->tip, ideal->tail).has_value();
        }
        CAPTURE(named.name);
        CHECK(crossed == 0);
        CHECK(tracked > ticks * 9 / 10);
        CHECK(sides > 100);
    }
}
