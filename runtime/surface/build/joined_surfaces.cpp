#include "runtime/surface/build/joined_surfaces.h"

#include "runtime/surface/build/build.h"

#include <algorithm>
#include <limits>
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

struct Box {
    glm::dvec3 minimum{std::numeric_limits<double>::infinity()}, maximum{-std::numeric_limits<double>::infinity()};

    explicit Box(const PlacedSurface& placed)
    {
        const Surface& surface = *placed.surface;
        for (const Face& face : surface.faces)
            for (uint32_t i : face.vertex) {
                const glm::dvec3 p = placed.placement.to_world(surface.lattice.metres(surface.vertices[i]));
                minimum = glm::min(minimum, p);
                maximum = glm::max(maximum, p);
            }
        const glm::dvec3 more(margin * glm::distance(minimum, maximum));
        minimum -= more;
        maximum += more;
    }
    bool meets(const Box& other) const
    {
        return glm::all(glm::lessThanEqual(minimum, other.maximum)) &&
               glm::all(glm::lessThanEqual(other.minimum, maximum));
    }
};

// Who belongs together, directly or by others.
class Groups {
public:
    explicit Groups(std::size_t count) : first_(count) { std::iota(first_.begin(), first_.end(), 0u); }

    void unite(uint32_t one, uint32_t other)
    {
        const auto [low, high] = std::minmax({first(one), first(other)});
        first_[high] = low;
    }
    // Those of more than one, in rising order.
    std::vector<std::vector<uint32_t>> groups()
    {
        std::vector<std::vector<uint32_t>> all(first_.size());
        for (uint32_t i = 0; i < first_.size(); ++i) all[first(i)].push_back(i);
        std::erase_if(all, [](const auto& group) { return group.size() < 2; });
        return all;
    }

private:
    uint32_t first(uint32_t i)
    {
        while (first_[i] != i) i = first_[i] = first_[first_[i]];
        return i;
    }

    std::vector<uint32_t> first_;
};

std::vector<std::vector<uint32_t>> groups_of_overlapping_boxes(std::span<const PlacedSurface> surfaces)
{
    std::vector<Box> boxes(surfaces.begin(), surfaces.end());
    std::vector<uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const double x = boxes[a].minimum.x, y = boxes[b].minimum.x;
        return x != y ? x < y : a < b;
    });
    Groups together(boxes.size());
    for (size_t i = 0; i < order.size(); ++i)
        for (size_t k = i + 1; k < order.size() && boxes[order[k]].minimum.x <= boxes[order[i]].maximum.x; ++k)
            if (boxes[order[i]].meets(boxes[order[k]])) together.unite(order[i], order[k]);
    return together.groups();
}

} // namespace

std::vector<MeetingSurfaces> find_meeting(std::span<const PlacedSurface> surfaces, const Loading* loading)
{
    std::vector<MeetingSurfaces> found;
    for (const std::vector<uint32_t>& near : groups_of_overlapping_boxes(surfaces)) {
        size_t triangles = 0;
        for (uint32_t number : near) triangles += surfaces[number].surface->faces.size();
        if (triangles > joined_triangles_max) {
            found.push_back({near, "together they have more than " + std::to_string(joined_triangles_max / 1'000'000) +
                                       " million triangles"});
            continue;
        }
        Surface together;
        MeshReport report;
        std::string error;
        if (!repair(placed_together(surfaces, near), together, report)) continue;
        BuildWork work = BuildWork::of_joining(loading);
        Groups meeting(near.size());
        for (const auto& [one, other] : meeting_parts(together, error, work)) meeting.unite(one, other);
        if (work.over()) error = work.error();
        if (!error.empty()) {
            found.push_back({near, error});
            continue;
        }
        for (std::vector<uint32_t>& group : meeting.groups()) {
            for (uint32_t& number : group) number = near[number];
            found.push_back({std::move(group), {}});
        }
    }
    return found;
}

SurfaceResult join(std::span<const PlacedSurface> surfaces, std::span<const uint32_t> numbers, const Loading* loading)
{
    return build_surface(placed_together(surfaces, numbers), default_crease_deg, loading);
}

} // namespace haptel::runtime
