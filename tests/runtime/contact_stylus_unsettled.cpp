// A stylus that wanders over hard meshes, held by springs of a few millimetres, where shaft and ends do not always come
// to agree within a tick: what pushes is what the ends' springs pull all the same.
#include "runtime/stylus_contact.h"

#include "tests/runtime/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

constexpr double size_m = 0.1, length_m = 0.05, speed_m_per_tick = 1e-4, deepest_m = 2e-3;

// Goes about an object, gives way to what pushes it by more than `deepest_m`.
class WanderingHand {
public:
    explicit WanderingHand(uint64_t seed) : random_(seed)
    {
        const dvec3 from = glm::normalize(any());
        middle_ = 1.2 * size_m * from;
        heading_ = -from;
        along_ = glm::normalize(glm::cross(from, any()));
        turning_ = 0.02 * any();
    }

    dvec3 tip_m() const { return middle_ - 0.5 * length_m * along_; }
    dvec3 tail_m() const { return middle_ + 0.5 * length_m * along_; }

    void go()
    {
        const dvec3 home = -10.0 * std::max(0.0, glm::length(middle_) - 0.35 * size_m) * middle_;
        heading_ = glm::normalize(heading_ + 0.02 * any() + home);
        middle_ += speed_m_per_tick * heading_;
        turning_ = 0.98 * (turning_ + 0.05 * any());
        along_ = glm::normalize(along_ + 2 * speed_m_per_tick / length_m * turning_);
    }

    void give_way(std::span<const Contact> contacts)
    {
        dvec3 tip = tip_m(), tail = tail_m();
        for (const Contact& contact : contacts) {
            const dvec3 by = std::max(0.0, contact.depth_m - deepest_m) * contact.normal;
            tip += (1 - contact.along) * by;
            tail += contact.along * by;
        }
        middle_ = 0.5 * (tip + tail);
        along_ = glm::normalize(tail - tip);
    }

private:
    dvec3 any() { return {normal_(random_), normal_(random_), normal_(random_)}; }

    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    dvec3 middle_, heading_, along_, turning_;
};

} // namespace

TEST_CASE("a stylus pushes as its ends are pulled, whether or not it has come to rest")
{
    std::vector<NamedMesh> meshes{{"star", make_star(3)},
                                  {"stairs", make_stairs()},
                                  {"crossing", make_crossing_boxes()},
                                  {"torus", make_torus(0.4, 64, 24)}};
    for (NamedMesh& hard : meshes) {
        CAPTURE(hard.name);
        scale_to_size(hard.mesh, size_m);
        const auto surface = surface_of(hard.mesh);
        int touching = 0, steps = 0;
        for (uint64_t seed = 1; seed <= 8; ++seed) {
            StylusContact stylus(surface);
            WanderingHand hand(seed);
            dvec3 force_before{0};
            std::array<dvec3, 4> ends_before;
            for (int tick = 0; tick < 4000; ++tick) {
                hand.go();
                stylus.update(hand.tip_m(), hand.tail_m());
                CAPTURE(seed, tick);
                REQUIRE(stylus.ideal());
                const Lattice& lattice = surface->lattice;
                const std::array<dvec3, 4> ends{hand.tip_m(), hand.tail_m(), lattice.metres(stylus.ideal()->tip),
                                                lattice.metres(stylus.ideal()->tail)};
                dvec3 force{0}; // over the stiffness
                for (const Contact& contact : stylus.contacts()) force += contact.depth_m * contact.normal;
                const double pulled = glm::distance(ends[0], ends[2]) + glm::distance(ends[1], ends[3]);
                REQUIRE(glm::length(force) <= 1.05 * pulled + 1e-9);
                // A force that has come to rest is the sum of what both ends are pulled, and changes as they move.
                double moved = 0;
                for (std::size_t i = 0; tick > 0 && i < ends.size(); ++i)
                    moved += glm::distance(ends[i], ends_before[i]);
                const double step = tick > 0 ? glm::distance(force, force_before) - moved : 0.0;
                REQUIRE(step < 1.5 * deepest_m);
                steps += step > 0.25 * deepest_m;
                touching += !stylus.contacts().empty();
                force_before = force;
                ends_before = ends;
                hand.give_way(stylus.contacts());
            }
        }
        CHECK(touching > 10'000);
        CHECK(1000 * steps < touching);
    }
}
