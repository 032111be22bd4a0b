#include "runtime/geometry/predicates.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/by_number.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

namespace haptel::runtime {

namespace {

// Beyond this a bounding box or its square may overflow; nobody means it.
constexpr double coordinate_max_m = 1e100;

bool usable(const glm::dvec3& p)
{
    return std::abs(p.x) < coordinate_max_m && std::abs(p.y) < coordinate_max_m && std::abs(p.z) < coordinate_max_m;
}

using Triangle = std::array<uint32_t, 3>;

// Triangles whose corners exist and are finite, by their index in the mesh.
std::vector<size_t> sound_triangles(const Mesh& mesh, MeshReport& report)
{
    std::vector<size_t> sound;
    sound.reserve(mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        const auto exists = [&](uint32_t i) { return i < mesh.positions_m.size(); };
        const auto finite = [&](uint32_t i) { return usable(mesh.positions_m[i]); };
        if (!std::all_of(corners.begin(), corners.end(), exists))
            ++report.indices_out_of_range;
        else if (!std::all_of(corners.begin(), corners.end(), finite))
            ++report.not_finite;
        else
            sound.push_back(t);
    }
    return sound;
}

// Equal for equal coordinates, else hardly ever, whatever grid they lie on (the finisher of SplitMix64).
uint64_t mixed(const glm::dvec3& p)
{
    uint64_t mix = 0;
    for (int k = 0; k < 3; ++k) {
        mix += std::bit_cast<uint64_t>(p[k]) + 0x9e3779b97f4a7c15;
        mix = (mix ^ mix >> 30) * 0xbf58476d1ce4e5b9;
        mix = (mix ^ mix >> 27) * 0x94d049bb133111eb;
        mix ^= mix >> 31;
    }
    return mix;
}

// Rounds the used positions to the lattice and welds equal ones: vertices in order of first use by position order,
// so that the result depends on the mesh alone. Returns the vertex of each position.
std::vector<uint32_t> weld(const Mesh& mesh, const std::vector<bool>& used, Surface& surface, unsigned threads)
{
    const std::size_t count = mesh.positions_m.size();
    std::vector<glm::dvec3> snapped(count);
    std::vector<uint32_t> place(count); // such that equal ones have the same
    each_in_parallel(count, threads, [&](uint32_t i) {
        place[i] = ByNumber::none;
        if (!used[i]) return;
        snapped[i] = surface.lattice.snap_vertex(mesh.positions_m[i]) + 0.0; // no -0: equal means equal
        place[i] = uint32_t(mixed(snapped[i]) % count);
    });
    ByNumber by_place(count, count, [&](std::size_t i) { return place[i]; });
    std::vector<uint32_t>& first = place; // from now on the first position with these coordinates
    each_in_parallel(count, threads, [&](uint32_t number) {
        const auto key = [&](uint32_t i) { return std::tuple(snapped[i].x, snapped[i].y, snapped[i].z, i); };
        const std::span<uint32_t> order = by_place.of(number);
        std::ranges::sort(order, {}, key);
        for (std::size_t k = 0; k < order.size(); ++k) {
            const bool same = k > 0 && snapped[order[k]] == snapped[order[k - 1]];
            first[order[k]] = same ? first[order[k - 1]] : order[k];
        }
    });
    std::size_t vertices = 0;
    for (uint32_t i = 0; i < count; ++i) vertices += first[i] == i;
    surface.vertices.reserve(vertices);
    std::vector<uint32_t> vertex(count);
    for (uint32_t i = 0; i < count; ++i) {
        if (!used[i]) continue;
        if (first[i] == i) {
            vertex[i] = uint32_t(surface.vertices.size());
            surface.vertices.push_back(snapped[i]);
        } else {
            vertex[i] = vertex[first[i]];
        }
    }
    return vertex;
}

// Keeps the faces told, with what belongs to them. Returns how many it dropped.
size_t keep_faces(Surface& surface, const std::vector<uint8_t>& keep)
{
    if (std::find(keep.begin(), keep.end(), 0) == keep.end()) return 0;
    const auto keep_of = [&](auto& records) {
        if (records.empty()) return;
        size_t kept = 0;
        for (size_t f = 0; f < keep.size(); ++f)
            if (keep[f]) records[kept++] = records[f];
        records.resize(kept);
    };
    keep_of(surface.corner_uv);
    keep_of(surface.smoothing_groups);
    keep_of(surface.origins);
    keep_of(surface.faces);
    return keep.size() - surface.faces.size();
}

} // namespace

size_t drop_flat_faces(Surface& surface, unsigned threads)
{
    std::vector<uint8_t> keep(surface.faces.size());
    each_in_parallel(keep.size(), threads, [&](uint32_t f) {
        const auto [a, b, c] = surface.corners(f);
        keep[f] = !exact_normal(a, b, c).is_zero();
    });
    return keep_faces(surface, keep);
}

size_t drop_repeated_faces(Surface& surface, unsigned threads)
{
    const auto sorted = [&](uint32_t f) {
        Triangle corners = surface.faces[f].vertex;
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    ByNumber by_lowest(surface.vertices.size(), surface.faces.size(), [&](uint32_t f) { return sorted(f)[0]; });
    std::vector<uint8_t> keep(surface.faces.size(), 1);
    each_in_parallel(by_lowest.numbers(), threads, [&](uint32_t lowest) {
        const std::span<uint32_t> order = by_lowest.of(lowest);
        std::ranges::sort(order, {}, [&](uint32_t f) { return std::pair(sorted(f), f); });
        for (size_t k = 1; k < order.size(); ++k) keep[order[k]] = sorted(order[k]) != sorted(order[k - 1]);
    });
    return keep_faces(surface, keep);
}

bool repair(const Mesh& mesh, Surface& surface, MeshReport& report, unsigned threads)
{
    report.triangles_given = mesh.triangles.size();
    const std::vector<size_t> sound = sound_triangles(mesh, report);
    if (sound.empty()) return false;

    std::vector<bool> used(mesh.positions_m.size());
    glm::dvec3 minimum = mesh.positions_m[mesh.triangles[sound[0]][0]], maximum = minimum;
    for (size_t t : sound)
        for (uint32_t i : mesh.triangles[t]) {
            used[i] = true;
            minimum = glm::min(minimum, mesh.positions_m[i]);
            maximum = glm::max(maximum, mesh.positions_m[i]);
        }
    surface.lattice = Lattice::around(minimum, maximum);
    const std::vector<uint32_t> vertex = weld(mesh, used, surface, threads);

    const bool has_uv = mesh.uv.size() == mesh.positions_m.size();
    const bool has_groups = mesh.smoothing_groups.size() == mesh.triangles.size();
    const bool has_origins = mesh.origins.size() == mesh.triangles.size();
    surface.faces.reserve(sound.size());
    if (has_uv) surface.corner_uv.reserve(sound.size());
    if (has_groups) surface.smoothing_groups.reserve(sound.size());
    if (has_origins) surface.origins.reserve(sound.size());
    for (size_t t : sound) {
        const Triangle& given = mesh.triangles[t];
        surface.faces.emplace_back().vertex = {vertex[given[0]], vertex[given[1]], vertex[given[2]]};
        if (has_groups) surface.smoothing_groups.push_back(mesh.smoothing_groups[t]);
        if (has_origins) surface.origins.push_back(mesh.origins[t]);
        if (!has_uv) continue;
        std::array<glm::dvec2, 3> uv;
        for (size_t i = 0; i < 3; ++i) {
            uv[i] = mesh.uv[given[i]];
            if (!std::isfinite(uv[i].x) || !std::isfinite(uv[i].y)) uv[i] = {0, 0};
        }
        surface.corner_uv.push_back(uv);
    }
    report.degenerate = drop_flat_faces(surface, threads);
    report.duplicate = drop_repeated_faces(surface, threads);
    if (surface.faces.empty()) return false;

    // The box of what is left; vertices of dropped triangles stay, unused and harmless, but do not widen it.
    surface.box_minimum_m = surface.box_maximum_m = surface.vertex_m(0, 0);
    for (const Face& face : surface.faces)
        for (uint32_t i : face.vertex) {
            const glm::dvec3 p_m = surface.lattice.metres(surface.vertices[i]);
            surface.box_minimum_m = glm::min(surface.box_minimum_m, p_m);
            surface.box_maximum_m = glm::max(surface.box_maximum_m, p_m);
        }
    return true;
}

} // namespace haptel::runtime
