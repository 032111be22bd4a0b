#include "runtime/surface/build/build.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr uint32_t no_fan = ~0u;

// A new fan from one of its corners, which are told its number.
void add_fan(Surface& surface, const Sector& start)
{
    const uint32_t index = uint32_t(surface.fans.size());
    glm::dvec3 sum{0};
    for_each_sector(surface, start, [&](const Sector& sector) {
        Face& face = surface.faces[sector.face];
        sum += weighted_normal(surface, sector);
        face.fan[sector.corner][sector.side] = index;
    });
    const double length = glm::length(sum);
    surface.fans.push_back({length > 1e-9 ? sum / length : glm::dvec3(0), start.face, start.corner, start.side, index});
}

// The fans at one vertex. Two that share a face are the two sides of one sheet; sheets meet in the vertex only.
class FansAtVertex {
public:
    FansAtVertex(Surface& surface, std::vector<uint32_t> fans)
        : surface_(surface), fans_(std::move(fans)), sheet_(fans_.size()), circle_(fans_.size())
    {
        std::iota(sheet_.begin(), sheet_.end(), size_t{0});
        std::iota(circle_.begin(), circle_.end(), size_t{0});
        for (size_t i = 0; i < fans_.size(); ++i)
            for_each_sector(surface_, start(i), [&](const Sector& sector) {
                ++sectors_;
                const uint32_t back = surface_.faces[sector.face].fan[sector.corner][1 - sector.side];
                const auto j = static_cast<size_t>(std::lower_bound(fans_.begin(), fans_.end(), back) - fans_.begin());
                unite(sheet_, i, j);
            });
        for (size_t i = 0; i < fans_.size(); ++i) sheet_[i] = first(sheet_, i);
    }

    // Joins the fans of different sheets that see each other, unless a third sheet stands between. False: it is over.
    bool join(BuildWork& work)
    {
        const size_t count = fans_.size();
        if (std::all_of(sheet_.begin(), sheet_.end(), [](size_t sheet) { return sheet == 0; })) return true;
        if (!work.spend(8 * sectors_ * count)) return false;
        // From along each fan, which of the other sheets' fans are seen.
        std::vector<std::vector<bool>> seen_from(count, std::vector<bool>(count));
        for (size_t j = 0; j < count; ++j) {
            const glm::dvec3 along = direction(j);
            for (size_t k = 0; k < count; ++k)
                if (sheet_[k] != sheet_[j]) seen_from[j][k] = sees(k, along);
        }
        for (size_t i = 0; i < count; ++i)
            for (size_t j = 0; j < i; ++j) {
                if (sheet_[i] == sheet_[j] || !seen_from[j][i] || !seen_from[i][j]) continue;
                if (first(circle_, i) == first(circle_, j)) continue;
                if (!work.spend(1 + count / 8)) return false;
                if (!same_space(seen_from[i], seen_from[j], i, j)) continue;
                unite(circle_, i, j);
                std::swap(surface_.fans[fans_[i]].next, surface_.fans[fans_[j]].next);
            }
        return true;
    }

private:
    Sector start(size_t i) const
    {
        const Fan& fan = surface_.fans[fans_[i]];
        return {fan.face, fan.corner, fan.side};
    }

    // Some direction from the vertex along the sheet of the fan.
    glm::dvec3 direction(size_t i) const
    {
        const Sector sector = start(i);
        const auto& corners = surface_.faces[sector.face].vertex;
        const glm::dvec3& at = surface_.vertices[corners[sector.corner]];
        return glm::normalize(surface_.vertices[corners[next(sector.corner)]] - at) +
               glm::normalize(surface_.vertices[corners[previous(sector.corner)]] - at);
    }

    // Whether the direction, which is not on the fan's sheet, leads to the side that the fan sees: of an open fan both
    // sides are one space, around its borders.
    bool sees(size_t i, const glm::dvec3& direction) const
    {
        NearestInFan nearest;
        const bool closed = nearest.consider(surface_, start(i), direction);
        if (!closed) return true;
        if (nearest.way == 0) return glm::dot(surface_.fans[fans_[i]].normal, direction) > 0;
        const Sector& sector = nearest.sector;
        glm::dvec3 outward = surface_.facet_normal(sector.face, sector.side);
        if (nearest.edge != NearestInFan::into_sector) {
            const SideEdge link = surface_.faces[sector.face].link[nearest.edge][sector.side];
            outward += surface_.facet_normal(link.face(), link.side());
        }
        return glm::dot(outward, direction) > 0;
    }

    // Whether every third sheet sees both or neither.
    bool same_space(const std::vector<bool>& of_i, const std::vector<bool>& of_j, size_t i, size_t j) const
    {
        for (size_t k = 0; k < fans_.size(); ++k)
            if (of_i[k] != of_j[k] && sheet_[k] != sheet_[i] && sheet_[k] != sheet_[j]) return false;
        return true;
    }

    static size_t first(std::vector<size_t>& of, size_t i)
    {
        while (of[i] != i) i = of[i] = of[of[i]];
        return i;
    }
    static void unite(std::vector<size_t>& of, size_t i, size_t j)
    {
        const auto [low, high] = std::minmax({first(of, i), first(of, j)});
        of[high] = low;
    }

    Surface& surface_;
    std::vector<uint32_t> fans_;
    // For each fan the first of its sheet, and on the way to the first of its circle of `next`.
    std::vector<size_t> sheet_, circle_;
    size_t sectors_ = 0; // of all fans
};

} // namespace

void make_fans(Surface& surface, BuildWork& work)
{
    if (!work.begin("which of its sheets meet in a vertex")) return;
    for (Face& face : surface.faces) face.fan = {{{no_fan, no_fan}, {no_fan, no_fan}, {no_fan, no_fan}}};
    std::vector<std::pair<uint32_t, uint32_t>> at_vertex; // vertex, fan
    for (uint32_t f = 0; f < surface.faces.size(); ++f)
        for (uint32_t corner = 0; corner < 3; ++corner)
            for (uint32_t side = 0; side < 2; ++side) {
                if (surface.faces[f].fan[corner][side] != no_fan) continue;
                at_vertex.emplace_back(surface.faces[f].vertex[corner], uint32_t(surface.fans.size()));
                add_fan(surface, {f, corner, side});
            }

    std::sort(at_vertex.begin(), at_vertex.end());
    for (size_t begin = 0, end; begin < at_vertex.size(); begin = end) {
        std::vector<uint32_t> fans;
        for (end = begin; end < at_vertex.size() && at_vertex[end].first == at_vertex[begin].first; ++end)
            fans.push_back(at_vertex[end].second);
        if (fans.size() > 2 && !FansAtVertex(surface, std::move(fans)).join(work)) return;
    }
}

} // namespace haptel::runtime
