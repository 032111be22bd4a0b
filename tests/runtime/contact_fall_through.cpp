// Nothing falls through. The hand behaves as badly as it can; the judge knows nothing of the predicates or the walk: on
// a closed mesh wound outward a probe that came from outside may touch only front sides, and while it is free the
// winding number around it is 0.
#include "runtime/contact.h"

#include "tests/runtime/meshes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

class WildHand {
public:
    WildHand(const Surface& surface, uint64_t seed)
        : surface_(surface)
        , random_(seed)
        , centre_(surface.lattice.centre_m)
        , size_(0.5 * glm::length(surface.box_maximum_m - surface.box_minimum_m))
        , hand_(outside())
    {
    }

    dvec3 outside() const { return centre_ + dvec3(3, 0.1, 0.2) * size_; }
    void restart() { hand_ = outside(), left_ = 0; }
    double size() const { return size_; }

    dvec3 next()
    {
        if (left_-- <= 0) {
            habit_ = int(random_() % 9);
            left_ = int(20 + random_() % 200);
            face_ = any_face();
            corner_ = uint32_t(random_() % 3);
            place_ = uniform();
            pace_ = (uniform() - 0.5) * std::pow(10, -4 * uniform());
        }
        const dvec3 a = surface_.vertex_m(face_, corner_), b = surface_.vertex_m(face_, (corner_ + 1) % 3),
                    c = surface_.vertex_m(face_, (corner_ + 2) % 3);
        switch (habit_) {
        case 0: // jumps
            hand_ = centre_ + 3.0 * size_ * (dvec3(uniform(), uniform(), uniform()) - 0.5);
            break;
        case 1: // strolls
            hand_ += 0.01 * size_ * normal();
            break;
        case 2: // exactly on vertices
            hand_ = any_vertex();
            break;
        case 3: { // exactly on edges
            const uint32_t face = any_face();
            hand_ = 0.5 * (surface_.vertex_m(face, 0) + surface_.vertex_m(face, 1));
            break;
        }
        case 4: { // exactly on faces
            const uint32_t face = any_face();
            hand_ = (surface_.vertex_m(face, 0) + surface_.vertex_m(face, 1) + surface_.vertex_m(face, 2)) / 3.0;
            break;
        }
        case 5: { // to and fro through a vertex, an edge's middle, a centroid
            const double which = uniform();
            const dvec3 aim = which < 0.5 ? a : which < 0.75 ? 0.5 * (a + b) : (a + b + c) / 3.0;
            hand_ = aim + (left_ % 2 ? 0.05 : -0.05) * size_ * surface_.facet_normal(face_);
            if (uniform() < 0.1) face_ = any_face();
            break;
        }
        case 6: // exactly along an edge
            place_ += pace_;
            if (place_ < 0 || place_ > 1) pace_ = -pace_, place_ = glm::clamp(place_, 0.0, 1.0);
            hand_ = a + place_ * (b - a);
            break;
        case 7: { // along an axis, level with vertices
            const int axis = int(random_() % 3);
            hand_[axis] = any_vertex()[axis];
            break;
        }
        default: // drifts in
            hand_ = centre_ + 0.97 * (hand_ - centre_) + 0.002 * size_ * normal();
            if (glm::length(hand_ - centre_) < 0.05 * size_) hand_ = centre_ + 1.5 * size_ * glm::normalize(normal());
            break;
        }
        if (glm::length(hand_ - centre_) > 3 * size_) hand_ = centre_ + 2.0 * size_ * glm::normalize(hand_ - centre_);
        return hand_;
    }

private:
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    dvec3 normal()
    {
        std::normal_distribution<double> d;
        return {d(random_), d(random_), d(random_)};
    }
    uint32_t any_face() { return uint32_t(random_() % surface_.faces.size()); }
    dvec3 any_vertex() { return surface_.vertex_m(any_face(), uint32_t(random_() % 3)); }

    const Surface& surface_;
    std::mt19937_64 random_;
    dvec3 centre_;
    double size_;
    dvec3 hand_;
    int habit_ = 0, left_ = 0;
    uint32_t face_ = 0, corner_ = 0;
    double place_ = 0, pace_ = 0;
};

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

Mesh far_away(Mesh mesh)
{
    for (dvec3& p : mesh.positions_m) p += dvec3(1e4, -1e4, 1e4);
    return mesh;
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
