#include "runtime/surface/shapes.h"

#include "runtime/geometry/finite.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr double pi = std::numbers::pi;

// A grid of (columns + 1) x (rows + 1) positions in the unit square of (u, v), facing where du x dv points.
template <class Position>
Mesh make_grid(uint32_t columns, uint32_t rows, Position&& position)
{
    Mesh mesh;
    for (uint32_t r = 0; r <= rows; ++r)
        for (uint32_t c = 0; c <= columns; ++c) {
            // The last column and row are the first ones again where the shape closes: exact, so that they weld.
            mesh.uv.emplace_back(double(c) / columns, double(r) / rows);
            mesh.positions_m.push_back(position(c, r));
        }
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            const uint32_t a = r * (columns + 1) + c, b = a + 1, d = a + columns + 1, e = d + 1;
            mesh.triangles.push_back({a, b, e});
            mesh.triangles.push_back({a, e, d});
        }
    return mesh;
}

struct Turn {
    double cosine, sine;
};

// Step k of n around the circle, exact where it closes.
Turn turn(uint32_t k, uint32_t n)
{
    const double angle = 2 * pi * double(k % n) / double(n);
    return {std::cos(angle), std::sin(angle)};
}

// Its corners 1/2 from the origin.
Mesh make_icosahedron()
{
    const double g = std::numbers::phi;
    Mesh mesh;
    mesh.positions_m = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                        {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (glm::dvec3& p : mesh.positions_m) p = 0.5 * glm::normalize(p);
    return mesh;
}

} // namespace

Mesh make_plane(uint32_t cells)
{
    const uint32_t n = std::max(cells, 1u);
    return make_grid(n, n,
                     [n](uint32_t c, uint32_t r) { return glm::dvec3(double(c) / n - 0.5, double(r) / n - 0.5, 0); });
}

Mesh make_box(const glm::dvec3& sides_m)
{
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (double sign : {-1.0, 1.0}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const uint32_t first = uint32_t(mesh.positions_m.size());
            for (double y : {-0.5, 0.5})
                for (double x : {-0.5, 0.5}) {
                    glm::dvec3 p;
                    p[axis] = 0.5 * sign;
                    p[u] = x * sign; // mirrored on the negative side, so that u x v points out of the box
                    p[v] = y;
                    mesh.positions_m.push_back(p * sides_m);
                    mesh.uv.emplace_back(x + 0.5, y + 0.5);
                }
            mesh.triangles.push_back({first, first + 1, first + 3});
            mesh.triangles.push_back({first, first + 3, first + 2});
        }
    return mesh;
}

Mesh make_sphere(uint32_t longitudes, uint32_t latitudes)
{
    const uint32_t around = std::max(longitudes, 3u), down = std::max(latitudes, 2u);
    Mesh mesh = make_grid(around, down, [=](uint32_t c, uint32_t r) {
        if (r == 0 || r == down) return glm::dvec3(0, 0, r == 0 ? -0.5 : 0.5);
        const Turn meridian = turn(c, around);
        const double polar = pi * double(r) / double(down);
        return 0.5 * glm::dvec3(std::sin(polar) * meridian.cosine, std::sin(polar) * meridian.sine, -std::cos(polar));
    });
    // At the poles a cell of the grid is one triangle; its other half has no area.
    std::erase_if(mesh.triangles, [&](const std::array<uint32_t, 3>& corner) {
        const auto same = [&](int i, int j) { return mesh.positions_m[corner[i]] == mesh.positions_m[corner[j]]; };
        return same(0, 1) || same(1, 2) || same(2, 0);
    });
    return mesh;
}

Mesh make_icosphere(uint32_t subdivisions)
{
    Mesh mesh = make_icosahedron();
    for (uint32_t level = 0; level < subdivisions; ++level) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), uint32_t(mesh.positions_m.size()));
            if (is_new) mesh.positions_m.push_back(0.5 * glm::normalize(mesh.positions_m[a] + mesh.positions_m[b]));
            return found->second;
        };
        std::vector<std::array<uint32_t, 3>> finer;
        finer.reserve(4 * mesh.triangles.size());
        for (const auto& [a, b, c] : mesh.triangles) {
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

Mesh make_geodesic(uint32_t parts)
{
    const Mesh whole = make_icosahedron();
    const uint32_t cuts = std::max(parts, 1u);
    Mesh mesh;
    // A vertex is its weights of the corners: those on edges and corners are shared by more than one face.
    using Weights = std::vector<std::pair<uint32_t, uint32_t>>;
    std::map<Weights, uint32_t> shared;
    for (const std::array<uint32_t, 3>& face : whole.triangles) {
        const auto vertex = [&](uint32_t i, uint32_t j) { // i parts toward the second corner, j toward the third
            Weights weights;
            for (const auto& [which, weight] : {std::pair{face[0], cuts - i - j}, {face[1], i}, {face[2], j}})
                if (weight > 0) weights.emplace_back(which, weight);
            std::sort(weights.begin(), weights.end());
            glm::dvec3 place(0);
            for (const auto& [which, weight] : weights) place += double(weight) * whole.positions_m[which];
            const auto next = uint32_t(mesh.positions_m.size());
            if (weights.size() < 3) {
                const auto [known, is_new] = shared.try_emplace(weights, next);
                if (!is_new) return known->second;
            }
            mesh.positions_m.push_back(0.5 * glm::normalize(place));
            return next;
        };
        std::vector<uint32_t> row;
        for (uint32_t j = 0; j <= cuts; ++j) {
            std::vector<uint32_t> next;
            for (uint32_t i = 0; i + j <= cuts; ++i) next.push_back(vertex(i, j));
            for (uint32_t i = 0; i < next.size() && j > 0; ++i) {
                mesh.triangles.push_back({row[i], row[i + 1], next[i]});
                if (i + 1 < next.size()) mesh.triangles.push_back({row[i + 1], next[i + 1], next[i]});
            }
            row = std::move(next);
        }
    }
    return mesh;
}

Mesh make_torus(double tube, uint32_t around, uint32_t tube_sides)
{
    const uint32_t columns = std::max(around, 3u), rows = std::max(tube_sides, 3u);
    const double ring_m = 0.5 / (1 + tube), tube_m = 0.5 - ring_m;
    return make_grid(columns, rows, [=](uint32_t c, uint32_t r) {
        const Turn ring = turn(c, columns), section = turn(r, rows);
        const double radius = ring_m + tube_m * section.cosine;
        return glm::dvec3(radius * ring.cosine, radius * ring.sine, tube_m * section.sine);
    });
}

std::optional<Mesh> make_shape(std::string_view name)
{
    if (name == "plane") return make_plane();
    if (name == "box") return make_box();
    if (name == "sphere") return make_sphere();
    if (name == "icosphere") return make_icosphere();
    if (name == "torus") return make_torus();
    return std::nullopt;
}

void scale_to_size(Mesh& mesh, double size_m)
{
    glm::dvec3 minimum{INFINITY}, maximum{-INFINITY};
    for (const glm::dvec3& p : mesh.positions_m) {
        if (!finite(p)) continue;
        minimum = glm::min(minimum, p);
        maximum = glm::max(maximum, p);
    }
    const glm::dvec3 sides = maximum - minimum;
    const double largest = std::max({sides.x, sides.y, sides.z});
    if (!(largest > 0) || !std::isfinite(largest)) return;
    for (glm::dvec3& p : mesh.positions_m) p *= size_m / largest;
}

} // namespace haptel::runtime
