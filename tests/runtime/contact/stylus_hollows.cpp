// A stylus that slides slowly through hollows, over many small facets: it is never caught at a vertex.
#include "runtime/contact/stylus_contact.h"

#include "tests/runtime/contact/ends.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// The stylus that small random steps lead to, of which each comes nearer to the hand and passes through nothing: where
// the ideal one should be, by no other means than segments against triangles.
Ends nearest_by_search(const Surface& surface, const Ends& from, const Ends& hand, std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> fineness(-8, -4);
    const auto any = [&](double length) { return length * dvec3(normal(random), normal(random), normal(random)); };
    Ends at = from;
    for (int i = 0; i < 1500; ++i) {
        const double length = std::pow(10, fineness(random));
        const Ends to{at.tip + any(length), at.tail + any(length)};
        if ((hand - to).square() >= (hand - at).square()) continue;
        bool free = true;
        for (double share = 0.25; free && share <= 1; share += 0.25) {
            const dvec3 tip = at.tip + share * (to.tip - at.tip), tail = at.tail + share * (to.tail - at.tail);
            free = !surface.first_hit(tip, tail) && !surface.first_hit(tail, tip);
        }
        if (free) at = to;
    }
    return at;
}

// Seven centimetres above the middle of a ring of 14 cm, whose hole is 6 cm wide; it leans, goes round and up and down,
// and its tip is pressed up to 1 mm into the wall of the hole.
Ends in_the_hole(double time_s, double turn, double lean)
{
    const double angle = turn + 0.25 * time_s + 0.4 * std::sin(1.1 * time_s + turn);
    const double radius_m = 0.02 + 0.0105 * std::min(1.0, time_s / 0.3) + 0.0004 * std::sin(3 * time_s);
    const dvec3 tip(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.012 * std::sin(1.7 * time_s + 2 * turn));
    const double leans_to = 3 * turn + 0.2 * time_s;
    return {tip, tip + dvec3(lean * std::cos(leans_to), lean * std::sin(leans_to), 0.14)};
}

} // namespace

TEST_CASE("a shaft that slides round the hole of a ring is caught at none of its vertices")
{
    Mesh ring = *make_shape("torus");
    scale_to_size(ring, 0.14);
    const auto surface = surface_of(ring);
    std::mt19937_64 random(1);
    int by_shaft = 0, searched = 0;
    for (int stroke = 0; stroke < 12; ++stroke) {
        StylusContact stylus(surface);
        const double turn = 0.52 * stroke, lean = 0.02 + 0.004 * stroke;
        for (int tick = 0; tick < 4000; ++tick) {
            const Ends hand = in_the_hole(1e-3 * tick, turn, lean);
            stylus.update(hand.tip, hand.tail);
            if (stylus.contacts().empty()) continue;
            CAPTURE(stroke, tick);
            REQUIRE(stylus.ideal());
            const Ends ideal{surface->lattice.metres(stylus.ideal()->tip),
                             surface->lattice.metres(stylus.ideal()->tail)};
            // Contacts do not fight each other: none pushes more than all of them have to.
            const double square = (hand - ideal).square(), off_m = std::sqrt(square);
            for (const Contact& contact : stylus.contacts()) {
                by_shaft += contact.by_shaft;
                REQUIRE(contact.depth_m <= 3 * off_m + 1e-9);
            }
            if (tick % 100 > 0) continue;
            ++searched;
            // The search knows no radius.
            const double radius_m = Lattice::point_radius * surface->lattice.unit_m;
            REQUIRE((hand - nearest_by_search(*surface, ideal, hand, random)).length() >= 0.99 * off_m - 2 * radius_m);
        }
        CHECK(stylus.counters().walks_cut == 0);
    }
    CHECK(by_shaft > 5000);
    CHECK(searched > 100);
}

namespace {

// A disc of 8 cm, raised in its middle, with a skirt that is open below.
Mesh make_cap(uint32_t sides, double skirt_m, double flare_m)
{
    Mesh mesh;
    for (uint32_t i = 0; i < sides; ++i) {
        const double angle = 6.283185307179586 * i / sides;
        const dvec3 out(std::cos(angle), std::sin(angle), 0);
        mesh.positions_m.push_back(0.04 * out);
        mesh.positions_m.push_back((0.04 + flare_m) * out - dvec3(0, 0, skirt_m));
    }
    mesh.positions_m.emplace_back(0, 0, 0.01);
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        mesh.triangles.push_back({2 * sides, a, b});
        mesh.triangles.push_back({a, a + 1, b + 1});
        mesh.triangles.push_back({a, b + 1, b});
    }
    return mesh;
}

} // namespace

TEST_CASE("a tip that is drawn over the open border of a cap leaves its shaft there, and no contact fights another")
{
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    int over = 0, stopped = 0;
    for (int stroke = 0; stroke < 60; ++stroke) {
        const auto sides = static_cast<uint32_t>(20 + 12 * any(random));
        const auto surface = surface_of(make_cap(sides, 0.0025 + 0.002 * any(random), 0.002 * any(random)));
        StylusContact stylus(surface);
        const double angle = 3 * any(random), deep_m = 0.005 + 0.003 * any(random), aside = 0.005 * any(random);
        const dvec3 out(std::cos(angle), std::sin(angle), 0), along(-out.y, out.x, 0);
        const dvec3 leans = glm::normalize(dvec3(0, 0, 1) + 0.6 * any(random) * out + 0.6 * any(random) * along);
        for (int tick = 0; tick < 3000; ++tick) {
            const double time_s = 1e-3 * tick, down = std::min(1.0, time_s / 0.4);
            const dvec3 tip =
                (0.03 + 0.006 * time_s) * out + aside * time_s * along + dvec3(0, 0, 0.02 - (0.02 + deep_m) * down);
            const Ends hand{tip, tip + 0.12 * leans};
            stylus.update(hand.tip, hand.tail);
            if (stylus.contacts().empty()) continue;
            CAPTURE(stroke, sides, tick);
            REQUIRE(stylus.ideal());
            const Ends ideal{surface->lattice.metres(stylus.ideal()->tip),
                             surface->lattice.metres(stylus.ideal()->tail)};
            dvec3 sum(0);
            for (const Contact& contact : stylus.contacts()) {
                sum += contact.depth_m * contact.normal;
                REQUIRE(contact.depth_m <= 3 * std::sqrt((hand - ideal).square()) + 1e-9);
                over += contact.by_shaft;
            }
            // What pushes is what the ideal stylus is off the hand, unless it was stopped on its way.
            const double unfelt_m = 4 * Lattice::point_radius * surface->lattice.unit_m;
            stopped += glm::distance(sum, ideal.tip - hand.tip + ideal.tail - hand.tail) > 1e-6 + unfelt_m;
        }
    }
    CHECK(over > 1000);
    CHECK(stopped <= 60); // of 180 000; the tip of one stroke is held up for 51 on its way round a corner
}
