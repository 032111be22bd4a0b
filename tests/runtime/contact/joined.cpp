// Objects at rest that meet, as one surface: what is felt of them together, against closed forms of their union.
#include "runtime/contact/contact.h"
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
    CHECK(meets({placed(box, {0, 0, 0}), placed(make_box({0.5, 0.5, 0.5}), {0, 0, 0})}).empty()); // nested
    CHECK(meets({placed(box, {0, 0, 0}), placed(make_box({0.5, 0.5, 0.5}), {0, 0, 0.25})}) == Groups{{0, 1}});
    CHECK(meets({placed(box, {0, 0, 0}), placed(box, {5, 0, 0}), placed(box, {1, 0, 0}), placed(box, {5, 1, 0})}) ==
          Groups{{0, 2}, {1, 3}});
    CHECK(meets({placed(ball(1), {0, 0, 0}), placed(ball(1), {0.9, 0.1, 0})}) == Groups{{0, 1}});
    CHECK(meets({placed(ball(1), {0, 0, 0}), placed(ball(0.8), {0, 0, 0})}).empty());
}

TEST_CASE("joined: nothing pierces any more, nothing is open that was closed, and nothing has moved")
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto direction = [&] { return dvec3(any(random), any(random), any(random)); };
    const auto on_grid = [&] { return glm::round(4.0 * direction()) / 4.0; };
    int left = 0, joined_count = 0;
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
            left += joined.report.pierced > 0;
            if (boxes) CHECK(joined.report.pierced == 0);
            CHECK(joined.report.border_edges == 0);

            REQUIRE(surface.origins.size() == surface.faces.size());
            double farthest = 0;
            for (uint32_t f = 0; f < surface.faces.size(); ++f) {
                const Origin& origin = surface.origins[f];
                const PlacedSurface& own = surfaces[group.numbers[origin.part]];
                const auto corner = [&](uint32_t i) {
                    return own.placement.to_world(own.surface->vertex_m(origin.face, i));
                };
                for (uint32_t i = 0; i < 3; ++i) {
                    const dvec3 p = surface.vertex_m(f, i);
                    farthest =
                        std::max(farthest, glm::distance(p, nearest_point(corner(0), corner(1), corner(2), p).at));
                }
            }
            CHECK(farthest < 1e-5); // of objects of a metre
        }
    }
    CAPTURE(joined_count, left);
    CHECK(joined_count > tries(80));
    CHECK(20 * left < joined_count); // where too much comes together within rounding walls hold
}

TEST_CASE("joined: boxes on a grid that is turned come out small, closed, and whole")
{
    // Their coordinates are rounded, so that hardly anything lies quite in one plane, and outlines and diagonals of
    // many cross in the same places.
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto direction = [&] { return dvec3(any(random), any(random), any(random)); };
    const auto steps = [&](int count) {
        const auto one = [&] { return double(random() % uint64_t(count)); };
        return dvec3(one(), one(), one());
    };
    int left = 0, joined_count = 0;
    for (int trial = 0; trial < 150; ++trial) {
        const glm::dmat3 turn = turned(direction(), 3 * any(random));
        std::vector<PlacedSurface> surfaces;
        for (int k = 0; k < 2 + trial % 3; ++k)
            surfaces.push_back(placed(make_box(0.25 * (steps(5) + 1.0)), turn * (0.125 * steps(9)), turn));
        for (const MeetingSurfaces& group : find_meeting(surfaces)) {
            const SurfaceResult joined = join(surfaces, group.numbers);
            REQUIRE(joined.surface);
            CAPTURE(trial, group.numbers.size(), joined.report.pierced);
            ++joined_count;
            left += joined.report.pierced > 0;
            CHECK(joined.report.border_edges == 0);
            CHECK(joined.report.pierced < 100);
            CHECK(joined.surface->faces.size() < 20 * joined.report.triangles_given);

            // Wherever there was a face there is one.
            double farthest = 0;
            for (uint32_t number : group.numbers) {
                const PlacedSurface& own = surfaces[number];
                for (int i = 0; i < 40; ++i) {
                    const uint32_t face = uint32_t(random() % own.surface->faces.size());
                    const double a = 0.5 + 0.5 * any(random), b = (1 - a) * (0.5 + 0.5 * any(random));
                    const dvec3 p =
                        own.placement.to_world((1 - a - b) * own.surface->vertex_m(face, 0) +
                                               a * own.surface->vertex_m(face, 1) + b * own.surface->vertex_m(face, 2));
                    double nearest = 1;
                    const Surface& all = *joined.surface;
                    for (uint32_t f = 0; f < all.faces.size(); ++f)
                        nearest = std::min(
                            nearest,
                            glm::distance(
                                p, nearest_point(all.vertex_m(f, 0), all.vertex_m(f, 1), all.vertex_m(f, 2), p).at));
                    farthest = std::max(farthest, nearest);
                }
            }
            CHECK(farthest < 1e-5);
        }
    }
    CAPTURE(joined_count, left);
    CHECK(joined_count > 100);
    CHECK(20 * left < joined_count);
}

TEST_CASE("joined: what would take too long is left as it is")
{
    // Two sheets of strips across each other: every edge of one crosses every edge of the other.
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
    CHECK(joined.surface->faces.size() >= 4 * count);
    CHECK(joined.surface->faces.size() < 40 * count);
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
                CHECK(joined.report.pierced == 0);
                for (double heading : {0.0, 0.2, 3.14159265358979, 3.4}) {
                    PointContact contact(joined.surface);
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

TEST_CASE("joined: the proxy stays out of both objects and no farther from the hand than it must")
{
    // A ball half sunk into a box, and a slab that leans on both. Nearest point of the union of two solids: by search.
    const std::vector<PlacedSurface> surfaces = {placed(make_box({2, 2, 1}), {0, 0, -0.5}),
                                                 placed(ball(1, 5), {0, 0, 0.1})};
    const SurfaceResult joined = join_all(surfaces);
    CHECK(joined.report.pierced == 0);
    PointContact contact(joined.surface);
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
                PointContact contact(joined.surface);
                dvec3 hand(0.5, 0.5, 2.5);
                contact.update(turn * hand);
                double deepest = 0;
                for (int tick = 0; tick < 10000; ++tick) {
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
    CHECK(touching > 80000);
}
