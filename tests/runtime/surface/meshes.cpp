#include "tests/runtime/surface/meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace haptel::test {

using glm::dvec3;
using runtime::Mesh;

double bumpy_radius(const dvec3& d)
{
    return 1 + 0.02 * std::sin(7 * d.x + 1) * std::sin(9 * d.y) * std::sin(8 * d.z + 2) +
           0.02 * std::sin(11 * d.x * d.y + 3 * d.z);
}

Mesh make_bumpy_sphere(uint32_t subdivisions)
{
    Mesh mesh = runtime::make_icosphere(subdivisions);
    for (dvec3& p : mesh.positions_m) p = glm::normalize(p) * bumpy_radius(glm::normalize(p));
    return mesh;
}

Mesh make_star(uint32_t subdivisions)
{
    Mesh mesh = runtime::make_icosphere(subdivisions);
    std::mt19937 random(3);
    for (dvec3& p : mesh.positions_m) p = glm::normalize(p) * (0.3 + 0.7 * double(random()) / 4294967296.0);
    return mesh;
}

Mesh make_stairs()
{
    // Counter-clockwise; the caps are cut by hand from this profile, each triangle counter-clockwise.
    const std::vector<glm::dvec2> profile = {{0, 0}, {8, 0}, {8, 1}, {7, 1}, {7, 2}, {6, 2},
                                             {6, 3}, {5, 3}, {4, 1}, {3, 3}, {3, 4}, {0, 4}};
    const std::vector<std::array<uint32_t, 3>> cap = {{1, 2, 3}, {3, 4, 5}, {5, 6, 7}, {1, 3, 8},  {3, 5, 8},
                                                      {5, 7, 8}, {0, 1, 8}, {0, 8, 9}, {0, 9, 11}, {9, 10, 11}};
    const uint32_t n = uint32_t(profile.size()), levels = 4;
    Mesh mesh;
    for (uint32_t z = 0; z <= levels; ++z)
        for (const glm::dvec2& p : profile) mesh.positions_m.emplace_back(p, z);
    for (uint32_t z = 0; z < levels; ++z)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = z * n + i, b = z * n + (i + 1) % n;
            mesh.triangles.push_back({a, b, b + n});
            mesh.triangles.push_back({a, b + n, a + n});
        }
    for (const auto& [a, b, c] : cap) {
        mesh.triangles.push_back({a + levels * n, b + levels * n, c + levels * n});
        mesh.triangles.push_back({c, b, a});
    }
    return mesh;
}

Mesh make_touching_cubes(Touching touching)
{
    Mesh mesh;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            for (int z = 0; z < 3; ++z) {
                const bool even = (x + y + z) % 2 == 0, level = x % 2 == y % 2 && y % 2 == z % 2;
                if (touching == Touching::edges ? !even : !level) continue;
                const Mesh cube = runtime::make_box();
                const uint32_t first = uint32_t(mesh.positions_m.size());
                for (const dvec3& p : cube.positions_m) mesh.positions_m.push_back(p + dvec3(x, y, z));
                for (const auto& [a, b, c] : cube.triangles)
                    mesh.triangles.push_back({a + first, b + first, c + first});
            }
    return mesh;
}

Mesh make_crossing_boxes()
{
    Mesh mesh;
    for (int k = 0; k < 3; ++k) {
        const Mesh box = runtime::make_box({1, 0.6, 0.4});
        const double angle = 0.7 * k + 0.1;
        const uint32_t first = uint32_t(mesh.positions_m.size());
        for (const dvec3& p : box.positions_m)
            mesh.positions_m.emplace_back(p.x * std::cos(angle) - p.y * std::sin(angle),
                                          p.x * std::sin(angle) + p.y * std::cos(angle), p.z + 0.15 * k);
        for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
    }
    return mesh;
}

namespace {

void add(Mesh& mesh, const Mesh& other, const dvec3& by_m = dvec3(0))
{
    const uint32_t first = uint32_t(mesh.positions_m.size());
    for (const dvec3& p : other.positions_m) mesh.positions_m.push_back(p + by_m);
    for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

// A wavy square whose rows have twice as many cells as the row before: every other vertex of a row's far side lies on
// the middle of an edge of the next.
Mesh make_t_junctions()
{
    Mesh mesh;
    for (int row = 0; row < 4; ++row) {
        const int cells = 2 << row;
        const uint32_t first = uint32_t(mesh.positions_m.size());
        for (int y = row; y <= row + 1; ++y)
            for (int i = 0; i <= cells; ++i) mesh.positions_m.emplace_back(4.0 * i / cells, y, 0.3 * std::sin(y));
        for (int i = 0; i < cells; ++i) {
            const uint32_t a = first + uint32_t(i), c = a + uint32_t(cells) + 1;
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
    }
    return mesh;
}

Mesh make_soup(uint32_t seed, int triangles, double size)
{
    std::mt19937 random(seed);
    const auto point = [&] {
        return dvec3(double(random()) / 4294967296.0, double(random()) / 4294967296.0, double(random()) / 4294967296.0);
    };
    Mesh mesh;
    for (int i = 0; i < triangles; ++i) {
        const dvec3 centre = point();
        for (int k = 0; k < 3; ++k) mesh.positions_m.push_back(centre + size * (point() - 0.5));
        const uint32_t first = uint32_t(mesh.positions_m.size()) - 3;
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

// Two balls that share a vertex and cross each other there.
Mesh make_crossing_in_a_vertex()
{
    Mesh pair = runtime::make_icosphere(1);
    const Mesh other = runtime::make_icosphere(1);
    add(pair, other, pair.positions_m[0] - other.positions_m[20]);
    return pair;
}

// A strip with half a twist.
Mesh make_moebius_strip()
{
    Mesh mesh;
    const uint32_t n = 24;
    for (uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        const dvec3 out(std::cos(angle), std::sin(angle), 0);
        const dvec3 across = 0.3 * (std::cos(angle / 2) * out + std::sin(angle / 2) * dvec3(0, 0, 1));
        mesh.positions_m.push_back(out - across);
        mesh.positions_m.push_back(out + across);
    }
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t a = 2 * i, b = a + 1;
        const uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
        mesh.triangles.push_back({a, c, d});
        mesh.triangles.push_back({a, d, b});
    }
    return mesh;
}

// Parts of what is to be joined, each where it lies; all are turned at odd angles at the end,
// so that no plane is level along an axis within rounding: there the accomplice's grid cannot tell its sides.
class Joined {
public:
    void add(const Mesh& part, const dvec3& at_m)
    {
        test::add(mesh_, part, at_m);
        for (uint32_t f = 0; f < part.triangles.size(); ++f) mesh_.origins.push_back({parts_, f});
        ++parts_;
    }
    Mesh turned() const
    {
        const double a = 0.7, b = 0.4, c = 0.3;
        Mesh mesh = mesh_;
        for (dvec3& p : mesh.positions_m) {
            p = {std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y, p.z};
            p = {p.x, std::cos(b) * p.y - std::sin(b) * p.z, std::sin(b) * p.y + std::cos(b) * p.z};
            p = {std::cos(c) * p.x + std::sin(c) * p.z, p.y, std::cos(c) * p.z - std::sin(c) * p.x};
        }
        return mesh;
    }

private:
    Mesh mesh_;
    uint32_t parts_ = 0;
};

void add_joined(std::vector<NamedMesh>& meshes)
{
    using runtime::make_box;
    Joined stacked;
    stacked.add(make_box(), {0, 0, 0});
    stacked.add(make_box({1, 0.6, 1}), {1, 0.1, 0});
    stacked.add(make_box(), {0.4, 0.2, 1});
    meshes.push_back({"joined: two boxes under a third", stacked.turned()});

    Joined sunk;
    sunk.add(make_box({2, 2, 1}), {0, 0, -0.5});
    sunk.add(runtime::make_icosphere(2), {0.1, 0.05, 0.1});
    meshes.push_back({"joined: a ball sunk in a box", sunk.turned()});

    Joined tiles;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) tiles.add(make_box({1, 1, 0.2}), {x + (y == 1 ? 0.3 : 0.0), y, 0});
    meshes.push_back({"joined: tiles", tiles.turned()});
    meshes.push_back({"joined: tiles far away", far_away(tiles.turned())});

    Joined crossing;
    crossing.add(make_box({1, 0.6, 0.4}), {0, 0, 0});
    crossing.add(make_box({0.5, 1.1, 0.3}), {0.1, 0.05, 0.02});
    crossing.add(make_box({0.3, 0.2, 1.2}), {0.2, 0.1, 0.1});
    meshes.push_back({"joined: three boxes cross", crossing.turned()});

    Joined corner;
    corner.add(make_box({2, 2, 0.2}), {0, 0, -0.1});
    corner.add(make_box({0.2, 2, 1}), {-0.9, 0, 0.5});
    corner.add(make_box({0.5, 0.5, 0.5}), {-0.55, 0.3, 0.25});
    meshes.push_back({"joined: a box in a corner of two", corner.turned()});

    Joined touching; // the octahedron's lowest corner
    Mesh octahedron = runtime::make_sphere(4, 2);
    touching.add(runtime::make_plane(2), {0, 0, 0});
    touching.add(octahedron, {0.1, 0.2, 0.5});
    meshes.push_back({"joined: a corner on a plane", touching.turned()});

    Joined standing;
    standing.add(runtime::make_plane(3), {0, 0, 0});
    standing.add(make_box({0.3, 0.3, 0.3}), {0.1, 0.05, 0.15});
    meshes.push_back({"joined: a box on an open plane", standing.turned()});
}

} // namespace

std::vector<NamedMesh> make_hard_meshes()
{
    std::vector<NamedMesh> meshes;
    meshes.push_back({"crossing boxes", make_crossing_boxes()});

    Mesh stars = make_star(1);
    add(stars, make_star(1), {0.21, 0.13, 0.17});
    meshes.push_back({"stars that pierce each other", stars});

    meshes.push_back({"balls that cross in a vertex", make_crossing_in_a_vertex()});

    Mesh bowls = runtime::make_icosphere(2);
    add(bowls, runtime::make_torus(0.4, 16, 8), {0.1, 0.05, 0.2});
    meshes.push_back({"a ball through a torus", bowls});

    meshes.push_back({"T-junctions", make_t_junctions()});

    Mesh open = make_bumpy_sphere(2);
    std::erase_if(open.triangles, [&](const auto& t) { return open.positions_m[t[0]].z > 0.6; });
    meshes.push_back({"open bowl", open});

    Mesh holes = make_star(2);
    for (size_t i = 0; i < holes.triangles.size(); i += 5) holes.triangles.erase(holes.triangles.begin() + long(i));
    meshes.push_back({"star with holes", holes});

    meshes.push_back({"Moebius strip", make_moebius_strip()});

    Mesh random_winding = make_star(2);
    for (size_t i = 0; i < random_winding.triangles.size(); i += 3)
        std::swap(random_winding.triangles[i][0], random_winding.triangles[i][1]);
    meshes.push_back({"star wound at random", random_winding});

    Mesh twice = runtime::make_box();
    for (size_t i = 0; i + 1 < twice.triangles.size(); i += 2) { // the quads' other diagonals
        const auto s = twice.triangles[i], t = twice.triangles[i + 1];
        twice.triangles.push_back({s[0], s[1], t[2]});
        twice.triangles.push_back({s[1], s[2], t[2]});
        if (i >= 10) break;
    }
    meshes.push_back({"box given twice, other diagonals", twice});

    Mesh book; // many faces at one edge, one vertex
    book.positions_m = {{0, 0, 0}, {0, 0, 1}};
    for (uint32_t i = 0; i < 9; ++i) {
        const double angle = i < 7 ? 0.9 * i : 0.9 + 1e-2 * i;
        book.positions_m.emplace_back(std::cos(angle), std::sin(angle), 0.1 * i);
        book.triangles.push_back(i % 2 ? std::array{0u, 1u, i + 2} : std::array{i + 2, 1u, 0u});
    }
    meshes.push_back({"book", book});

    Mesh slivers = runtime::make_sphere(300, 3);
    for (dvec3& p : slivers.positions_m) p.z *= 1e-3;
    meshes.push_back({"slivers", slivers});

    meshes.push_back({"needles", make_soup(5, 60, 1.0)});
    for (size_t i = 0; i < meshes.back().mesh.positions_m.size(); i += 3) {
        auto& p = meshes.back().mesh.positions_m;
        p[i + 2] = 0.5 * (p[i] + p[i + 1]) + 1e-8 * (p[i + 2] - p[i]);
    }
    meshes.push_back({"soup", make_soup(6, 150, 0.4)});
    meshes.push_back({"soup far away", far_away(make_soup(7, 150, 0.4))});
    add_joined(meshes);
    return meshes;
}

Mesh far_away(Mesh mesh)
{
    for (dvec3& p : mesh.positions_m) p += dvec3(1e4, -1e4, 1e4);
    return mesh;
}

std::shared_ptr<const runtime::Surface> surface_of(const Mesh& mesh)
{
    runtime::SurfaceResult result = runtime::build_surface(mesh);
    if (!result.surface) throw std::runtime_error(result.error);
    return result.surface;
}

Winding winding(const runtime::Surface& surface, const dvec3& point_m)
{
    Winding result{0, INFINITY};
    for (uint32_t f = 0; f < surface.faces.size(); ++f) {
        const dvec3 a = surface.vertex_m(f, 0) - point_m, b = surface.vertex_m(f, 1) - point_m,
                    c = surface.vertex_m(f, 2) - point_m;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        result.number += std::atan2(glm::dot(a, glm::cross(b, c)),
                                    la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb) /
                         (2 * std::numbers::pi);

        const dvec3 n = glm::normalize(glm::cross(b - a, c - a)), foot = glm::dot(a, n) * n;
        const auto inside = [&](const dvec3& from, const dvec3& to) {
            return glm::dot(glm::cross(n, to - from), foot - from) >= 0;
        };
        const auto to_edge = [](const dvec3& from, const dvec3& to) {
            const dvec3 e = to - from;
            return glm::length(from + glm::clamp(-glm::dot(from, e) / glm::dot(e, e), 0.0, 1.0) * e);
        };
        const bool over = inside(a, b) && inside(b, c) && inside(c, a);
        result.distance_m = std::min(result.distance_m, over ? glm::length(foot)
                                                             : std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)}));
    }
    return result;
}

} // namespace haptel::test
