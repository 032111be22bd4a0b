#include "runtime/surface/build/joined_surfaces.h"

#include "runtime/surface/build/build.h"
#include "runtime/surface/build/groups.h"
#include "runtime/surface/build/meeting.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace haptel::runtime {

namespace {

// Boxes are taken to overlap from here on, as a share of their size: more than what joining lets surfaces miss by.
constexpr double margin = 1e-5;

// The surfaces' own faces as they lie in the common space.
Mesh placed_together(std::span<const PlacedSurface> surfaces, std::span<const uint32_t> numbers)
{
    Mesh mesh;
    for (uint32_t part = 0; part < numbers.size(); ++part) {
        const auto& [surface, placement] = surfaces[numbers[part]];
        const auto first = uint32_t(mesh.positions_m.size());
        for (const glm::dvec3& vertex : surface->vertices)
            mesh.positions_m.push_back(placement.to_world(surface->lattice.metres(vertex)));
        for (uint32_t f = 0; f < surface->faces.size(); ++f) {
            const auto& v = surface->faces[f].vertex;
            mesh.triangles.push_back({first + v[0], first + v[1], first + v[2]});
            mesh.origins.push_back({part, f});
        }
    }
    return mesh;
}

struct PlacedBox {
    glm::dvec3 minimum{std::numeric_limits<double>::infinity()}, maximum{-std::numeric_limits<double>::infinity()};

    explicit PlacedBox(const PlacedSurface& placed)
    {
        const Surface& surface = *placed.surface;
        for (const glm::dvec3& vertex : surface.vertices) {
            const glm::dvec3 p = placed.placement.to_world(surface.lattice.metres(vertex));
            minimum = glm::min(minimum, p);
            maximum = glm::max(maximum, p);
        }
        const glm::dvec3 more(margin * glm::distance(minimum, maximum));
        minimum -= more;
        maximum += more;
    }
    bool meets(const PlacedBox& other) const
    {
        return glm::all(glm::lessThanEqual(minimum, other.maximum)) &&
               glm::all(glm::lessThanEqual(other.minimum, maximum));
    }
};

// Calls visit(one, other) for each two whose boxes meet, and ends where it returns false.
template <class Visit>
void for_each_overlap(std::span<const PlacedBox> boxes, Visit&& visit)
{
    std::vector<uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](uint32_t i) { return std::pair(boxes[i].minimum.x, i); });
    for (size_t i = 0; i < order.size(); ++i)
        for (size_t k = i + 1; k < order.size() && boxes[order[k]].minimum.x <= boxes[order[i]].maximum.x; ++k)
            if (boxes[order[i]].meets(boxes[order[k]]) && !visit(order[i], order[k])) return;
}

// As wide as the ball that a point is on a surface of the two.
double slit_m(const PlacedBox& one, const PlacedBox& other)
{
    const Lattice lattice = Lattice::around(glm::min(one.minimum, other.minimum), glm::max(one.maximum, other.maximum));
    return 2 * Lattice::point_radius * lattice.unit_m;
}

// Of what is there twice both are felt.
bool is_same(const PlacedSurface& one, const PlacedSurface& other)
{
    return one.surface == other.surface && one.placement.rotation == other.placement.rotation &&
           one.placement.position_m == other.placement.position_m;
}

} // namespace

std::vector<MeetingSurfaces> find_meeting(std::span<const PlacedSurface> surfaces, const Loading* loading)
{
    const std::vector<PlacedBox> boxes(surfaces.begin(), surfaces.end());
    Groups near(surfaces.size()), meeting(surfaces.size());
    for_each_overlap(boxes, [&](uint32_t one, uint32_t other) {
        near.unite(one, other);
        return !(loading && loading->stopped());
    });
    std::map<uint32_t, BuildWork> work_of; // by the first of those near each other
    for_each_overlap(boxes, [&](uint32_t one, uint32_t other) {
        const auto [at, is_new] = work_of.try_emplace(near.first(one), BuildWork::of_joining, loading);
        BuildWork& work = at->second;
        if (is_new) work.begin("which of its parts meet");
        if (work.spend() && !meeting.are_together(one, other) && !is_same(surfaces[one], surfaces[other]) &&
            meet(*surfaces[one].surface, surfaces[one].placement, *surfaces[other].surface, surfaces[other].placement,
                 slit_m(boxes[one], boxes[other]), work))
            meeting.unite(one, other);
        return !(loading && loading->stopped());
    });

    std::vector<MeetingSurfaces> found;
    for (const std::vector<uint32_t>& group : near.groups())
        if (const auto at = work_of.find(near.first(group[0])); at != work_of.end() && at->second.over())
            found.push_back({group, at->second.error()});
    for (std::vector<uint32_t>& group : meeting.groups()) {
        if (work_of.at(near.first(group[0])).over()) continue; // told above
        size_t triangles = 0;
        for (const uint32_t number : group) triangles += surfaces[number].surface->faces.size();
        std::string error;
        if (triangles > joined_triangles_max)
            error = "together they have more than " + std::to_string(joined_triangles_max / 1'000'000) +
                    " million triangles";
        found.push_back({std::move(group), std::move(error)});
    }
    return found;
}

SurfaceResult join(std::span<const PlacedSurface> surfaces, std::span<const uint32_t> numbers, const Loading* loading)
{
    return build_surface(placed_together(surfaces, numbers), default_crease_deg, loading);
}

} // namespace haptel::runtime
