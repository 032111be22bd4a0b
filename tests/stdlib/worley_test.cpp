// worley and voronoi_border against points that are worked out here, over windows wider than any that they need, and
// the bounds that make their windows exact against searches.
#include "tests/stdlib/facts.h"
#include "tests/stdlib/pcg4d.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

using namespace haptel;
using namespace haptel::test;

namespace {

constexpr double spread = 0.4; // of points round the middles of their cells

struct Point {
    Vec3 way; // from q
    double distance, number;
};

// All in cells within five of that of q, the nearest first.
std::vector<Point> points_near(const Vec3& q, bool in_space, int seed)
{
    std::vector<Point> found;
    const auto cell = [&](size_t a) { return static_cast<int>(std::floor(q[a])); };
    const int reach = in_space ? 3 : 5, deep = in_space ? reach : 0, k0 = in_space ? cell(2) : 0;
    for (int i = cell(0) - reach; i <= cell(0) + reach; ++i)
        for (int j = cell(1) - reach; j <= cell(1) + reach; ++j)
            for (int k = k0 - deep; k <= k0 + deep; ++k) {
                const Four bits = in_space ? pcg4d(i, j, k, seed) : pcg4d(i, j, seed, 0);
                const auto place = [&](int corner, size_t a) {
                    return corner + 0.5 + spread * (2 * unit_of(bits[a]) - 1) - q[a];
                };
                const Vec3 way{place(i, 0), place(j, 1), in_space ? place(k, 2) : 0};
                found.push_back({way, std::hypot(way[0], way[1], way[2]), unit_of(bits[in_space ? 3 : 2])});
            }
    std::ranges::sort(found, {}, &Point::distance);
    return found;
}

// To the nearest of the lines half way between the nearest point and another: where (|b|^2 - |a|^2) / (2 |b - a|) is
// least.
double border_of(const std::vector<Point>& points)
{
    double least = INFINITY;
    const Point& a = points[0];
    for (size_t i = 1; i < points.size(); ++i) {
        const Point& b = points[i];
        const double apart = std::hypot(b.way[0] - a.way[0], b.way[1] - a.way[1]);
        least = std::min(least, (b.distance * b.distance - a.distance * a.distance) / (2 * apart));
    }
    return least;
}

// The furthest that the least and the second least distance can be, over places in a cell: of all cells the way to the
// furthest place where their point may be.
std::pair<double, double> furthest(bool in_space)
{
    double first = 0, second = 0;
    const int steps = 20;
    const auto way = [](double coordinate, int cell) { return std::fabs(cell + 0.5 - coordinate) + spread; };
    for (int x = 0; x <= steps; ++x)
        for (int y = 0; y <= steps; ++y)
            for (int z = 0; z <= (in_space ? steps : 0); ++z) {
                std::vector<double> distances;
                for (int cell = 0; cell < (in_space ? 27 : 9); ++cell)
                    distances.push_back(std::hypot(way(x / 20.0, cell % 3 - 1), way(y / 20.0, cell / 3 % 3 - 1),
                                                   in_space ? way(z / 20.0, cell / 9 - 1) : 0));
                std::ranges::sort(distances);
                first = std::max(first, distances[0]);
                second = std::max(second, distances[1]);
            }
    return {first, second};
}

} // namespace

TEST_CASE("worley: the two least distances and a number of the nearest point's cell")
{
    for (const bool in_space : {false, true})
        for (const int seed : {0, 7}) {
            const std::string argument = in_space ? "q" : "q.xy";
            const std::string call = "worley(" + argument + (seed ? ", 7)" : ")");
            const Field x(call + ".x"), y(call + ".y"), z(call + ".z");
            for (const double size : {5.0, 5000.0})
                for (const Vec3& q : points_within(size, in_space ? 200 : 1000)) {
                    const std::vector<Point> points = points_near(q, in_space, seed);
                    CHECK(std::fabs(x(q).value - points[0].distance) < 1e-11);
                    CHECK(std::fabs(y(q).value - points[1].distance) < 1e-11);
                    CHECK(z(q).value == points[0].number);
                    // a distance rises straight away from its point
                    const FieldSample nearest = x(q);
                    for (size_t a = 0; a < (in_space ? 3 : 2); ++a)
                        CHECK(std::fabs(nearest.gradient[a] + points[0].way[a] / points[0].distance) < 1e-9);
                    CHECK(z(q).gradient == Vec3{});
                }
        }
}

TEST_CASE("voronoi_border: the distance to the nearest line half way between points, 0 where two are equally near")
{
    const Field field("voronoi_border(q.xy)"), seeded("voronoi_border(q.xy, 7)");
    for (const double size : {30.0, 5000.0})
        for (const Vec3& q : points_within(size, 3000)) {
            CHECK(std::fabs(field(q).value - border_of(points_near(q, false, 0))) < 1e-11);
            CHECK(std::fabs(seeded(q).value - border_of(points_near(q, false, 7))) < 1e-11);
            const Vec3 slope = field(q).gradient;
            CHECK(std::fabs(std::hypot(slope[0], slope[1]) - 1) < 1e-9);
        }
}

TEST_CASE("worley's windows are wide enough, and its facts are what its points can be, rounded up")
{
    const auto just_above = [](double fact, double truth) { return fact > truth && fact < truth * 1.0001; };
    for (const bool in_space : {false, true}) {
        const auto [first, second] = furthest(in_space);
        CHECK(second < 2 - spread); // the nearest 4 x 4 (x 4) cells hold all points so near
        if (!in_space) CHECK(2 * first < 3 - spread);
        const std::string argument = in_space ? "q" : "q.xy", type = in_space ? "vec3" : "vec2",
                          call = "worley(" + argument + ", 3)";
        const ir::Facts facts = facts_of("worley_distances(" + type + ",int)", call + ".x");
        CHECK(just_above(facts.value_maximum.value(), second));
        CHECK(facts.continuity == ir::Continuity::c0);
        const ir::Facts squares = facts_of("worley_squares(" + type + ",int)", call + ".x");
        CHECK(just_above(squares.value_maximum.value(), second * second));
        CHECK(just_above(squares.slope.value(), 2 * second)); // of a square of a distance: twice the distance
        CHECK(just_above(squares.curvature.value(), 2));
        check_never_exceeded(call + ".x", facts, 50, 5000);
        check_never_exceeded(call + ".y", facts, 50, 5000);
    }
    const auto [first, second] = furthest(false);
    const std::string call = "voronoi_border(q.xy)";
    const ir::Facts facts = facts_of("voronoi_border(vec2)", call);
    CHECK(just_above(facts.value_maximum.value(), (first + second) / 3));
    CHECK((facts.slope.value() > 1 && *facts.slope < 1.0001 && facts.curvature == 0)); // pieces of planes of slope 1
    const Field border(call);
    int planes = 0;
    for (const Vec3& q : points_within(50, 5000)) {
        const FieldSample here = border(q), beside = border({q[0] + 1e-5, q[1], q[2]});
        CHECK((here.value >= 0 && here.value <= facts.value_maximum));
        planes += std::fabs(here.gradient[0] - beside.gradient[0]) < 1e-12;
    }
    CHECK(planes > 4900); // but where a kink is between
}
