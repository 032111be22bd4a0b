#include "runtime/surface/box_tree.h"

#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/collision.h"
#include "runtime/surface/discs.h"
#include "tests/runtime/surface/distance.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// Every face asked, no tree.
bool brute_force(const Surface& s, const dvec3& from, const dvec3& to, Crossing& first)
{
    bool found = false;
    for (uint32_t f = 0; f < s.faces.size(); ++f) {
        const auto& v = s.faces[f].vertex;
        Crossing candidate;
        candidate.face = f;
        if (!crosses(from, to, s.vertices[v[0]], s.vertices[v[1]], s.vertices[v[2]], candidate)) continue;
        if (!found || earlier(candidate, first)) first = candidate;
        found = true;
    }
    return found;
}

struct Tally {
    int hits = 0, missed = 0, wrong = 0;
};

// Segments of all lengths through random points, vertices, edges and along edges and axes.
Tally compare(const Surface& s, int segments, uint64_t seed)
{
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    const auto direction = [&] {
        std::normal_distribution<double> normal;
        return glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    };
    Tally tally;
    for (int i = 0; i < segments; ++i) {
        const auto& corners = s.faces[random() % s.faces.size()].vertex;
        const dvec3 &a = s.vertices[corners[0]], &b = s.vertices[corners[1]], &c = s.vertices[corners[2]];
        const double length = std::pow(10.0, 1 - 12 * uniform()) * Lattice::extent; // 10 to 1e-11 half extents
        dvec3 aim;
        switch (i % 4) {
        case 0: aim = a; break;
        case 1: aim = glm::mix(a, b, uniform()); break;
        case 2: aim = (a + b + c) / 3.0; break;
        default: aim = direction() * uniform() * 1.1 * Lattice::extent; break;
        }
        dvec3 along = direction();
        if (i % 7 == 0) along = dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);
        if (i % 11 == 0) along = glm::normalize(b - a);
        const double share = i % 5 == 0 ? 0.0 : i % 5 == 1 ? 1.0 : uniform();
        const auto lattice_point = [](const dvec3& p) {
            return glm::clamp(glm::round(p), -Lattice::workspace, Lattice::workspace);
        };
        const dvec3 from = lattice_point(aim - share * length * along),
                    to = lattice_point(aim + (1 - share) * length * along);

        Crossing truth, found;
        CollisionCount count;
        const bool expected = brute_force(s, from, to, truth);
        const bool got = first_crossing(s, from, to, StartsOn::nothing(), found, count);
        tally.hits += expected;
        tally.missed += expected && !got;
        tally.wrong += expected == got && expected && (truth.face != found.face || truth.side != found.side);
        tally.wrong += !expected && got;
    }
    return tally;
}

} // namespace

TEST_CASE("the tree never loses a crossing, whatever the segment")
{
    Mesh far = make_bumpy_sphere(2);
    for (dvec3& p : far.positions_m) p += dvec3(1e4, -1e4, 1e4);
    Mesh tiny = make_stairs();
    for (dvec3& p : tiny.positions_m) p *= 1e-9;
    const Mesh meshes[] = {make_bumpy_sphere(3), far, tiny, make_star(2), make_box({1, 1, 2e-9}), make_sphere(16, 8)};
    for (const Mesh& mesh : meshes) {
        const Tally tally = compare(*surface_of(mesh), 10000, 5);
        CAPTURE(mesh.triangles.size());
        CHECK(tally.hits > 2000);
        CHECK(tally.missed == 0);
        CHECK(tally.wrong == 0);
    }
}

TEST_CASE("the tree is the same on any number of threads")
{
    const Mesh mesh = make_bumpy_sphere(6); // 81920 triangles: several parts
    const auto s = surface_of(mesh);
    const auto bytes_on = [&](unsigned threads) {
        const std::vector<BoxTree::Node> nodes = box_tree_of(s->vertices, s->faces, threads);
        return std::string(reinterpret_cast<const char*>(nodes.data()), nodes.size() * sizeof nodes[0]);
    };
    const std::string alone = bytes_on(1);
    for (const unsigned threads : {2u, 3u, 7u}) CHECK((bytes_on(threads) == alone));
    CHECK(alone.size() < 40 * s->faces.size());
}

TEST_CASE("the tree never loses a crossing: long run", "[.long]")
{
    Tally sum;
    for (const Mesh& mesh : {make_bumpy_sphere(4), make_star(3), make_torus(0.4, 48, 24), make_stairs()}) {
        const Tally tally = compare(*surface_of(mesh), 500000, 99);
        sum.hits += tally.hits, sum.missed += tally.missed, sum.wrong += tally.wrong;
    }
    WARN("segments 2000000, hits " << sum.hits << ", missed " << sum.missed << ", wrong " << sum.wrong);
    CHECK(sum.missed == 0);
    CHECK(sum.wrong == 0);
}

TEST_CASE("a path through a closed surface goes in and out by turns, also through its vertices and edges")
{
    for (const Mesh& mesh : {make_icosphere(1), make_box(), make_stairs(), make_star(2)}) {
        const auto s = surface_of(mesh);
        std::mt19937_64 random(11);
        int paths = 0;
        for (int i = 0; i < 300; ++i) {
            // From one outside point to another, aimed through a vertex, or through two of them.
            const dvec3& v = s->vertices[random() % s->vertices.size()];
            const dvec3& w = s->vertices[random() % s->vertices.size()];
            if (v == w) continue;
            const double times = std::ceil(1.9 * Lattice::extent / glm::length(v - w));
            const dvec3 from = v + (v - w) * times, to = v - (v - w) * times;
            const auto outside = [&](const dvec3& p) {
                const Winding around = winding(*s, s->lattice.metres(p));
                return std::abs(around.number) < 0.5 && around.distance_m > 1e-6;
            };
            if (glm::any(glm::greaterThan(glm::abs(from), dvec3(Lattice::workspace))) ||
                glm::any(glm::greaterThan(glm::abs(to), dvec3(Lattice::workspace))) || !outside(from) || !outside(to))
                continue;
            ++paths;
            std::vector<Crossing> crossings;
            for (uint32_t f = 0; f < s->faces.size(); ++f) {
                const auto& c = s->faces[f].vertex;
                Crossing crossing;
                crossing.face = f;
                if (crosses(from, to, s->vertices[c[0]], s->vertices[c[1]], s->vertices[c[2]], crossing))
                    crossings.push_back(crossing);
            }
            std::sort(crossings.begin(), crossings.end(), earlier);
            CHECK(crossings.size() % 2 == 0);
            for (size_t k = 0; k < crossings.size(); ++k) CHECK(crossings[k].side == k % 2);
        }
        CHECK(paths > 100);
    }
}

TEST_CASE("a crossing lies in its triangle, however far out rounding has put it")
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto s = surface_of(make_bumpy_sphere(2));
    for (int i = 0; i < 10'000; ++i) {
        Crossing crossing;
        crossing.face = static_cast<uint32_t>(random() % s->faces.size());
        const auto& v = s->faces[crossing.face].vertex;
        const dvec3 a = s->vertices[v[0]], b = s->vertices[v[1]], c = s->vertices[v[2]];
        const double size = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const dvec3 from = a + 3 * size * dvec3(any(random), any(random), any(random));
        const dvec3 point = crossing_point(*s, crossing, from, from + dvec3(1)); // at `from`: its numerator is 0
        CHECK(glm::distance(nearest_point(a, b, c, point).at, point) < 1e-9 * size);
    }
}

TEST_CASE("an empty ball holds no part of the surface")
{
    const auto s = surface_of(make_star(2));
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform(-1.5, 1.5);
    int empty = 0;
    for (int i = 0; i < 2000; ++i) {
        const dvec3 centre = s->lattice.snap({uniform(random), uniform(random), uniform(random)});
        const double radius = std::pow(10.0, -uniform(random) - 1.5) * Lattice::extent;
        const double clear = clearance(*s, centre, radius);
        const double distance = winding(*s, s->lattice.metres(centre)).distance_m / s->lattice.unit_m;
        CHECK(clear <= radius);
        CHECK(clear < distance * (1 + 1e-9));
        CHECK(clear >= std::min(radius, 0.1 * distance)); // a thorn is farther away than its lines say
        empty += clear == radius;
    }
    CHECK(empty > 500);
}

TEST_CASE("first_hit reports where a line meets a sphere, from far outside too")
{
    const auto s = surface_of(make_icosphere(5));
    for (double distance : {1.0, 1e3, 1e7}) {
        const auto hit = s->first_hit({0.1, 0.2, distance}, {0.1, 0.2, -distance});
        REQUIRE(hit);
        CHECK(std::abs(hit->point_m.z - std::sqrt(0.25 - 0.05)) < 3e-4);
        CHECK(std::abs(hit->point_m.x - 0.1) < 1e-9 * distance);
        CHECK(hit->side == 0);
        CHECK(hit->facet_normal.z > 0.8);
        CHECK(std::abs(hit->barycentric.x + hit->barycentric.y + hit->barycentric.z - 1) < 1e-12);
    }
    CHECK_FALSE(s->first_hit({1, 0, 1}, {1, 0, -1}));
    CHECK_FALSE(s->first_hit({NAN, 0, 1}, {0, 0, -1}));
    CHECK_FALSE(s->first_hit({0, 0, 0.6}, {0, 0, INFINITY}));
    CHECK(s->first_hit({0, 0, 0}, {0, 0, 1})->side == 1);
}

TEST_CASE("the faces around a point are all listed, and few that are farther away")
{
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const Mesh& mesh : {make_bumpy_sphere(3), make_star(2), make_box({1, 1, 2e-9})}) {
        const auto s = surface_of(mesh);
        std::vector<uint32_t> listed, cut;
        listed.reserve(s->faces.size());
        cut.reserve(s->faces.size());
        for (int i = 0; i < 300; ++i) {
            const dvec3 centre = 1.3 * Lattice::extent * dvec3(uniform(random), uniform(random), uniform(random));
            const double radius = Lattice::extent * std::pow(uniform(random), 2);
            REQUIRE(s->tree->ball(centre, radius, s->faces.size(), listed));
            std::sort(listed.begin(), listed.end());
            REQUIRE(std::adjacent_find(listed.begin(), listed.end()) == listed.end());
            std::size_t within = 0;
            for (uint32_t face = 0; face < s->faces.size(); ++face) {
                dvec3 low(INFINITY), high(-INFINITY);
                for (const uint32_t corner : s->faces[face].vertex) {
                    low = glm::min(low, s->vertices[corner]);
                    high = glm::max(high, s->vertices[corner]);
                }
                const double distance = glm::distance(centre, glm::clamp(centre, low, high));
                const bool is_listed = std::binary_search(listed.begin(), listed.end(), face);
                if (distance <= radius) REQUIRE(is_listed);
                if (distance > radius + 1e-5 * Lattice::extent) REQUIRE(!is_listed);
                within += is_listed;
            }
            REQUIRE(within == listed.size());
            // With less room: so many of them, and that there are more.
            if (listed.size() < 2) continue;
            CHECK(!s->tree->ball(centre, radius, listed.size() - 1, cut));
            CHECK(cut.size() == listed.size() - 1);
            CHECK(s->tree->ball(centre, radius, listed.size(), cut));
        }
    }
}

TEST_CASE("all that is behind a node lies behind the plane that its disc puts before a place, no nearer than that")
{
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const Mesh smooth = make_bumpy_sphere(4);
    for (const Mesh& mesh : {smooth, make_star(3), make_stairs()}) {
        const auto surface = surface_of(mesh);
        const BoxTree& tree = *surface->tree;
        double flat = 0, discs = 0;
        for (uint32_t node = 0; node < tree.nodes().size(); ++node) {
            std::vector<uint32_t> behind, waiting{node};
            while (!waiting.empty()) {
                const BoxTree::Node& at = tree.nodes()[waiting.back()];
                waiting.pop_back();
                for (uint32_t k = 0; k < BoxTree::width; ++k)
                    if (at.low[0][k] <= at.high[0][k])
                        at.child[k] & BoxTree::is_face ? behind.push_back(at.child[k] & ~BoxTree::is_face)
                                                       : waiting.push_back(at.child[k]);
            }
            const BoxTree::Disc& disc = tree.disc(node);
            if (behind.size() > BoxTree::Disc::faces_most) {
                CHECK(std::isinf(disc.radius));
                continue;
            }
            flat += disc.half_height < 0.2 * disc.radius;
            ++discs;
            for (int trial = 0; trial < 4; ++trial) {
                const double far = std::pow(10.0, -2 * trial) * Lattice::extent;
                const dvec3 place = dvec3(disc.centre) + far * dvec3(normal(random), normal(random), normal(random));
                const DiscBound bound = bound_of(disc, place);
                if (bound.distance == 0) continue;
                for (const uint32_t face : behind) {
                    dvec3 corner[3];
                    for (int c = 0; c < 3; ++c) corner[c] = surface->vertices[surface->faces[face].vertex[c]];
                    for (const dvec3& c : corner) REQUIRE(glm::dot(bound.normal, place - c) >= bound.distance - 0.01);
                    REQUIRE(distance_to(corner[0], corner[1], corner[2], place) >= bound.distance - 0.01);
                }
            }
        }
        CHECK(discs > 10);
        if (mesh.triangles.size() == smooth.triangles.size()) CHECK(flat > 0.9 * discs);
    }
}
