// Every step of the proxy is possible, on any mesh: shown by an accomplice (accomplice.h) that goes the same way in
// free space, by exact arithmetic that shares nothing with what it judges.
#include "runtime/contact/stylus_contact.h"
#include "runtime/contact/walk_contact.h"

#include "tests/runtime/contact/accomplice.h"
#include "tests/runtime/contact/long_run.h"
#include "tests/runtime/render/wild_hand.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <cmath>
#include <iostream>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// A probe taken apart: the same ticks as WalkContact, but each step of each walk by itself, so that each can be
// followed.
class Stepped {
public:
    explicit Stepped(const Surface& surface) : surface_(surface) {}

    const Proxy& proxy() const { return proxy_; }
    void put(const dvec3& hand_m)
    {
        proxy_ = {};
        proxy_.at = surface_.lattice.snap(hand_m);
        before_ = surface_.lattice.units(hand_m);
    }

    // `slides`: what slid before goes on to.
    template <class Followed>
    bool tick(const dvec3& hand_m, const Friction& friction, bool slides, Followed&& followed)
    {
        proxy_.sliding = proxy_.sliding && slides;
        const dvec3 hand = surface_.lattice.snap(hand_m);
        ContactCounters count;
        uint64_t cut = 0;
        dvec3 from = before_, to = before_ = surface_.lattice.units(hand_m);
        if (proxy_.on == Proxy::On::nothing) {
            // Outside of the workspace nothing is in the way, but the straight way within it counts.
            const bool inside = Lattice::clip_to_workspace(from, to);
            for (const dvec3& at : {from, to, hand}) {
                if (inside && at == to) {
                    Crossing crossing;
                    if (first_crossing(surface_, from, to, StartsOn::nothing(), crossing, count)) {
                        land(surface_, proxy_, crossing, from, to);
                        proxy_.sliding = false;
                        if (!followed(proxy_)) return false;
                        break;
                    }
                }
                if (!inside && at != hand) continue;
                proxy_.at = at;
                if (!followed(proxy_)) return false;
            }
            if (proxy_.on == Proxy::On::nothing) return true;
        }
        do {
            walk(surface_, proxy_, hand, friction, count, 1);
            if (!followed(proxy_)) return false;
        } while (count.walks_cut > std::exchange(cut, count.walks_cut));
        return true;
    }

private:
    const Surface& surface_;
    Proxy proxy_;
    dvec3 before_{0}; // the hand, neither rounded nor clamped
};

// Aslant to most faces, and far from round.
const Friction grained_aslant{0.3, 0.2, grain_along({1, 2, 3}, 0.1, dvec3(0))};

struct Verdict {
    uint64_t ticks = 0, touching = 0, steps = 0, impossible = 0, differing = 0, cut = 0, detours = 0, sideless = 0;
    uint64_t stuck = 0;     // without friction
    double off_surface = 0; // farthest from its face, in sizes of the object

    void operator+=(const Verdict& v)
    {
        ticks += v.ticks, touching += v.touching, steps += v.steps, impossible += v.impossible;
        differing += v.differing, cut += v.cut, detours += v.detours, sideless += v.sideless, stuck += v.stuck;
        off_surface = std::max(off_surface, v.off_surface);
    }
};

std::ostream& operator<<(std::ostream& out, const Verdict& v)
{
    return out << v.ticks << " ticks, " << v.touching << " touching, " << v.steps << " steps: impossible "
               << v.impossible << ", unlike the probe's " << v.differing << ", cut " << v.cut << ", stuck " << v.stuck
               << ", off the surface by " << v.off_surface << " sizes; detours " << v.detours << ", side not resolved "
               << v.sideless;
}

// How far the proxy is from the face that it says it touches, in sizes of the object.
double off_surface(const Surface& surface, const ExactMesh& exact, const Proxy& proxy)
{
    if (proxy.on == Proxy::On::nothing) return 0;
    const dvec3 sides = (surface.box_maximum_m - surface.box_minimum_m) / surface.lattice.unit_m;
    return glm::length(proxy.at - exact.nearest(proxy.face, proxy.at)) / std::max({sides.x, sides.y, sides.z});
}

// A point that is a ball goes by straight ways between free places. Each of them has to be open, and as the ball has a
// radius so has each beside it: one in the plane of a triangle would count as touching it from afar.
Verdict judge_ball(const std::shared_ptr<const Surface>& shared, uint64_t ticks, uint64_t seed,
                   const Friction& friction)
{
    const Surface& surface = *shared;
    const ExactMesh exact(surface);
    WildHand hand(surface, seed);
    SphereContact point(shared);
    SphereContact* const contact = &point;
    contact->update(hand.outside());
    std::mt19937_64 random(seed);
    Verdict verdict;
    std::vector<dvec3> path;
    for (uint64_t i = 0; i < ticks; ++i) {
        const dvec3 at_m = hand.next(), target = surface.lattice.snap(at_m);
        dvec3 at = glm::round(contact->proxy().at);
        bool possible = contact->is_placed();
        contact->update(at_m, friction);
        path.clear();
        for (const dvec3& place : contact->places()) path.push_back(glm::round(place));
        path.push_back(glm::round(contact->proxy().at));
        for (std::size_t k = 0; k < path.size() && possible; at = path[k++]) {
            ++verdict.steps;
            const auto odd = [&] { return 2.0 * double(random() % 1024) - 1023; };
            const auto open_beside = [&] {
                const dvec3 beside(odd(), odd(), odd());
                return exact.open(at + beside, path[k] + beside);
            };
            possible = open_beside() || open_beside(); // one of them may be in the plane of a triangle
        }
        const Contact& touch = contact->contact();
        const double grown = contact->radius();
        double off = touch.touching ? std::abs(glm::distance(exact.nearest(touch.face, at), at) - grown) : 0.0;
        // Friction may hold it where it does not touch yet what would hold it without.
        if (friction.static_coefficient > 0 && touch.touching)
            for (const uint32_t face : exact.near(at, grown + 0.01 * surface.lattice.extent))
                off = std::min(off, std::abs(glm::distance(exact.nearest(face, at), at) - grown));
        const dvec3 sides = (surface.box_maximum_m - surface.box_minimum_m) / surface.lattice.unit_m;
        const bool is_cut = contact->counters().walks_cut > verdict.cut; // it is on its way
        if (!is_cut) verdict.off_surface = std::max(verdict.off_surface, off / std::max({sides.x, sides.y, sides.z}));
        ++verdict.ticks;
        verdict.touching += touch.touching;
        verdict.impossible += !possible;
        verdict.differing += !contact->proxy().touches() && at != target && !is_cut;
        verdict.cut = contact->counters().walks_cut;
        if (possible) continue;
        hand.restart();
        contact->reset();
        contact->update(hand.outside());
    }
    return verdict;
}

Verdict judge(const std::shared_ptr<const Surface>& shared, uint64_t ticks, uint64_t seed, const Friction& friction)
{
    if (!shared->is_clean()) return judge_ball(shared, ticks, seed, friction);
    const Surface& surface = *shared;
    const ExactMesh exact(surface);
    WildHand hand(surface, seed);
    WalkContact contact(shared);
    Stepped stepped(surface);
    Accomplice accomplice(exact, seed);
    const auto start = [&](const dvec3& at_m) {
        contact.reset();
        contact.update(at_m);
        stepped.put(at_m);
        accomplice.put(surface.lattice.snap(at_m));
    };
    start(hand.outside());
    Verdict verdict;
    for (uint64_t i = 0; i < ticks; ++i) {
        const dvec3 at_m = hand.next();
        const Friction coefficients = checked(friction);
        const dvec3 way_m = surface.lattice.metres(surface.lattice.snap(at_m)) - contact.contact().hand_m;
        const bool slides = slides_on({&contact.contact(), 1}, way_m, coefficients);
        const Contact& touch = contact.update(at_m, friction);
        const bool possible = stepped.tick(at_m, coefficients, slides, [&](const Proxy& proxy) {
            ++verdict.steps;
            verdict.off_surface = std::max(verdict.off_surface, off_surface(surface, exact, proxy));
            return accomplice.follow(proxy);
        });
        const Proxy& proxy = stepped.proxy();
        const bool differs = touch.touching != (proxy.on != Proxy::On::nothing) ||
                             touch.proxy_m != surface.lattice.metres(proxy.at) ||
                             (touch.touching && (touch.face != proxy.face || touch.side != proxy.side));
        ++verdict.ticks;
        verdict.touching += touch.touching;
        verdict.impossible += !possible;
        verdict.stuck += possible && touch.touching && friction.static_coefficient == 0 &&
                         accomplice.could_go_nearer(stepped.proxy(), surface.lattice.snap(at_m));
        verdict.differing += possible && differs;
        if (possible && !differs) continue;
        hand.restart();
        start(hand.outside());
    }
    verdict.cut = contact.counters().walks_cut;
    verdict.detours = accomplice.detours;
    verdict.sideless = accomplice.sideless;
    return verdict;
}

} // namespace

TEST_CASE("every step of the proxy is possible, on any mesh")
{
    std::vector<NamedMesh> meshes = make_hard_meshes();
    meshes.push_back({"star", make_star(2)});
    meshes.push_back({"plate 2e-6", make_box({1, 1, 2e-6})});
    meshes.push_back({"plate 2e-10", make_box({1, 1, 2e-10})});
    meshes.push_back({"stairs", make_stairs()});
    // Where hands often lie just between two points of the lattice.
    meshes.push_back({"stairs, far away", far_away(make_stairs())});
    meshes.push_back({"cubes sharing corners", make_touching_cubes(Touching::corners)});
    for (const auto& [name, mesh] : meshes)
        for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}, grained_aslant}) {
            const auto surface = surface_of(mesh);
            const Verdict verdict = judge(surface, is_sanitized ? 200 : 1000, 17, friction);
            CAPTURE(name, friction.static_coefficient, friction.grain.is_there, verdict);
            CHECK(verdict.impossible == 0);
            CHECK(verdict.differing == 0);
            CHECK(verdict.cut <= (surface->is_clean() ? 0u : 1u)); // a ball: after a jump, in a thousand ticks
            // Where a border meets a wall the proxy holds on to the border.
            CHECK(verdict.stuck <= (name.starts_with("soup") ? verdict.touching / 50 : 0));
            CHECK(verdict.touching > (is_sanitized ? 5u : 25u));
            CHECK(verdict.off_surface < 1e-9);
        }
}

TEST_CASE("in corners of three sheets nearly in one plane, and on the ridges of walls, the proxy goes on")
{
    for (const auto& [name, mesh] : make_hard_meshes()) {
        if (name != "stars that pierce each other" && name != "balls that cross in a vertex") continue;
        const Verdict verdict = judge(surface_of(mesh), 4000, 8, {});
        CAPTURE(name, verdict);
        CHECK(verdict.impossible == 0);
        CHECK(verdict.stuck <= 1); // once in a while it goes round in circles until it has turned too often
    }
}

// HAPTEL_TEST_MESHES: files to be touched too, with ':' between; HAPTEL_TEST_TICKS: for each mesh and each friction;
// HAPTEL_TEST_SEED.
TEST_CASE("every step of the proxy is possible, on any mesh: long run", "[.long]")
{
    std::vector<NamedMesh> meshes = make_hard_meshes();
    for (NamedMesh& read : meshes_of_environment()) meshes.push_back(std::move(read));
    const uint64_t ticks = number_of_environment("HAPTEL_TEST_TICKS", 100000),
                   seed = number_of_environment("HAPTEL_TEST_SEED", 1);
    Verdict sum;
    for (const auto& [name, mesh] : meshes) {
        const auto surface = surface_of(mesh);
        for (const Friction& friction : {Friction{}, Friction{0.3, 0.2}, grained_aslant}) {
            const Verdict verdict = judge(surface, ticks, seed, friction);
            std::cerr << name << ": " << verdict << std::endl;
            sum += verdict;
        }
    }
    WARN("in all " << sum);
    CHECK(sum.impossible == 0);
    CHECK(sum.differing == 0);
    CHECK(sum.cut < sum.touching / 200); // balls, after jumps
    CHECK(sum.stuck < sum.touching / 1000);
    CHECK(sum.off_surface < 1e-8);
}

TEST_CASE("of a hand far outside it is the straight way that counts, not the way between clamped places")
{
    // A plate of side 1: its workspace ends 4 m from the middle.
    const auto surface = surface_of(make_plane(3));
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int through_the_plate = 0, past_it = 0;
    for (int i = 0; i < 3000; ++i) {
        const dvec3 to(0.45 * uniform(random), 0.45 * uniform(random), -std::pow(10, 0.5 + uniform(random)));
        const double far = std::pow(10, 2 + 2 * uniform(random));
        const dvec3 from(far * uniform(random), far * uniform(random), std::pow(10, 1 + 2 * uniform(random)));
        const dvec3 on_plane = to + to.z / (to.z - from.z) * (from - to);
        const double outside = std::max(std::abs(on_plane.x), std::abs(on_plane.y)) - 0.5;
        if (std::abs(outside) < 1e-6) continue;
        WalkContact point(surface);
        point.update(from);
        const Contact& touch = point.update(to);
        CAPTURE(i, from.x, from.y, from.z, to.x, to.y, to.z);
        REQUIRE(touch.touching == (outside < 0));
        (outside < 0 ? through_the_plate : past_it) += 1;
        if (outside > 0) continue;
        REQUIRE(touch.side == 0);
        REQUIRE(glm::length(touch.proxy_m - dvec3(to.x, to.y, 0)) < 1e-9);
        // It stays in contact however far the hand goes down, and is let go above.
        REQUIRE(point.update({to.x, to.y, -1e9}).touching);
        REQUIRE(point.contact().depth_m < 4.1);
        REQUIRE_FALSE(point.update({to.x, to.y, 1e9}).touching);

        // A stylus put down with its tail far away touches where its shaft enters.
        StylusContact stylus(surface);
        REQUIRE(stylus.update({to.x, to.y, -0.1}, from).touching ==
                (std::max(std::abs(to.x + 0.1 / (0.1 + from.z) * (from.x - to.x)),
                          std::abs(to.y + 0.1 / (0.1 + from.z) * (from.y - to.y))) < 0.5));
    }
    CHECK(through_the_plate > 300);
    CHECK(past_it > 300);
}
