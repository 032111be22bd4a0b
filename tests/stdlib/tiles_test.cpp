// Tiles against lists of all tiles near a point: each an outline of its own, where the library finds one cell.
#include "tests/stdlib/field.h"
#include "tests/stdlib/lines.h"
#include "tests/stdlib/outlines.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

using namespace haptel::test;

namespace {

using Tiles = std::vector<std::vector<Vec2>>; // corners of what is flat

struct Edges {
    double joint, rounding;
    double inset() const { return joint / 2 + rounding; }
};
constexpr Edges edges[] = {{0.1, 0.15}, {0, 0.5}, {0.3, 0.05}, {0.9, 0.05}};

// 1 on a tile, 0 from one rounding beyond it, by a cubic with level ends.
double height(const Vec2& q, const Tiles& tiles, double rounding)
{
    double highest = 0;
    for (const std::vector<Vec2>& corners : tiles) {
        const double t = std::clamp(1 - polygon_distance(q, corners) / rounding, 0.0, 1.0);
        highest = std::max(highest, t * t * (3 - 2 * t));
    }
    return highest;
}

std::vector<Vec2> moved(std::vector<Vec2> corners, double x, double y)
{
    for (Vec2& corner : corners) corner = {corner[0] + x, corner[1] + y};
    return corners;
}

std::string call(const std::string& function, std::initializer_list<double> numbers, const std::string& last = "")
{
    std::ostringstream text;
    text.precision(17);
    text << function << "(q.xy";
    for (const double number : numbers) text << ", float(" << number << ")";
    text << last << ")";
    return text.str();
}

// `tiles` near a place, in units in which a tile is 1 wide, of which there are `scale` in one of q.
void check_tiles(const std::string& expression, double scale, const Edges& edge,
                 const std::function<Tiles(const Vec2&)>& tiles)
{
    CAPTURE(expression);
    const Field field(expression);
    for (const Vec3& q : points_within(7, 1500)) {
        const Vec2 at{q[0] * scale, q[1] * scale};
        CHECK(std::fabs(field(q).value - height(at, tiles(at), edge.rounding)) < 1e-12 * scale / edge.rounding);
    }
    const double slope = 1.5001 * scale / edge.rounding, curvature = 6.0001 * std::pow(scale / edge.rounding, 2);
    const Jumps jumps = jumps_along_lines(field, 7, 300);
    CHECK(jumps.value < 1e-10 * slope + 1e-13);
    CHECK(jumps.gradient < 1e-10 * curvature + 1e-10);
}

// Of the cells of rows 1 high and `size` long, moved by shift(row).
Tiles rows(const Vec2& q, double size, double inset, const std::function<double(int)>& shift)
{
    Tiles tiles;
    const int row0 = static_cast<int>(std::floor(q[1])), i0 = static_cast<int>(std::floor(q[0] / size));
    for (int row = row0 - 2; row <= row0 + 2; ++row)
        for (int i = i0 - 2; i <= i0 + 2; ++i)
            tiles.push_back(moved(rectangle(inset, inset, size - inset, 1 - inset), (i - shift(row)) * size, row));
    return tiles;
}

} // namespace

TEST_CASE("square tiles, rows of bricks, rows of boards")
{
    for (const Edges& edge : edges) {
        check_tiles(call("tile", {edge.joint, edge.rounding}), 1, edge,
                    [&](const Vec2& q) { return rows(q, 1, edge.inset(), [](int) { return 0.0; }); });
        for (const double aspect : {1.0, 2.0, 3.3})
            check_tiles(call("brick", {aspect, edge.joint, edge.rounding}), aspect, edge, [&](const Vec2& q) {
                return rows(q, aspect, edge.inset(), [](int row) { return row % 2 == 0 ? 0.0 : 0.5; });
            });
        check_tiles(call("plank", {4, edge.joint, edge.rounding}, ", 0"), 4, edge, [&](const Vec2& q) {
            return rows(q, 4, edge.inset(),
                        [](int row) { return shuffled(shuffled(shuffled(shuffled(row)))) / 256.0; });
        });
    }
}

TEST_CASE("boards: another seed moves the rows")
{
    const Field one(call("plank", {4, 0.1, 0.1}, ", 1")), two(call("plank", {4, 0.1, 0.1}, ", 2"));
    int differ = 0;
    for (const Vec3& q : points_within(50, 2000)) differ += one(q).value != two(q).value;
    CHECK(differ > 100);
}

TEST_CASE("herringbone: bricks that lie and that stand cover the plane once, and each is where it is asked for")
{
    // Two wide as they are long, begun at the squares x - y = 4 n: one that lies, and one that stands at its left end.
    const auto bricks = [](const Vec2& q, double inset) {
        Tiles tiles;
        const int x0 = static_cast<int>(std::floor(q[0])), y0 = static_cast<int>(std::floor(q[1]));
        for (int x = x0 - 5; x <= x0 + 5; ++x)
            for (int y = y0 - 5; y <= y0 + 5; ++y) {
                if ((x - y) % 4 != 0) continue;
                tiles.push_back(moved(rectangle(inset, inset, 2 - inset, 1 - inset), x, y));
                tiles.push_back(moved(rectangle(inset, inset, 1 - inset, 2 - inset), x - 1, y));
            }
        return tiles;
    };
    for (const Vec3& q : points_within(9, 1000)) {
        int covered = 0;
        for (const std::vector<Vec2>& brick : bricks({q[0], q[1]}, 0))
            covered += polygon_distance({q[0], q[1]}, brick) < 0;
        CHECK(covered == 1);
    }
    for (const Edges& edge : edges)
        check_tiles(call("herringbone", {edge.joint, edge.rounding}), 2, edge,
                    [&](const Vec2& q) { return bricks(q, edge.inset()); });
}

TEST_CASE("hexagons with middles 1 apart")
{
    const double row_height = std::sqrt(3) / 2;
    for (const Edges& edge : edges)
        check_tiles(call("hex_tile", {edge.joint, edge.rounding}), 1, edge, [&](const Vec2& q) {
            Tiles tiles;
            const double corner = (0.5 - edge.inset()) / std::cos(std::numbers::pi / 6);
            const int row0 = static_cast<int>(std::floor(q[1] / row_height)), i0 = static_cast<int>(std::floor(q[0]));
            for (int row = row0 - 2; row <= row0 + 2; ++row)
                for (int i = i0 - 2; i <= i0 + 2; ++i)
                    tiles.push_back(moved(corners_round(6, corner, corner, std::numbers::pi / 6),
                                          i + (row % 2 == 0 ? 0 : 0.5), row * row_height));
            return tiles;
        });
}

TEST_CASE("tiles: joints and flanks that do not fit are made to fit")
{
    for (const char* narrow : {"tile(q.xy, -1.0, 0.0)", "brick(q.xy, 0.0, 2.0, 9.0)", "plank(q.xy, 99.0, 2.0, -1.0, 7)",
                               "herringbone(q.xy, 5.0, 5.0)", "hex_tile(q.xy, 5.0, 5.0)", "hex_tile(q.xy, -5.0, -5.0)",
                               "truchet(q.xy, 9.0, 7)", "truchet(q.xy, -9.0, 7)", "ridge_round(q.xy, 0.4)"}) {
        CAPTURE(narrow);
        const Field field(narrow);
        double least = INFINITY, most = -INFINITY;
        for (const Vec3& q : points_within(3, 20'000)) {
            least = std::min(least, field(q).value);
            most = std::max(most, field(q).value);
        }
        CHECK(least >= 0);
        CHECK(least < 1e-3);
        CHECK(most > 0.9);
        CHECK(most <= 1);
        const Jumps jumps = jumps_along_lines(field, 3, 100);
        CHECK(jumps.value < 1e-7);
        CHECK(jumps.gradient < 1e-3); // curvature 6 (16 / 0.01)^2 over 2e-11
    }
}

TEST_CASE("truchet: in each cell two quarters of circles round opposite corners, either way at random")
{
    const Field field("truchet(q.xy, 0.3, 5)");
    const double near = 0.5 * std::sqrt(0.5), far = 1 - near; // where an arc meets the diagonal
    int falling = 0, cells = 0;
    for (int i = -12; i < 12; ++i)
        for (int j = -12; j < 12; ++j, ++cells) {
            const auto at = [&](double x, double y) { return field({i + x, j + y, 0}).value; };
            CHECK(std::fabs(at(0.5, 0) - 1) < 1e-12); // tracks pass the middle of each side
            CHECK(std::fabs(at(0, 0.5) - 1) < 1e-12);
            const bool rises = std::fabs(at(near, near) - 1) < 1e-12, falls = std::fabs(at(far, near) - 1) < 1e-12;
            CHECK(rises != falls);
            falling += falls;
            for (double x = 0.05; x < 1; x += 0.1)
                for (double y = 0.05; y < 1; y += 0.1) {
                    const double u = rises ? x : 1 - x, first = std::hypot(u, y), last = std::hypot(1 - u, 1 - y);
                    const double s = std::min(std::fabs(first - 0.5), std::fabs(last - 0.5)) / 0.15;
                    CHECK(std::fabs(at(x, y) - std::pow(std::max(1 - s * s, 0.0), 3)) < 1e-12);
                }
        }
    CHECK(falling > 0.4 * cells);
    CHECK(falling < 0.6 * cells);
    const Jumps jumps = jumps_along_lines(field, 12, 3000);
    CHECK(jumps.value < 1e-9);
    CHECK(jumps.gradient < 1e-8); // curvature 6 / 0.15^2 over 2e-11
}

TEST_CASE("knit: a V of two legs per stitch, and no others count")
{
    const Field field("knit(q.xy)");
    for (const Vec3& q : points_within(9, 3000)) {
        double left = 1;
        for (double column = std::floor(q[0]) - 2; column <= q[0] + 2; ++column)
            for (double row = std::floor(q[1] / 0.75) - 3; row <= q[1] / 0.75 + 3; ++row)
                for (const double side : {-1.0, 1.0}) {
                    const double x = column + 0.5 + 0.25 * side, y = 0.75 * row, angle = 75 * std::numbers::pi / 180;
                    const double to_x = side * 0.31 * std::cos(angle), to_y = 0.31 * std::sin(angle);
                    const double s = 6 * segment_distance({q[0], q[1]}, {x - to_x, y - to_y}, {x + to_x, y + to_y});
                    left *= 1 - std::pow(std::max(1 - s * s, 0.0), 3);
                }
        CHECK(std::fabs(field(q).value - (1 - left)) < 1e-12);
    }
    const Jumps jumps = jumps_along_lines(field, 9, 1000);
    CHECK(jumps.value < 1e-9);
    CHECK(jumps.gradient < 1e-7);
}
