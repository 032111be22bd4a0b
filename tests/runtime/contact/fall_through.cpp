// Nothing falls through. The hand behaves as badly as it can; the judge knows nothing of the predicates or the walk: on
// a closed mesh wound outward a probe that came from outside may touch only front sides, and while it is free the
// winding number around it is 0.
#include "runtime/contact/end_contact.h"

#include "tests/runtime/render/wild_hand.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <cmath>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

struct Fallen {
    int through = 0, judged = 0, cut = 0;
};

Fallen abuse(const std::shared_ptr<const Surface>& surface, int ticks, uint64_t seed, const Friction& friction,
             int judge_every)
{
    WildHand hand(*surface, seed);
    const auto point = make_point(surface);
    EndContact& contact = *point;
    contact.update(hand.outside(), friction);
    Fallen verdict;
    bool touched = false;
    for (int i = 0; i < ticks; ++i) {
        const Contact& touch = contact.update(hand.next(), friction);
        bool through = touch.touching && touch.side != 0;
        if (!touch.touching && (touched || i % judge_every == 0)) {
            const Winding around = winding(*surface, touch.proxy_m);
            // A hand exactly on the surface is on either side; so near the sum of angles is rounding anyway.
            if (around.distance_m > 1e-8 * hand.size()) {
                ++verdict.judged;
                through = through || std::abs(around.number) > 0.5;
            }
        }
        touched = touch.touching;
        if (!through) continue;
        ++verdict.through;
        verdict.cut += int(contact.counters().walks_cut);
        contact.reset();
        hand.restart();
        contact.update(hand.outside(), friction);
    }
    verdict.cut += int(contact.counters().walks_cut);
    return verdict;
}

// Closed meshes that cut themselves: crumpled, laid through each other, folded.
std::vector<Mesh> make_self_piercing(uint32_t subdivisions)
{
    std::vector<Mesh> meshes;
    std::mt19937_64 random(41);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto crumple = [&](Mesh mesh, double by) { // by place: seams stay closed
        const dvec3 phase = 9.0 * dvec3(any(random), any(random), any(random));
        for (dvec3& p : mesh.positions_m)
            p += by * dvec3(std::sin(91 * p.x + 47 * p.y + phase.x), std::sin(83 * p.y + 59 * p.z + phase.y),
                            std::sin(71 * p.z + 67 * p.x + phase.z));
        return mesh;
    };
    for (int k = 0; k < 8; ++k) meshes.push_back(crumple(make_icosphere(subdivisions), 0.15 + 0.05 * k));
    for (int k = 0; k < 4; ++k) meshes.push_back(crumple(make_torus(0.4, 24, 12), 0.1 + 0.05 * k));
    for (int k = 0; k < 6; ++k) { // several through each other
        Mesh heap;
        for (int part = 0; part < 2 + k % 3; ++part) {
            const Mesh one = part % 2 ? make_torus(0.35, 20, 10) : make_icosphere(2);
            const auto first = uint32_t(heap.positions_m.size());
            const dvec3 by = 0.5 * dvec3(any(random), any(random), any(random));
            for (const dvec3& p : one.positions_m) heap.positions_m.push_back(p + by);
            for (const auto& [a, b, c] : one.triangles) heap.triangles.push_back({a + first, b + first, c + first});
        }
        meshes.push_back(heap);
    }
    for (int k = 0; k < 6; ++k) { // a long box, bent until it goes through itself
        Mesh bent = make_sphere(48, 10);
        for (dvec3& p : bent.positions_m) {
            const double along = (4 + k) * p.y, radius = 0.6 + 0.05 * k;
            p = {(radius + 0.4 * p.x) * std::cos(along), (radius + 0.4 * p.x) * std::sin(along),
                 0.3 * p.z + 0.02 * k * along};
        }
        meshes.push_back(bent);
    }
    return meshes;
}

// Of every tick the place of the proxy, whether it touches or not.
Fallen abuse_pierced(const std::shared_ptr<const Surface>& surface, int ticks, uint64_t seed, const Friction& friction)
{
    WildHand hand(*surface, seed);
    const auto contact = make_point(surface);
    contact->update(hand.outside(), friction);
    Fallen verdict;
    for (int i = 0; i < ticks; ++i) {
        contact->update(hand.next(), friction);
        const Winding around = winding(*surface, surface->lattice.metres(contact->proxy().at));
        if (around.distance_m < 1e-8 * hand.size()) continue;
        ++verdict.judged;
        if (std::abs(around.number) < 0.5) continue;
        ++verdict.through;
        contact->reset();
        hand.restart();
        contact->update(hand.outside(), friction);
    }
    verdict.cut = int(contact->counters().walks_cut);
    return verdict;
}

} // namespace

TEST_CASE("a wild hand never gets inside of a closed mesh that pierces itself")
{
    const int ticks = is_sanitized ? 300 : 1500;
    int pierced = 0;
    for (const Mesh& mesh : make_self_piercing(2)) {
        const auto surface = surface_of(mesh);
        if (surface->is_clean()) continue; // not enough for that
        ++pierced;
        for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}}) {
            const Fallen verdict = abuse_pierced(surface, ticks, 7, friction);
            CAPTURE(mesh.triangles.size(), friction.static_coefficient, verdict.cut);
            CHECK(verdict.through == 0);
            CHECK(verdict.judged > ticks * 14 / 15);
            CHECK(verdict.cut < ticks / 20); // after jumps
        }
    }
    CHECK(pierced >= 20);
}

TEST_CASE("a wild hand never gets inside of a closed mesh that pierces itself: long run", "[.long]")
{
    uint64_t ticks = 0, through = 0, cut = 0, judged = 0;
    for (const Mesh& mesh : make_self_piercing(3))
        for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}}) {
            const Fallen verdict = abuse_pierced(surface_of(mesh), 25000, 3, friction);
            ticks += 25000, through += uint64_t(verdict.through), cut += uint64_t(verdict.cut);
            judged += uint64_t(verdict.judged);
        }
    WARN("inside " << through << " of " << ticks << " ticks, judged " << judged << ", cut " << cut);
    CHECK(through == 0);
}

TEST_CASE("a wild hand never falls through a closed mesh")
{
    const Mesh meshes[] = {make_icosphere(2),
                           make_bumpy_sphere(3),
                           far_away(make_icosphere(2)),
                           make_star(2),
                           make_torus(0.4, 24, 12),
                           make_sphere(24, 12),
                           make_box(),
                           make_box({1, 1, 2e-6}),
                           make_box({1, 1, 2e-10}),
                           make_stairs(),
                           make_touching_cubes(Touching::edges),
                           make_touching_cubes(Touching::corners)};
    for (const Mesh& mesh : meshes)
        for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}}) {
            const Fallen verdict = abuse(surface_of(mesh), 6000, 31, friction, 16);
            CAPTURE(mesh.triangles.size(), friction.static_coefficient);
            CHECK(verdict.through == 0);
            CHECK(verdict.cut == 0);
            CHECK(verdict.judged > 100);
        }
}

TEST_CASE("a wild hand never falls through a closed mesh: long run", "[.long]")
{
    const struct {
        const char* name;
        Mesh mesh;
    } meshes[] = {{"icosphere 1280", make_icosphere(3)},
                  {"bumpy sphere 5120", make_bumpy_sphere(4)},
                  {"icosphere at 1e4 m", far_away(make_icosphere(3))},
                  {"star 1280", make_star(3)},
                  {"torus", make_torus(0.4, 24, 12)},
                  {"uv sphere", make_sphere(32, 16)},
                  {"box", make_box()},
                  {"plate 2e-6", make_box({1, 1, 2e-6})},
                  {"plate 2e-10", make_box({1, 1, 2e-10})},
                  {"stairs", make_stairs()},
                  {"cubes sharing edges", make_touching_cubes(Touching::edges)},
                  {"cubes sharing corners", make_touching_cubes(Touching::corners)},
                  {"crossing boxes", make_crossing_boxes()}};
    int ticks = 0, through = 0;
    for (const auto& [name, mesh] : meshes) {
        for (uint64_t seed : {1u, 2u}) {
            const Fallen verdict = abuse(surface_of(mesh), 500000, seed, {seed == 1 ? 0.0 : 0.3, 0.2}, 64);
            WARN(name << ", seed " << seed << ": through " << verdict.through << " of 500000 ticks, judged "
                      << verdict.judged << ", cut " << verdict.cut);
            ticks += 500000, through += verdict.through;
        }
    }
    WARN("in all " << through << " of " << ticks);
    CHECK(through == 0);
}

TEST_CASE("overlapping boxes without shared edges hold the probe outside")
{
    const auto surface = surface_of(make_crossing_boxes());
    const Fallen verdict = abuse(surface, 20000, 8, {}, 16);
    CHECK(verdict.through == 0);

    // In the crease between two of them the proxy may be on one only, but never inside the other.
    WildHand hand(*surface, 9);
    const auto point = make_point(surface);
    EndContact& contact = *point;
    contact.update(hand.outside());
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const Contact& touch = contact.update(hand.next());
        if (!touch.touching) continue;
        const Winding around = winding(*surface, touch.proxy_m + 1e-7 * touch.facet_normal);
        inside += around.distance_m > 5e-8 && around.number > 0.5;
    }
    CHECK(inside == 0);
}
