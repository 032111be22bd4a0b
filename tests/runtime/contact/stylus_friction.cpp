// A stylus in a crease: friction holds its tip beside an edge on which its shaft leans, by a lever of a hundredth of
// its length. What it costs is counted; what it feels is checked against the balance of a stiff shaft, Coulomb's law,
// and what friction does to energy: it only takes.
#include "runtime/contact/stylus_friction.h"
#include "runtime/contact/project.h"
#include "runtime/contact/stylus_contact.h"
#include "runtime/surface/build/joined_surfaces.h"
#include "runtime/surface/shapes.h"

#include "tests/runtime/contact/ends.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

const Friction rough{0.3, 0.2};
const dvec3 to_tail(0, -0.036380343755, 0.145521375022); // 150 mm

std::shared_ptr<const Surface> ball_and_box()
{
    Mesh ball = make_icosphere(5), box = make_box();
    scale_to_size(ball, 0.1);
    scale_to_size(box, 0.06);
    const std::vector<PlacedSurface> parts{
        {surface_of(ball), {}},
        {surface_of(box), {glm::dmat3(1), dvec3(0.03, 0, 0.0205)}}}; // half a millimetre above its top
    const std::vector<uint32_t> numbers{0, 1};
    SurfaceResult joined = join(parts, numbers);
    REQUIRE(joined.surface);
    return joined.surface;
}

// Of springs of 1 N/m: in metres.
Ends force_on_ends(const StylusContact& stylus)
{
    Ends sum;
    for (const Contact& contact : stylus.contacts()) {
        const dvec3 force = contact.depth_m * contact.normal + contact.lag_m;
        sum.tip += (1 - contact.along) * force;
        sum.tail += contact.along * force;
    }
    return sum;
}

// By how much the hand with the force on it is not where the ideal stylus is; but for its radius, which is not felt.
double unbalanced_m(const StylusContact& stylus, const dvec3& tip, const dvec3& tail)
{
    const Ends force = force_on_ends(stylus);
    const Lattice& lattice = stylus.surface().lattice;
    const double unfelt_m = 1.5 * Lattice::point_radius * lattice.unit_m; // of three contacts that it rests on
    return std::max(glm::distance(lattice.metres(stylus.ideal()->tip), tip + force.tip),
                    glm::distance(lattice.metres(stylus.ideal()->tail), tail + force.tail)) -
           unfelt_m;
}

bool within_friction(const StylusContact& stylus, const Friction& friction)
{
    return std::ranges::all_of(stylus.contacts(), [&](const Contact& contact) {
        return glm::length(contact.lag_m) <= friction.static_coefficient * contact.depth_m + 1e-9;
    });
}

struct Work {
    uint64_t sweeps = 0;               // 99th percentile over the ticks, those around the ends included
    uint64_t cut = 0;                  // ticks in which ends and shaft did not come to agree
    int by_shaft = 0;                  // ticks
    double given_m2 = 0, taken_m2 = 0; // in ticks that gave the hand energy, and in those that took some
};

// To and fro over the seam of the ball with the wall of the box, at 60 mm/s and less, up to 5 mm deep. What a tick
// gives is the work on the hand less what the springs lost: the mean force times the way of where they are held.
Work stroke(const std::shared_ptr<const Surface>& surface, bool tail_first)
{
    StylusContact stylus(surface);
    std::vector<uint64_t> sweeps;
    Work work;
    Ends before, held_before;
    for (int i = 0; i < 6000; ++i) {
        const double t = 1e-3 * i;
        Ends hand;
        hand.tip = dvec3(0.012 * std::sin(4.7 * t), 0.015 * std::sin(3.1 * t), 0.0495 + 0.003 * std::cos(1.3 * t));
        hand.tail = hand.tip + to_tail;
        if (tail_first) std::swap(hand.tip, hand.tail);
        const uint64_t swept = stylus.counters().sweeps;
        stylus.update(hand.tip, hand.tail, rough);
        sweeps.push_back(stylus.counters().sweeps - swept);
        work.by_shaft += std::ranges::any_of(stylus.contacts(), &Contact::by_shaft);
        const Ends force = force_on_ends(stylus), held{hand.tip + force.tip, hand.tail + force.tail};
        const double given = 0.5 * (glm::dot(force.tip + before.tip, held.tip - held_before.tip) +
                                    glm::dot(force.tail + before.tail, held.tail - held_before.tail));
        if (i > 0) (given > 0 ? work.given_m2 : work.taken_m2) += std::fabs(given);
        before = force, held_before = held;
    }
    std::ranges::sort(sweeps);
    work.sweeps = sweeps[sweeps.size() * 99 / 100];
    work.cut = stylus.counters().walks_cut;
    return work;
}

} // namespace

TEST_CASE("a stylus that friction wedges into a seam costs hardly more than elsewhere, and friction only takes energy")
{
    const auto surface = ball_and_box();
    for (const bool tail_first : {false, true}) {
        const Work work = stroke(surface, tail_first);
        CAPTURE(tail_first, work.sweeps, work.cut, work.by_shaft, work.given_m2, work.taken_m2);
        CHECK(work.by_shaft > 1000);
        CHECK(work.sweeps <= 12);
        CHECK(work.cut <= 6); // a thousandth of the ticks
        CHECK(work.taken_m2 > 1e-6);
        CHECK(work.given_m2 < 0.01 * work.taken_m2);
    }
}

TEST_CASE("a stylus wedged into a seam is in balance: what pushes it holds it where it is")
{
    StylusContact stylus(ball_and_box());
    int wedged = 0, off = 0;
    double worst = 0;
    for (int i = 0; i < 4000; ++i) { // down beside the wall and against it, along it and back
        const double t = 1e-3 * i;
        const dvec3 tip(-0.004 + 0.004 * std::min(t, 3.0), 0.01 * std::sin(2 * t), 0.0485 - 0.001 * std::sin(t));
        const dvec3 tail = tip + to_tail;
        stylus.update(tip, tail, rough);
        const auto contacts = stylus.contacts();
        const auto of_tip = std::ranges::count(contacts, false, &Contact::by_shaft);
        if (!stylus.ideal() || of_tip == 0 || contacts.size() != std::size_t(of_tip) + 1) continue;
        ++wedged;
        worst = std::max(worst, unbalanced_m(stylus, tip, tail));
        off += !within_friction(stylus, rough);
    }
    CAPTURE(wedged, worst, off);
    CHECK(wedged > 2000);
    CHECK(stylus.counters().walks_cut == 0);
    CHECK(worst < 1e-6); // of depths of some 5 mm, on levers down to nothing
    CHECK(off == 0);
}

TEST_CASE("a stylus with both ends held by walls and its shaft on an edge between them is in balance")
{
    // Walls across x at -0.1 and 0.1, which face each other, and an edge along y at the height 0 in the middle.
    Mesh mesh;
    const auto rectangle = [&](const dvec3& corner, const dvec3& one, const dvec3& other) {
        const auto first = uint32_t(mesh.positions_m.size());
        for (const dvec3& p : {corner, corner + one, corner + one + other, corner + other})
            mesh.positions_m.push_back(p);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    };
    const dvec3 y(0, 0.6, 0), z(0, 0, 0.6);
    rectangle({-0.1, -0.3, -0.3}, y, z);
    rectangle({0.1, -0.3, -0.3}, z, y);
    rectangle({0, -0.3, 0}, y, {0, 0, -0.05});
    const auto surface = surface_of(mesh);
    for (const double tilt : {0.0, 0.004, -0.01})
        for (const double along : {0.0, 0.02}) {
            StylusContact stylus(surface);
            int both = 0, off = 0;
            uint64_t cut = 0;
            double worst = 0;
            for (int i = 0; i < 3000; ++i) { // down onto the edge, rocking on it, up again
                const double t = 1e-3 * i, down = 0.008 * std::sin(t) - 0.002;
                const double rock = tilt * std::sin(5 * t), out = 0.1 + 0.004 * std::min(1.0, 5 * t);
                const dvec3 tip(-out, along * t, -down + rock), tail(out, along * t, -down - rock);
                if (i == 0) stylus.update(0.5 * tip + dvec3(0, 0, 0.01), 0.5 * tail + dvec3(0, 0, 0.01), rough);
                stylus.update(tip, tail, rough);
                const auto contacts = stylus.contacts();
                const uint64_t cut_before = std::exchange(cut, stylus.counters().walks_cut);
                if (contacts.size() < 3 || cut != cut_before) continue;
                REQUIRE(stylus.ideal());
                ++both;
                worst = std::max(worst, unbalanced_m(stylus, tip, tail));
                off += !within_friction(stylus, rough);
            }
            CAPTURE(tilt, along, both, cut, worst, off);
            CHECK(both > 1000);
            CHECK(cut == 0);
            CHECK(worst < 1e-6); // of depths of some 5 mm
            CHECK(off == 0);
        }
}

TEST_CASE("friction on an end follows Coulomb's law, however the shaft makes it give")
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    int stuck = 0, slipped = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        EndFriction end_friction;
        end_friction.friction = {0.5, 0.4};
        end_friction.touches = end_friction.slides = true;
        end_friction.normal = glm::normalize(any());
        end_friction.take_hold(false);
        const double depth = 1e9;
        // What gives is a projection, here along one direction, two or three; a little rest stands for a short lever.
        glm::dmat3 give(0);
        const dvec3 one = glm::normalize(any()), two = glm::normalize(glm::cross(one, any()));
        give += glm::outerProduct(one, one);
        if (trial % 3 > 0) give += glm::outerProduct(two, two);
        if (trial % 3 > 1) give = glm::dmat3(1);
        if (trial % 2) give += 1e-6 * glm::dmat3(1);
        const dvec3 way = give * (1e9 * any());
        const dvec3 aim = end_friction.at - depth * end_friction.normal;
        double change = 1;
        for (int turn = 0; turn < 20 && change > 1e-9; ++turn)
            change = end_friction.follow(aim, end_friction.at + way + give * end_friction.lag, give);
        const dvec3 moved = way + give * end_friction.lag,
                    across = moved - glm::dot(moved, end_friction.normal) * end_friction.normal;
        const double length = glm::length(end_friction.lag), most = 0.4 * depth;
        CAPTURE(trial, change, length, glm::length(across));
        REQUIRE(change < 1e-6);
        REQUIRE(std::fabs(glm::dot(end_friction.lag, end_friction.normal)) < 1e-6 * most);
        REQUIRE(length < most * (1 + 1e-9));
        if (end_friction.moves) { // against the slip, and all of it
            REQUIRE(length > most * (1 - 1e-9));
            REQUIRE(glm::distance(across, -glm::length(across) / length * end_friction.lag) < 1e-6 * depth);
        } else {
            REQUIRE(glm::length(across) < 1e-6 * depth);
        }
        ++(end_friction.moves ? slipped : stuck);
    }
    CHECK(stuck > 300);
    CHECK(slipped > 300);
}

TEST_CASE("how an end gives is how it moves by a small pull")
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    int compared = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<ShaftRow> rows(1 + random() % 4);
        for (ShaftRow& row : rows) row = {glm::normalize(any()), 1e9 * u(random), 0.5 * (1 + u(random))};
        const Shaft hand{1e9 * any(), 1e9 * any()};
        const EndsGive gives{trial % 3 != 1, trial % 3 != 2};
        const dvec3 pull = 1e3 * any();
        const bool tip = gives.tip;
        const auto at = project(rows, hand, 1e-3, gives);
        const auto there =
            project(rows, {hand.tip + (tip ? pull : dvec3(0)), hand.tail + (tip ? dvec3(0) : pull)}, 1e-3, gives);
        const bool same = std::is_permutation(at.active.begin(), at.active.begin() + at.count, there.active.begin(),
                                              there.active.begin() + there.count);
        if (!same || *std::ranges::max_element(at.push) > 1e12) continue; // of contacts that hardly differ
        ++compared;
        const dvec3 by_pull = compliance(tip ? ShaftEnd::tip : ShaftEnd::tail, rows, at, gives) * pull;
        const dvec3 moved = tip ? there.at.tip - at.at.tip : there.at.tail - at.at.tail;
        CAPTURE(trial, rows.size(), gives.tip, gives.tail);
        REQUIRE(glm::distance(moved, by_pull) < 1e-3 * glm::length(pull));
    }
    CHECK(compared > 1000);
}

// Coulomb's law, with the depth cut to what lies between an object and the border of its workspace: beyond that no
// place could be aimed at.
TEST_CASE("an end that is jammed bears as much as its workspace is deep, and slips from there on")
{
    constexpr double deepest = Lattice::workspace - Lattice::extent;
    const dvec3 normal(0, 0, 1);
    const auto end_that_sticks = [&] {
        EndFriction end;
        end.friction = {0.5, 0.25};
        end.touches = true;
        end.normal = normal;
        end.take_hold(true);
        return end;
    };
    for (const double height : {1.0, 0.4 * deepest, 0.999 * deepest}) {
        EndFriction end = end_that_sticks();
        const dvec3 drawn = 0.4 * height * dvec3(0.6, 0.8, 0);
        CHECK(end.follow(drawn - height * normal, dvec3(0), glm::dmat3(1)) == 0);
        CHECK((end.sticks && glm::distance(end.lag, -drawn) <= 1e-12 * height));
    }
    for (const double height : {1.001 * deepest, 40 * deepest, 1e30}) {
        EndFriction end = end_that_sticks(); // and hardly drawn: it is the depth that it cannot bear
        const dvec3 aim = dvec3(1, 0, 0) - height * normal;
        CHECK(end.follow(aim, dvec3(0), glm::dmat3(1)) == HUGE_VAL);
        CHECK((!end.sticks && end.slides));
        for (int turn = 0; turn < 20; ++turn) { // against the way that it slips, by all that it may from the first on
            end.take_hold(true);
            CHECK_FALSE(end.sticks);
            end.follow(aim, dvec3(deepest, 0, 0), glm::dmat3(1));
            CHECK(glm::distance(end.lag, dvec3(-0.25 * deepest, 0, 0)) < 1e-9 * deepest);
        }
    }
}
