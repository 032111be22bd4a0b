// Nothing falls through. The hand behaves as badly as it can; the judge knows nothing of the predicates or the walk: on
// a closed mesh wound outward a probe that came from outside may touch only front sides, and while it is free the
// winding number around it is 0.
#include "runtime/contact/contact.h"

#include "tests/runtime/render/wild_hand.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

struct Verdict {
    int through = 0, judged = 0, cut = 0;
};

Verdict abuse(const std::shared_ptr<const Surface>& surface, int ticks, uint64_t seed, const Friction& friction,
              int judge_every)
{
    WildHand hand(*surface, seed);
    PointContact contact(surface);
    contact.update(hand.outside(), friction);
    Verdict verdict;
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

} // namespace

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
            const Verdict verdict = abuse(surface_of(mesh), 6000, 31, friction, 16);
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
            const Verdict verdict = abuse(surface_of(mesh), 500000, seed, {seed == 1 ? 0.0 : 0.3, 0.2}, 64);
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
    const Verdict verdict = abuse(surface, 20000, 8, {}, 16);
    CHECK(verdict.through == 0);

    // In the crease between two of them the proxy may be on one only, but never inside the other.
    WildHand hand(*surface, 9);
    PointContact contact(surface);
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
