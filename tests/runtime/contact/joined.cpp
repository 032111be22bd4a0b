// Objects at rest that meet, as one surface: what is felt of them together, against closed forms of their union.
#include "runtime/contact/end_contact.h"
#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/build/joined_surfaces.h"
#include "runtime/surface/shapes.h"

#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

glm::dmat3 turned(const dvec3& axis, double radians)
{
    const dvec3 a = glm::normalize(axis);
    const double c = std::cos(radians), s = std::sin(radians);
    const glm::dmat3 cross(dvec3(0, a.z, -a.y), dvec3(-a.z, 0, a.x), dvec3(a.y, -a.x, 0));
    return c * glm::dmat3(1) + (1 - c) * glm::outerProduct(a, a) + s * cross;
}

PlacedSurface placed(const Mesh& mesh, const dvec3& position_m, const glm::dmat3& rotation = glm::dmat3(1))
{
    return {surface_of(mesh), {rotation, position_m}};
}

SurfaceResult join_all(const std::vector<PlacedSurface>& surfaces)
{
    const std::vector<MeetingSurfaces> meeting = find_meeting(surfaces);
    REQUIRE(meeting.size() == 1);
    REQUIRE(meeting[0].numbers.size() == surfaces.size());
    SurfaceResult joined = join(surfaces, meeting[0].numbers);
    REQUIRE(joined.surface);
    return joined;
}

Mesh ball(double diameter_m, uint32_t subdivisions = 3)
{
    Mesh mesh = make_icosphere(subdivisions);
    scale_to_size(mesh, diameter_m);
    return mesh;
}

} // namespace

TEST_CASE("joined: only what meets, nested and parted objects stay apart")
{
    const auto meets = [](const std::vector<PlacedSurface>& surfaces) {
        std::vector<std::vector<uint32_t>> groups;
        for (const MeetingSurfaces& group : find_meeting(surfaces)) groups.push_back(group.numbers);
        return groups;
    };
    const Mesh box = make_box();
    using Groups = std::vector<std::vector<uint32_t>>;
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {1, 0, 0})}) == Groups{{0, 1}});             // face to face
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {1, 0.3, 0.2})}) == Groups{{0, 1}});         // shifted
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {1, 1, 0})}) == Groups{{0, 1}});             // edge to edge
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {1.001, 0, 0})}).empty());                   // a gap of a mm
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {1.00001, 0, 0})}) == Groups{{0, 1}});       // a slit of 10 um
    CHECK(meets({placed(box, {0, 0, 0}), placed(make_box({0.5, 0.5, 0.5}), {0, 0, 0})}).empty()); // nested
    CHECK(meets({placed(box, {0, 0, 0}), placed(make_box({0.5, 0.5, 0.5}), {0, 0, 0.25})}) == Groups{{0, 1}});
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {5, 0, 0}), placed(box, {1, 0, 0}), placed(box, {5, 1, 0})}) ==
          Groups{{0, 2}, {1, 3}});
    CHECK(meets({placed(ball(1), {0, 0, 0}), placed(ball(1), {0.9, 0.1, 0})}) == Groups{{0, 1}});
    CHECK(meets({placed(ball(1), {0, 0, 0}), placed(ball(0.8), {0, 0, 0})}).empty());
}

TEST_CASE("joined: every face of every part is there, where it was, but for those that lie in one place")
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto direction = [&] { return dvec3(any(random), any(random), any(random)); };
    const auto on_grid = [&] { return glm::round(4.0 * direction()) / 4.0; };
    int joined_count = 0;
    for (int trial = 0; trial < tries(120); ++trial) {
        const Mesh meshes[] = {make_box(), ball(1), make_torus(0.4, 32, 12), ball(0.7, 2), make_box({0.5, 0.25, 0.75})};
        std::vector<PlacedSurface> surfaces;
        const bool boxes = trial % 2 == 1; // face to face, most of them
        for (int k = 0; k < 2 + trial / 2 % 3; ++k) {
            const Mesh& mesh = meshes[boxes ? random() % 2 * 4 : random() % 5];
            const dvec3 position = boxes ? on_grid() : 0.4 * direction();
            surfaces.push_back(placed(mesh, position, boxes ? glm::dmat3(1) : turned(direction(), 3 * any(random))));
        }
        for (const MeetingSurfaces& group : find_meeting(surfaces)) {
            CAPTURE(trial, group.numbers.size());
            const SurfaceResult joined = join(surfaces, group.numbers);
            REQUIRE(joined.surface);
            const Surface& surface = *joined.surface;
            ++joined_count;
            CHECK_FALSE(surface.is_clean());
            CHECK(joined.report.border_edges == 0);
            size_t faces = 0;
            for (const uint32_t number : group.numbers) faces += surfaces[number].surface->faces.size();
            CHECK(joined.report.triangles_given == faces);
            CHECK(surface.faces.size() + joined.report.duplicate == faces);
            CHECK((boxes || joined.report.duplicate == 0));
            REQUIRE(surface.origins.size() == surface.faces.size());
            double farthest = 0;
            for (uint32_t f = 0; f < surface.faces.size(); ++f) {
                const Origin& origin = surface.origins[f];
                const PlacedSurface& own = surfaces[group.numbers[origin.part]];
                for (uint32_t i = 0; i < 3; ++i)
                    farthest = std::max(farthest,
                                        glm::distance(surface.vertex_m(f, i),
                                                      own.placement.to_world(own.surface->vertex_m(origin.face, i))));
            }
            CHECK(farthest < 1e-9); // of objects of a metre: the lattice
        }
    }
    CHECK(joined_count > tries(80));
}

TEST_CASE("joined: two sheets of strips across each other, of which each edge of one crosses each edge of the other")
{
    Mesh strips;
    const uint32_t count = 600;
    for (uint32_t i = 0; i <= count; ++i)
        for (double y : {0.0, 1.0}) strips.positions_m.emplace_back(double(i) / count, y, 0);
    for (uint32_t i = 0; i < count; ++i) {
        strips.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        strips.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    const SurfaceResult joined =
        join_all({placed(strips, {0, 0, 0}), placed(strips, {1, 0, 0}, turned({0, 0, 1}, 0.5 * 3.14159265358979))});
    CHECK(joined.surface->faces.size() == 4 * count);
    const auto point = make_point(joined.surface);
    point->update({0.5, 0.5, 0.1});
    const Contact& felt = point->update({0.503, 0.502, -0.01});
    REQUIRE(felt.touching);
    CHECK(glm::distance(felt.proxy_m, dvec3(0.503, 0.502, 0)) < 1e-8);
}

TEST_CASE("joined: the seam between two boxes is not felt")
{
    const glm::dmat3 turns[] = {glm::dmat3(1), turned({1, 2, 3}, 0.7)};
    for (const glm::dmat3& turn : turns)
        for (const dvec3& sides : {dvec3(1, 1, 1), dvec3(1, 0.6, 1), dvec3(0.7, 1.5, 0.3)})
            for (double shift : {0.0, 0.1, 0.37}) {
                const dvec3 position(0.5 + 0.5 * sides.x, shift, 0.5 - 0.5 * sides.z);
                const SurfaceResult joined = join_all(
                    {placed(make_box(), turn * dvec3(0), turn), placed(make_box(sides), turn * position, turn)});
                CAPTURE(sides.x, sides.y, sides.z, shift);
                for (double heading : {0.0, 0.2, 3.14159265358979, 3.4}) {
                    const auto point = make_point(joined.surface);
                    EndContact& contact = *point;
                    const dvec3 along(std::cos(heading), std::sin(heading), 0);
                    for (int tick = 0; tick <= 400; ++tick) {
                        dvec3 hand = dvec3(0.5, 0.2, 0.5) + (-0.3 + 0.6 * tick / 400) * along;
                        hand.z = tick == 0 ? 0.6 : 0.47;
                        const Contact& felt = contact.update(turn * hand);
                        if (tick == 0) continue;
                        const dvec3 foot = turn * dvec3(hand.x, hand.y, 0.5);
                        REQUIRE(felt.touching);
                        if (glm::distance(felt.proxy_m, foot) > 1e-6) {
                            CAPTURE(tick, heading);
                            REQUIRE(glm::distance(felt.proxy_m, foot) <= 1e-6);
                        }
                    }
                }
            }
}

TEST_CASE("joined: in a slit that is narrower than the ball that a point is it sinks only a little")
{
    const double slit_m = 1e-5; // between boxes of a metre
    const SurfaceResult joined = join_all({placed(make_box(), {0, 0, 0}), placed(make_box(), {1 + slit_m, 0.1, 0})});
    const Lattice& lattice = joined.surface->lattice;
    REQUIRE(slit_m < 2 * Lattice::point_radius * lattice.unit_m);
    for (const double step_m : {1e-3, 1e-6}) {
        const auto point = make_point(joined.surface);
        point->update({0.4, 0.2, 0.6});
        double highest_m = 0, worst_m = 0;
        for (int tick = 0; tick <= 200; ++tick) { // 30 mm deep, over the slit and back
            const dvec3 hand(0.5 + 0.5 * slit_m + step_m * (tick < 100 ? tick - 50 : 150 - tick), 0.2, 0.47);
            point->update(hand);
            const dvec3 at = lattice.metres(point->proxy().at);
            highest_m = std::max(highest_m, std::abs(at.z - 0.5) / lattice.unit_m / Lattice::point_radius);
            worst_m = std::max(worst_m, std::abs(at.x - hand.x));
        }
        CAPTURE(step_m, highest_m, worst_m);
        CHECK(highest_m < 1 + 1e-6); // radii: it sinks in a little, and comes out
        // Out of the slit it climbs over an edge as steep as this.
        const double radius_m = Lattice::point_radius * lattice.unit_m, half_m = 0.5 * slit_m;
        CHECK(worst_m < 1.05 * 0.03 * half_m / std::sqrt(radius_m * radius_m - half_m * half_m) + step_m);
    }
}

TEST_CASE("joined: the proxy stays out of both objects and no farther from the hand than it must")
{
    // A ball half sunk into a box, and a slab that leans on both. Nearest point of the union of two solids: by search.
    const std::vector<PlacedSurface> surfaces = {placed(make_box({2, 2, 1}), {0, 0, -0.5}),
                                                 placed(ball(1, 5), {0, 0, 0.1})};
    const SurfaceResult joined = join_all(surfaces);
    const auto point = make_point(joined.surface);
    EndContact& contact = *point;
    std::mt19937_64 random(3);
    std::normal_distribution<double> any(0, 1);
    dvec3 hand(0.8, 0, 0.6);
    int creases = 0, touching = 0;
    double worst_box = 0, worst_ball = 0;
    for (int tick = 0; tick < 40000; ++tick) {
        const dvec3 goal = 0.75 * dvec3(std::cos(0.001 * tick), std::sin(0.0013 * tick), 0) + dvec3(0, 0, -0.08);
        hand += 0.02 * (goal - hand) + 0.002 * dvec3(any(random), any(random), any(random));
        const Contact& felt = contact.update(hand);
        if (!felt.touching) continue;
        ++touching;
        const dvec3 x = felt.proxy_m;
        worst_box = std::max(worst_box, std::min({1 - std::abs(x.x), 1 - std::abs(x.y), -x.z}));
        // The icosphere lies inside the ball, by at most the height of a cap over a facet.
        worst_ball = std::max(worst_ball, 0.5 - glm::distance(x, dvec3(0, 0, 0.1)));
        creases += x.z < 1e-4 && glm::distance(x, dvec3(0, 0, 0.1)) < 0.5005;
    }
    CAPTURE(touching, creases);
    CHECK(touching > 20000);
    CHECK(creases > 1000);
    CHECK(worst_box < 1e-6);
    CHECK(worst_ball < 6e-4);
}

TEST_CASE("joined: no hand gets inside, however it wanders and jumps, and from where the boxes' edges are")
{
    enum class Hand { wanders, jumps, on_features };
    struct Box {
        dvec3 centre, sides;
    };
    const std::vector<std::vector<Box>> scenes = {
        {{{0, 0, 0}, {1, 1, 1}}, {{1, 0.3, 0}, {1, 1, 1}}, {{0.5, 0.1, 0.75}, {0.6, 0.5, 0.5}}},
        {{{0, 0, 0}, {1, 1, 0.2}}, {{1, 0, 0}, {1, 1, 0.2}}, {{0.3, 1, 0}, {1, 1, 0.2}}, {{1.3, 1, 0}, {1, 1, 0.2}}},
        {{{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.5, 0.5}, {1, 1, 1}}},
        {{{0, 0, 0}, {2, 2, 1}}, {{0, 0, 0.75}, {0.5, 0.5, 0.5}}},
        {{{0, 0, 0}, {1, 1, 1}}, {{1, 0.25, 0}, {1, 1, 1}}}};
    long touching = 0;
    for (uint32_t seed = 0; seed < 5; ++seed)
        for (const std::vector<Box>& boxes : scenes)
            for (const Hand manner : {Hand::wanders, Hand::jumps, Hand::on_features}) {
                std::mt19937_64 random(seed + 1);
                std::normal_distribution<double> normal(0, 1);
                std::uniform_real_distribution<double> any(-1, 1);
                const auto direction = [&] { return dvec3(normal(random), normal(random), normal(random)); };
                const glm::dmat3 turn = seed == 0 ? glm::dmat3(1) : turned(direction(), 3 * any(random));
                std::vector<PlacedSurface> surfaces;
                for (const Box& box : boxes) surfaces.push_back(placed(make_box(box.sides), turn * box.centre, turn));
                // On a corner, an edge or a side of a box, as exactly as numbers have it, or a little beside it.
                const auto on_feature = [&] {
                    const Box& box = boxes[random() % boxes.size()];
                    dvec3 at;
                    for (int i = 0; i < 3; ++i) {
                        const uint64_t end = random() % 3; // one of two, or between
                        at[i] = 0.5 * box.sides[i] * (end == 2 ? any(random) : end == 1 ? 1.0 : -1.0);
                    }
                    return box.centre + at + (random() % 2 ? 0.0 : 0.003) * direction();
                };
                const SurfaceResult joined = join_all(surfaces);
                const auto point = make_point(joined.surface);
                EndContact& contact = *point;
                dvec3 hand(0.5, 0.5, 2.5);
                contact.update(turn * hand);
                double deepest = 0;
                for (int tick = 0; tick < tries(10000); ++tick) {
                    const dvec3 goal = {0.6 + 0.9 * std::cos(0.0007 * tick), 0.5 + 0.9 * std::cos(0.0011 * tick + 1),
                                        0.4 * std::cos(0.0005 * tick)};
                    const bool jumps = manner == Hand::jumps;
                    if (manner == Hand::on_features)
                        hand = on_feature();
                    else if (jumps && tick % 7 == 0)
                        hand = dvec3(0.5, 0.5, 0.2) + 1.3 * dvec3(any(random), any(random), any(random));
                    else
                        hand += (jumps ? 0.0 : 0.02) * (goal - hand) + (jumps ? 0.01 : 0.004) * direction();
                    const Contact& felt = contact.update(turn * hand);
                    touching += felt.touching;
                    dvec3 free = felt.proxy_m; // just beside the proxy, on the side that it claims to be on
                    if (felt.touching) free += 1e-6 * felt.facet_normal;
                    for (const Box& box : boxes) {
                        const dvec3 inside = 0.5 * box.sides - glm::abs(free * turn - box.centre);
                        deepest = std::max(deepest, std::min({inside.x, inside.y, inside.z}));
                    }
                }
                CAPTURE(seed, int(manner), boxes.size());
                CHECK(deepest < 5e-7);
            }
    CHECK(touching > tries(80000));
}
