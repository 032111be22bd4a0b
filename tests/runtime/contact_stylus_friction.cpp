// A stylus in a crease: friction holds its tip beside an edge on which its shaft leans, by a lever of a hundredth of
// its length. What it costs is counted, what it feels checked against the balance of a stiff shaft.
#include "runtime/joined_surfaces.h"
#include "runtime/shapes.h"
#include "runtime/stylus_contact.h"

#include "tests/runtime/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
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
    const std::vector<PlacedSurface> parts{{surface_of(ball), {}},
                                           {surface_of(box), {glm::dmat3(1), dvec3(0.03, 0, 0.02)}}};
    const std::vector<uint32_t> numbers{0, 1};
    SurfaceResult joined = join(parts, numbers);
    REQUIRE(joined.surface);
    return joined.surface;
}

struct Work {
    uint64_t sweeps = 0; // 99th percentile over the ticks
    uint64_t cut = 0;    // ticks in which ends and shaft did not come to agree
    int by_shaft = 0;    // ticks
};

// To and fro over the seam of the ball with the wall of the box, at 60 mm/s and less, up to 5 mm deep.
Work stroke(const std::shared_ptr<const Surface>& surface, bool tail_first)
{
    StylusContact stylus(surface);
    std::vector<uint64_t> sweeps;
    Work work;
    for (int i = 0; i < 6000; ++i) {
        const double t = 1e-3 * i;
        const dvec3 tip(0.012 * std::sin(4.7 * t), 0.015 * std::sin(3.1 * t), 0.0495 + 0.003 * std::cos(1.3 * t));
        const uint64_t before = stylus.counters().sweeps;
        tail_first ? stylus.update(tip + to_tail, tip, rough) : stylus.update(tip, tip + to_tail, rough);
        sweeps.push_back(stylus.counters().sweeps - before);
        work.by_shaft += std::ranges::any_of(stylus.contacts(), &Contact::by_shaft);
    }
    std::ranges::sort(sweeps);
    work.sweeps = sweeps[sweeps.size() * 99 / 100];
    work.cut = stylus.counters().walks_cut;
    return work;
}

} // namespace

TEST_CASE("a stylus that friction wedges into the seam of joined objects costs a tick hardly more than elsewhere")
{
    const auto surface = ball_and_box();
    for (const bool tail_first : {false, true}) {
        const Work work = stroke(surface, tail_first);
        CAPTURE(tail_first, work.sweeps, work.cut, work.by_shaft);
        CHECK(work.by_shaft > 1000);
        CHECK(work.sweeps <= 8);
        CHECK(work.cut <= 6); // a thousandth of the ticks
    }
}

TEST_CASE("a stylus wedged into a seam is in balance: the free tail bears the edge, the tip what friction can")
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
        if (!stylus.ideal() || contacts.size() != 2 || !contacts[0].touching || !contacts[1].by_shaft) continue;
        if (contacts[1].depth_m < 1e-4 || contacts[1].along < 1e-3) continue; // a lever of 0.15 mm
        ++wedged;
        const Contact& edge = contacts[1];
        const dvec3 ideal_tail = stylus.surface().lattice.metres(stylus.ideal()->tail);
        const dvec3 borne = edge.along * edge.depth_m * edge.normal;
        const double error = glm::distance(ideal_tail - tail, borne) / glm::length(ideal_tail - tip);
        worst = std::max(worst, error);
        const double across = glm::length(contacts[0].lag_m);
        off += across > rough.static_coefficient * contacts[0].depth_m + 1e-9;
    }
    CAPTURE(wedged, worst, off);
    CHECK(wedged > 1500);
    CHECK(worst < 1e-3); // of the length: where the tail is seen, which bears next to nothing
    CHECK(off == 0);
}
