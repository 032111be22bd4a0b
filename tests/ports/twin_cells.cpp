// Twins of cellular patterns: each cell of a grid has a point, and the height is by the distances to points. They look
// at more cells than the patterns do, so that a pattern which looked at too few would differ.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haptel::ports {
namespace {

constexpr int window = 4; // cells to each side of that of q

// From q to the points of all cells near it, the nearest first. `point` is where the point is in the cell, 0 .. 1.
template <typename PointOfCell>
std::vector<dvec2> ways_to_points(dvec2 q, PointOfCell point)
{
    const dvec2 low = glm::floor(q);
    std::vector<dvec2> ways;
    for (int j = -window; j <= window; ++j)
        for (int i = -window; i <= window; ++i) {
            const dvec2 cell = low + dvec2(i, j);
            ways.push_back(cell + point(cell) - q);
        }
    std::ranges::sort(ways, {}, [](dvec2 way) { return glm::dot(way, way); });
    return ways;
}

double worley_f1(dvec3 q)
{
    const auto point = [](dvec2 c) {
        double a = fraction(c.y * 0.2971), b = fraction(c.x * 0.1237), d = fraction(c.y * 0.3517);
        const double stir = a * (b + 19.19) + b * (d + 19.19) + d * (a + 19.19);
        a += stir, b += stir, d += stir;
        return 0.2 + 0.6 * dvec2(fraction((a + b) * d), fraction((b + d) * a));
    };
    return 1 - glm::length(ways_to_points(dvec2(q), point)[0]);
}

double worley_f2f1(dvec3 q)
{
    const auto point = [](dvec2 c) {
        uint32_t h = whole(c.x) * 0x9e3779b9u + whole(c.y) * 0x85ebca6bu;
        h = (h ^ h >> 15) * 0x2c1b3c6du;
        h ^= h >> 12;
        return 0.25 + 0.5 * dvec2(h % 65536, h / 65536) / 65536.0;
    };
    const std::vector<dvec2> ways = ways_to_points(dvec2(q), point);
    return ramp(0, 0.6, glm::length(ways[1]) - glm::length(ways[0]));
}

// To the bisector of the nearest point and another, the least over all others.
double voronoi_border(dvec3 q)
{
    const auto point = [](dvec2 c) {
        const double a = c.x * 37.1 + c.y * 121.7, b = c.x * 97.3 + c.y * 53.9;
        return 0.5 + 0.6 * (dvec2(fraction(std::sin(a) * 1371.71), fraction(std::sin(b) * 1371.71)) - 0.5);
    };
    const std::vector<dvec2> ways = ways_to_points(dvec2(q), point);
    double least = 1e9;
    for (size_t i = 1; i < ways.size(); ++i) {
        const double farther = glm::dot(ways[i], ways[i]) - glm::dot(ways[0], ways[0]);
        least = std::min(least, farther / (2 * glm::distance(ways[i], ways[0])));
    }
    return ramp(0.02, 0.14, least);
}

double smooth_voronoi(dvec3 q)
{
    const auto point = [](dvec2 c) {
        const double a = c.x * 12.71 + c.y * 31.17, b = c.x * 26.95 + c.y * 18.33;
        return dvec2(fraction(std::sin(a) * 435.5453), fraction(std::sin(b) * 435.5453)) / 2.0 + 0.25;
    };
    const std::vector<dvec2> ways = ways_to_points(dvec2(q), point);
    const double nearest = glm::length(ways[0]);
    double sum = 0;
    for (const dvec2& way : ways) sum += std::exp(22 * (nearest - glm::length(way)));
    return nearest - std::log(sum) / 22;
}

double voronoi_noise(dvec3 q)
{
    const dvec2 low = glm::floor(dvec2(q));
    double sum = 0, weights = 0;
    for (int j = -window; j <= window; ++j)
        for (int i = -window; i <= window; ++i) {
            const dvec2 c = low + dvec2(i, j);
            const double angles[] = {c.x * 17.1 + c.y * 31.7, c.x * 29.5 + c.y * 18.3, c.x * 41.9 + c.y * 37.1};
            double random[3];
            for (int k = 0; k < 3; ++k) random[k] = fraction(std::sin(angles[k]) * 758.5453);
            const double distance = glm::distance(dvec2(q), c + 0.8 * dvec2(random[0], random[1]));
            const double weight = distance < 1.4 ? std::pow(1 - distance / 1.4, 4.5) : 0;
            sum += weight * random[2];
            weights += weight;
        }
    return sum / weights;
}

double crystal_cells(dvec3 q)
{
    const auto stirred = [](dvec3 cell) {
        uint32_t v[3] = {whole(cell.x), whole(cell.y), whole(cell.z)};
        for (int round = 0; round < 3; ++round) {
            uint32_t next[3];
            for (int i = 0; i < 3; ++i) next[i] = v[(i + 1) % 3] * 73856093u ^ (v[i] * 19349663u + 83492791u);
            for (int i = 0; i < 3; ++i) v[i] = next[i] ^ static_cast<uint32_t>(static_cast<int32_t>(next[i]) >> 11);
        }
        return dvec3(v[0] % 256, v[1] % 256, v[2] % 256) / 255.0;
    };
    double least = 1e9;
    const dvec3 low = glm::floor(q);
    for (int k = -2; k <= 2; ++k)
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i) {
                const dvec3 cell = low + dvec3(i, j, k), point = cell + 0.4 + 0.2 * stirred(cell);
                least = std::min(least, std::fabs(point.x - q.x) + std::fabs(point.y - q.y) + std::fabs(point.z - q.z));
            }
    return least;
}

double pebbles(dvec3 q)
{
    const dvec2 low = glm::floor(dvec2(q));
    double top = 0;
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
            const dvec2 cell = low + dvec2(i, j);
            const uint32_t x = whole(cell.x), y = whole(cell.y);
            const uint32_t start[3] = {x * 374761393u, y * 668265263u, (x ^ y) * 2246822519u};
            double random[3];
            for (int k = 0; k < 3; ++k) {
                const uint32_t h = (start[k] ^ start[(k + 1) % 3] >> 13) * 1274126177u;
                random[k] = ((h ^ h >> 16) % 1024) / 1023.0;
            }
            const dvec2 centre = cell + 0.3 + 0.4 * dvec2(random[0], random[1]);
            dvec2 way = turned(dvec2(q) - centre, std::acos(0.8));
            way.y *= 1.4;
            const double radius = 0.35 + 0.4 * random[2];
            const double left = radius * radius - glm::dot(way, way);
            if (left > 0) top = std::max(top, std::sqrt(left));
        }
    return top;
}

double cracks(dvec3 q)
{
    const auto crack = [](dvec2 at, double width) {
        const auto point = [](dvec2 c) {
            const double a = c.x * 3.17 + c.y * 7.31, b = c.x * 5.93 - c.y * 2.39;
            return dvec2(fraction(std::cos(a) * 913.17), fraction(std::cos(b) * 913.17)) / 2.0 + 0.25;
        };
        at += 0.12 * dvec2(std::sin(at.y * 3.1 + 0.4), std::sin(at.x * 3.1 + 0.4));
        const std::vector<dvec2> ways = ways_to_points(at, point);
        return ramp(0, width, glm::length(ways[1]) - glm::length(ways[0]));
    };
    const double wide = crack(0.7 * dvec2(q), 0.3), fine = crack(2.1 * dvec2(q) + 17.0, 0.12);
    return wide * (0.7 + 0.3 * fine) - 1;
}

} // namespace

std::span<const Twin> cell_twins()
{
    static constexpr const char* least = "a least distance, over more points than can be nearest";
    static constexpr Twin twins[] = {
        {"worley_f1", worley_f1, Borders::meet, least},
        {"worley_f2f1", worley_f2f1, Borders::meet, least},
        {"voronoi_border", voronoi_border, Borders::meet, "0 where another point becomes the nearest"},
        {"smooth_voronoi", smooth_voronoi, Borders::meet, "points that leave the window count for less than 1e-11"},
        {"voronoi_noise", voronoi_noise, Borders::meet, "weights end within the window"},
        {"crystal_cells", crystal_cells, Borders::meet, least},
        {"pebbles", pebbles, Borders::meet, "stones end within the window, at height 0"},
        {"cracks", cracks, Borders::meet, least},
    };
    return twins;
}

} // namespace haptel::ports
