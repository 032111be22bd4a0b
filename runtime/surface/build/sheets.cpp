// Parts sheets that cross each other in a vertex that they share. Around such a vertex neither links nor walls tell
// which sheet is in the way: the one takes the sheets to meet in the vertex only, the other needs a distance to keep.
// Each sheet is given a corner of its own, a little apart, and then they pierce each other like any others.
#include "runtime/geometry/predicates.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace haptel::runtime {

namespace {

// More than all tolerances together, and less than 4e-9 of the half extent.
constexpr double apart = 4096;

// Around more faces the search for sheets would take too long.
constexpr size_t most_faces = 1000;

// The one vertex that two faces share; none if it is not one.
constexpr uint32_t none = ~0u;
uint32_t only_shared_vertex(const Face& a, const Face& b)
{
    uint32_t shared = none;
    for (uint32_t v : a.vertex) {
        if (std::find(b.vertex.begin(), b.vertex.end(), v) == b.vertex.end()) continue;
        if (shared != none) return none;
        shared = v;
    }
    return shared;
}

using Faces = std::vector<uint32_t>;

// The faces at a vertex in sheets: those joined by edges at the vertex. In order of their lowest faces.
std::vector<Faces> sheets_at(const Surface& surface, uint32_t vertex, const Faces& faces)
{
    std::vector<Faces> sheets;
    std::vector<bool> taken(faces.size());
    for (size_t first = 0; first < faces.size(); ++first) {
        if (taken[first]) continue;
        taken[first] = true;
        Faces sheet{faces[first]};
        for (size_t next_one = 0; next_one < sheet.size(); ++next_one)
            for (size_t k = 0; k < faces.size(); ++k) {
                if (taken[k]) continue;
                const Face &a = surface.faces[sheet[next_one]], &b = surface.faces[faces[k]];
                const bool joined = std::any_of(a.vertex.begin(), a.vertex.end(), [&](uint32_t v) {
                    return v != vertex && std::find(b.vertex.begin(), b.vertex.end(), v) != b.vertex.end();
                });
                if (!joined) continue;
                taken[k] = true;
                sheet.push_back(faces[k]);
            }
        sheets.push_back(std::move(sheet));
    }
    return sheets;
}

// Gives the sheet a corner of its own, off along its normal. Not if that would cost a face its area.
void part(Surface& surface, uint32_t vertex, const Faces& sheet, double way)
{
    glm::dvec3 normal{0};
    for (uint32_t f : sheet) normal += surface.faces[f].normal;
    const double length = glm::length(normal);
    normal = length > 1e-6 ? normal / length : surface.faces[sheet[0]].normal;
    const double spacing = Lattice::vertex_spacing;
    const glm::dvec3 place = surface.vertices[vertex] + glm::round(way / spacing * normal) * spacing;

    const uint32_t own = uint32_t(surface.vertices.size());
    surface.vertices.push_back(place);
    for (int trial = 0; trial < 2; ++trial)
        for (uint32_t f : sheet) {
            std::array<uint32_t, 3> corners = surface.faces[f].vertex;
            std::replace(corners.begin(), corners.end(), vertex, own);
            const auto& v = surface.vertices;
            if (trial == 0 && exact_normal(v[corners[0]], v[corners[1]], v[corners[2]]).is_zero()) return;
            if (trial == 1) surface.faces[f].vertex = corners;
        }
    surface.box_minimum = glm::min(surface.box_minimum, place);
    surface.box_maximum = glm::max(surface.box_maximum, place);
    surface.box_minimum_m = surface.lattice.metres(surface.box_minimum);
    surface.box_maximum_m = surface.lattice.metres(surface.box_maximum);
}

} // namespace

bool part_crossing_sheets(Surface& surface, BuildWork& work)
{
    if (!work.begin("which of its sheets cross in a vertex")) return false;
    std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> crossings; // by vertex
    for (uint32_t f = 0; f < surface.faces.size(); ++f) {
        const Face& face = surface.faces[f];
        for (uint32_t k = face.pierced_begin; k < face.pierced_end; ++k) {
            const uint32_t vertex = only_shared_vertex(face, surface.faces[surface.pierced_by[k]]);
            if (vertex != none) crossings[vertex].emplace_back(f, surface.pierced_by[k]);
        }
    }
    if (crossings.empty()) return false;

    std::map<uint32_t, Faces> around;
    for (uint32_t f = 0; f < surface.faces.size(); ++f)
        for (uint32_t v : surface.faces[f].vertex)
            if (crossings.count(v)) around[v].push_back(f);
    const size_t before = surface.vertices.size();
    for (const auto& [vertex, faces] : around) {
        if (faces.size() > most_faces) continue;
        const auto& pairs = crossings[vertex];
        if (!work.spend(faces.size() * faces.size() + pairs.size())) return false;
        const std::vector<Faces> sheets = sheets_at(surface, vertex, faces);
        std::map<uint32_t, size_t> sheet_of; // by face
        for (size_t k = 0; k < sheets.size(); ++k)
            for (const uint32_t face : sheets[k]) sheet_of[face] = k;
        if (std::all_of(pairs.begin(), pairs.end(),
                        [&](const auto& pair) { return sheet_of.at(pair.first) == sheet_of.at(pair.second); }))
            continue;
        for (size_t k = 1; k < sheets.size(); ++k) part(surface, vertex, sheets[k], double(k) * apart);
    }
    return surface.vertices.size() > before;
}

} // namespace haptel::runtime
