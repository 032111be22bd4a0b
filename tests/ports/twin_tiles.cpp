// Twins of tilings: of a place the tile that covers it is found among all tiles near it, by its corners or its centre.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>

namespace haptel::ports {
namespace {

// From q to the nearest of the four sides of a box, each by `edge`; the box begins at `low`.
double least_of_sides(dvec2 q, dvec2 low, dvec2 side)
{
    const dvec2 from = q - low, to = low + side - q;
    return std::min(std::min(from.x, to.x), std::min(from.y, to.y));
}

double truchet_arcs(dvec3 q)
{
    const dvec2 low = glm::floor(dvec2(q));
    uint32_t h = (whole(low.x) ^ 0x5bd1e995u) * 668265263u ^ (whole(low.y) ^ 0x1b873593u) * 374761393u;
    h = (h ^ static_cast<uint32_t>(static_cast<int32_t>(h) >> 13)) * 1274126177u;
    const bool is_turned = h / 512 % 2 == 1;
    const dvec2 one = low + dvec2(is_turned ? 1 : 0, 0), other = low + dvec2(is_turned ? 0 : 1, 1);
    const auto to_arc = [&](dvec2 corner) { return std::fabs(glm::distance(dvec2(q), corner) - 0.5); };
    return ramp(0.16, 0.08, std::min(to_arc(one), to_arc(other)));
}

struct Hexagon {
    dvec2 way;              // from its middle
    int two_across, two_up; // twice its middle's coordinates, in sides of the lattice's rectangle
};

Hexagon nearest_hexagon(dvec2 q, double height) // of the rectangle, whose width is 1
{
    Hexagon nearest{dvec2(1e9), 0, 0};
    const int across = static_cast<int>(std::floor(2 * q.x)), up = static_cast<int>(std::floor(2 * q.y / height));
    for (int j = up - 3; j <= up + 3; ++j)
        for (int i = across - 3; i <= across + 3; ++i) {
            if ((i + j) % 2 != 0) continue;
            const dvec2 way = q - dvec2(i, height * j) / 2.0;
            if (glm::length(way) < glm::length(nearest.way)) nearest = {way, i, j};
        }
    return nearest;
}

double hex_tiles(dvec3 q)
{
    constexpr double height = 1.7320508;
    const Hexagon tile = nearest_hexagon(dvec2(q), height);
    double edge = 0.5 - std::fabs(tile.way.x);
    for (const double side : {-1, 1})
        edge = std::min(edge, 0.5 - std::fabs(tile.way.x / 2 + side * height / 2 * tile.way.y));
    const double angle = tile.two_across / 2.0 * 31.7 + tile.two_up / 2.0 * 17.9;
    return ramp(0, 0.1, edge) * (0.8 + 0.2 * fraction(std::sin(angle) * 531.7));
}

double hex_mosaic(dvec3 q)
{
    const Hexagon tile = nearest_hexagon(dvec2(q), std::sqrt(3.0));
    return fraction(tile.two_across * 0.618034 + tile.two_up * 0.754878);
}

double brick_wall(dvec3 q)
{
    constexpr double width = 2, height = 0.7, mortar = 0.09;
    const double row = std::floor(q.y / height), shift = is_odd(row) ? width / 2 : 0;
    const double column = std::floor((q.x + shift) / width);
    const dvec2 low(column * width - shift, row * height), high = low + dvec2(width, height);
    double brick = 1;
    for (const double way : {q.x - low.x, high.x - q.x, q.y - low.y, high.y - q.y}) brick *= ramp(0, mortar, way);
    return brick * (0.7 + 0.3 * fraction(std::sin(column * 3.1 + row * 7.7) * 91.7));
}

double planks(dvec3 q)
{
    const auto random = [](double n) { return fraction(std::sin(n * 91.3458) * 475.5453); };
    const double row = std::floor(q.y), shift = 5 * random(row), number = std::floor((q.x + shift) / 5);
    const dvec2 from = dvec2(q.x + shift - 5 * number, q.y - row);
    const auto edge = [](double to_side) { return to_side < 0.06 ? to_side / 0.06 * (2 - to_side / 0.06) : 1; };
    const double id = 13 * number + 7 * row, wave = std::sin(4 * from.x + 30 * from.y + 6 * random(id));
    return edge(std::min(from.x, 5 - from.x)) * edge(std::min(from.y, 1 - from.y)) *
           (0.6 + 0.03 * wave + 0.3 * random(id + 0.5));
}

double planks_tilted(dvec3 q)
{
    const double row = std::floor(q.y);
    uint32_t r = whole(row) * 2654435761u;
    r ^= r >> 15;
    const double number = std::floor(q.x / 4 + r % 16 / 16.0), from_middle = q.y - row - 0.5;
    return 0.5 + (is_odd(number) == is_odd(row) ? from_middle : -from_middle / 2);
}

double herringbone(dvec3 q)
{
    const dvec2 at = 1.5 * 0.70710678 * dvec2(q.x - q.y, q.x + q.y), low = glm::floor(at);
    for (int j = -1; j <= 0; ++j) // of all bricks that begin at or before this square, the one that covers it
        for (int i = -1; i <= 0; ++i) {
            const dvec2 corner = low + dvec2(i, j);
            const auto turn = (static_cast<int64_t>(corner.x - corner.y) % 4 + 4) % 4;
            if (turn != 0 && turn != 3) continue; // no brick begins here
            const dvec2 side = turn == 0 ? dvec2(2, 1) : dvec2(1, 2);
            const double edge = least_of_sides(at, corner, side);
            if (edge >= 0) return ramp(0, 0.12, edge);
        }
    return -1e9; // a hole in the tiling
}

double basket(dvec3 q)
{
    const dvec2 low = glm::floor(dvec2(q)), from = dvec2(q) - low;
    const bool is_standing = is_odd(low.x + low.y);
    const double across = is_standing ? from.x : from.y, along = is_standing ? from.y : from.x;
    return std::fabs(std::sin(4 * pi * across)) * std::sqrt(1.01 - std::pow(2 * along - 1, 2)) *
           ramp(0, 0.05, least_of_sides(dvec2(q), low, dvec2(1)));
}

double checker_soft(dvec3 q)
{
    // A triangle wave between -1 and 1 of period 2, -1 at every second half.
    const auto wave = [](double x) { return 1 - 4 * std::fabs(x / 2 + 0.25 - std::round(x / 2 + 0.25)); };
    return (1 + glm::clamp(4 * wave(q.x) * wave(q.y), -1.0, 1.0)) / 2;
}

double fish_scales(dvec3 q)
{
    for (int row = static_cast<int>(std::floor(2 * q.y)) - 4;; ++row) { // the lowest row that covers the place
        const double x = q.x + (row % 2 != 0 ? 0.5 : 0), from_middle = x - std::floor(x) - 0.5, up = q.y - row / 2.0;
        if (up >= 0 && std::hypot(from_middle, up) < 0.75) return 0.4 + 0.8 * up;
    }
}

double diamond_plate(dvec3 q)
{
    const dvec2 low = glm::floor(dvec2(q)), from = dvec2(q) - low - 0.5;
    const double along = (from.x + from.y) / std::sqrt(2.0), across = (from.y - from.x) / std::sqrt(2.0);
    const double length = is_odd(low.x + low.y) ? across : along, width = is_odd(low.x + low.y) ? along : across;
    const double h = 1 - std::pow(length / 0.46, 2) - std::pow(width / 0.15, 2);
    return h > 0 ? fade3(h) : 0;
}

double perforated(dvec3 q)
{
    const double pitch = std::sqrt(3.0) / 2, row = std::floor(q.y / pitch), x = q.x + (is_odd(row) ? 0.5 : 0);
    const double r = std::hypot(x - std::floor(x) - 0.5, q.y - (row + 0.5) * pitch);
    const double rim = std::exp(-std::pow((r - 0.33) * 25, 2)) * ramp(0.43, 0.38, r);
    return ramp(0.24, 0.3, r) - 1 + 0.3 * rim;
}

double soft_stairs(dvec3 q)
{
    const double way = 1.3 * (3 * q.x + 2 * q.y + q.z) / std::sqrt(14.0), step = std::floor(way);
    const auto tread = [](double n) { return (1 + fraction(n * 0.38196601125)) / 2; };
    const double up = ramp(0.3, 0.7, way - step);
    return (1 - up) * tread(step) + up * tread(step + 1);
}

} // namespace

std::span<const Twin> tile_twins()
{
    static constexpr const char* joints = "tiles are 0 at their sides";
    static constexpr Twin twins[] = {
        {"truchet_arcs", truchet_arcs, Borders::meet, "rings meet in the middle of sides, turned or not"},
        {"hex_tiles", hex_tiles, Borders::meet, joints},
        {"hex_mosaic", hex_mosaic, Borders::jump, "flat tiles of different heights without joints"},
        {"brick_wall", brick_wall, Borders::meet, joints},
        {"planks", planks, Borders::meet, joints},
        {"planks_tilted", planks_tilted, Borders::jump, "the high side of a board is at the low side of the next"},
        {"herringbone", herringbone, Borders::meet, joints},
        {"basket", basket, Borders::meet, joints},
        {"checker_soft", checker_soft, Borders::meet, "triangle waves, cut off"},
        {"fish_scales", fish_scales, Borders::jump, "the rim of a scale is higher than what lies below"},
        {"diamond_plate", diamond_plate, Borders::meet, "lozenges are 0 at their rim, within their cell"},
        {"perforated", perforated, Borders::meet, "flat at the sides of cells"},
        {"soft_stairs", soft_stairs, Borders::meet, "each tread ends where the next begins"},
    };
    return twins;
}

} // namespace haptel::ports
