// A stylus that wanders over hard meshes, held by springs of millimetres, where shaft and ends do not always come to
// agree within a tick. Its springs have a potential, half the stiffness times the squares of what both are drawn by.
// What is told pushes as these pull, in every tick; and with the hand at rest no tick may draw them further. So no path
// of the hand gains energy.
#include "runtime/contact/stylus_contact.h"

#include "tests/runtime/contact/ends.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <span>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

constexpr double size_m = 0.1;

struct Manner {
    double speed_m_per_tick, deepest_m, length_m = 0.05;
};

// Goes about an object, gives way to what pushes it by more than `deepest_m`.
class WanderingHand {
public:
    WanderingHand(uint64_t seed, const Manner& manner) : manner_(manner), random_(seed)
    {
        const dvec3 from = glm::normalize(any());
        middle_ = 1.2 * size_m * from;
        heading_ = -from;
        along_ = glm::normalize(glm::cross(from, any()));
        turning_ = 0.02 * any();
    }

    dvec3 tip_m() const { return middle_ - 0.5 * manner_.length_m * along_; }
    dvec3 tail_m() const { return middle_ + 0.5 * manner_.length_m * along_; }

    void go()
    {
        const dvec3 home = -10.0 * std::max(0.0, glm::length(middle_) - 0.35 * size_m) * middle_;
        heading_ = glm::normalize(heading_ + 0.02 * any() + home);
        middle_ += manner_.speed_m_per_tick * heading_;
        turning_ = 0.98 * (turning_ + 0.05 * any());
        along_ = glm::normalize(along_ + 2 * manner_.speed_m_per_tick / manner_.length_m * turning_);
    }

    void give_way(std::span<const Contact> contacts)
    {
        dvec3 tip = tip_m(), tail = tail_m();
        for (const Contact& contact : contacts) {
            const dvec3 by = std::max(0.0, contact.depth_m - manner_.deepest_m) * contact.normal;
            tip += (1 - contact.along) * by;
            tail += contact.along * by;
        }
        middle_ = 0.5 * (tip + tail);
        along_ = glm::normalize(tail - tip);
    }

private:
    dvec3 any() { return {normal_(random_), normal_(random_), normal_(random_)}; }

    Manner manner_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    dvec3 middle_, heading_, along_, turning_;
};

std::vector<NamedMesh> hard_meshes()
{
    std::vector<NamedMesh> meshes{{"star", make_star(3)},
                                  {"stairs", make_stairs()},
                                  {"crossing", make_crossing_boxes()},
                                  {"box", make_box()},
                                  {"touching", make_touching_cubes(Touching::corners)},
                                  {"torus", make_torus(0.4, 64, 24)}};
    for (NamedMesh& hard : meshes) scale_to_size(hard.mesh, size_m);
    return meshes;
}

Ends pushed_by(std::span<const Contact> contacts)
{
    Ends pushed;
    for (const Contact& contact : contacts) {
        const dvec3 by = contact.depth_m * contact.normal + contact.lag_m;
        pushed.tip += (1 - contact.along) * by;
        pushed.tail += contact.along * by;
    }
    return pushed;
}

} // namespace

TEST_CASE("what a stylus pushes has a potential that the hand alone can raise")
{
    const Manner manner = GENERATE(Manner{1e-4, 2e-3}, Manner{3e-4, 10e-3}, Manner{1e-4, 25e-3});
    const double rounding_m = 1e-8 * size_m;
    for (const NamedMesh& hard : hard_meshes()) {
        CAPTURE(hard.name, manner.deepest_m);
        const auto surface = surface_of(hard.mesh);
        // Its radius is not felt, nor how far that holds it out of a narrow fold, by a lever.
        const double unfelt_m = 32 * Lattice::point_radius * surface->lattice.unit_m;
        int touching = 0, unsettled = 0, ticks = 0, steps = 0;
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            StylusContact stylus(surface);
            WanderingHand hand(seed, manner);
            Ends at_before;
            std::optional<Ends> held_before;
            for (int tick = 0; tick < 4000; ++tick) {
                hand.go();
                const Ends at{hand.tip_m(), hand.tail_m()};
                const uint64_t cut = stylus.counters().walks_cut;
                stylus.update(at.tip, at.tail);
                hand.give_way(stylus.contacts());
                std::optional<Ends> held;
                if (const auto ideal = stylus.ideal())
                    held = {surface->lattice.metres(ideal->tip), surface->lattice.metres(ideal->tail)};
                CAPTURE(seed, tick);
                if (held) {
                    const double pulled_m = (*held - at).length();
                    REQUIRE((pushed_by(stylus.contacts()) - (*held - at)).length() <
                            rounding_m + unfelt_m + 2e-6 * pulled_m);
                    // Nor do they push each other: of joined objects each pushes by a stiffness of its own.
                    for (const Contact& contact : stylus.contacts())
                        REQUIRE(contact.depth_m < rounding_m + 8 * pulled_m);
                }
                if (held && held_before) {
                    REQUIRE((*held - at).length() < (*held_before - at).length() + rounding_m + unfelt_m);
                    ++ticks;
                    const double step = (*held - *held_before).length() - (at - at_before).length();
                    steps += step > 0.25 * manner.deepest_m; // as where it slides off an edge
                }
                at_before = at;
                unsettled += stylus.counters().walks_cut > cut;
                touching += !stylus.contacts().empty();
                held_before = held;
            }
        }
        CHECK(ticks > 13'000); // of 16 000: it is rarely let go
        CHECK(touching > 4'000);
        CHECK(3 * unsettled < touching);
        CHECK(100 * steps < touching);
    }
}

// A longer stylus than the workspace is wide: what is told takes the hand's to one of which the ideal is a part.
TEST_CASE("what pushes a stylus of which a part is out of the workspace is told in every tick, too")
{
    const double rounding_m = 1e-8 * size_m;
    for (const NamedMesh& hard : hard_meshes()) {
        CAPTURE(hard.name);
        const auto surface = surface_of(hard.mesh);
        const double unfelt_m = 32 * Lattice::point_radius * surface->lattice.unit_m;
        int touching = 0, parts = 0;
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            StylusContact stylus(surface);
            WanderingHand hand(seed, {3e-4, 10e-3, 0.5});
            for (int tick = 0; tick < 4000; ++tick) {
                hand.go();
                const Ends at{hand.tip_m(), hand.tail_m()};
                stylus.update(at.tip, at.tail);
                hand.give_way(stylus.contacts());
                const auto ideal = stylus.ideal();
                if (!ideal) continue;
                CAPTURE(seed, tick);
                const Ends pushed = pushed_by(stylus.contacts());
                const dvec3 tip = at.tip + pushed.tip, along = glm::normalize(at.tail + pushed.tail - tip);
                for (const dvec3& end : {surface->lattice.metres(ideal->tip), surface->lattice.metres(ideal->tail)})
                    REQUIRE(glm::length(glm::cross(end - tip, along)) < rounding_m + unfelt_m + 2e-6 * pushed.length());
                parts += glm::distance(ideal->tip, ideal->tail) * surface->lattice.unit_m < 0.499;
                touching += !stylus.contacts().empty();
            }
        }
        CHECK(touching > 4'000);
        CHECK(parts > 1'000);
    }
}
