#include "runtime/surface/build/fan_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

// A mesh that follows one curvature has edges of about one length around a vertex. Where one is longer than so many
// others, as at the foot of a fillet, the facets around do not follow one.
constexpr double even_edges = 2;

glm::dvec3 normal_of(const Surface& surface, const Sector& sector)
{
    return surface.facet_normal(sector.face, sector.side);
}

} // namespace

FanMaker::FanMaker(Surface& surface, double crease_deg, SomeFans& to)
    : surface_(surface), crease_rad_(glm::radians(crease_deg)), crease_cosine_(std::cos(crease_rad_)), to_(to)
{
}

void FanMaker::make(const Sector& start)
{
    walk(start);
    const std::size_t count = sectors_.size();
    const auto fan = static_cast<uint32_t>(to_.fans.size());
    to_.fans.push_back({mean(0, count), SideEdge(start.face, start.corner, start.side), fan});
    tell(0, count, fan);

    const auto ends = [&](std::size_t i) { return is_crease(sectors_[i], sectors_[(i + 1) % count]); };
    if (closed_) { // a part must not run over the end of the list
        std::size_t crease = 0;
        while (crease < count && !ends(crease)) ++crease;
        if (crease == count) return;
        std::rotate(sectors_.begin(), sectors_.begin() + static_cast<std::ptrdiff_t>(crease + 1), sectors_.end());
        crease = 0;
        while (!ends(crease)) ++crease;
        if (crease + 1 == count) return; // the only one, and parts nothing
    }
    for (std::size_t begin = 0, i = 0; i < count; ++i)
        if (i + 1 == count || ends(i)) {
            const auto part = static_cast<uint32_t>(to_.parts.size());
            to_.parts.push_back({mean(begin, i + 1), fan});
            tell(begin, i + 1, part | Surface::is_part);
            begin = i + 1;
        }
}

// From a border, if there is one, else from the start.
void FanMaker::walk(const Sector& start)
{
    Sector first = start;
    uint32_t edge = previous(start.corner);
    while (turn(surface_, first, edge) && first != start) {
    }
    sectors_.clear();
    closed_ = for_each_sector(surface_, first, [&](const Sector& sector) { sectors_.push_back(sector); });
}

bool FanMaker::is_crease(const Sector& a, const Sector& b) const
{
    if (const std::vector<uint32_t>& groups = surface_.smoothing_groups; !groups.empty())
        if (groups[a.face] == 0 || groups[a.face] != groups[b.face]) return true;
    const glm::dvec3 m = normal_of(surface_, a), n = normal_of(surface_, b);
    const double cosine = glm::dot(m, n);
    if (std::abs(cosine - crease_cosine_) > 1e-12) return cosine < crease_cosine_; // an arc tangent takes far longer
    return std::atan2(glm::length(glm::cross(m, n)), cosine) > crease_rad_;
}

void FanMaker::tell(std::size_t begin, std::size_t end, uint32_t number)
{
    for (std::size_t i = begin; i < end; ++i)
        surface_.faces[sectors_[i].face].fan_or_part[sectors_[i].corner][sectors_[i].side] = number;
}

// Where edges are even each facet counts by the sine of its angle at the vertex over the lengths of both edges there,
// which is right where all vertices around lie on one ball (N. Max, Weights for Computing Vertex Normals from Facet
// Normals, 1999); else by its angle.
glm::dvec3 FanMaker::mean(std::size_t begin, std::size_t end) const
{
    if (end - begin == 1) return normal_of(surface_, sectors_[begin]); // to the last bit
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    glm::dvec3 by_ball{0}, by_angle{0};
    for (std::size_t i = begin; i < end; ++i) {
        const auto [a, b] = Spokes(surface_, sectors_[i]);
        const double of_a = glm::length(a), of_b = glm::length(b), area = glm::length(glm::cross(a, b));
        longest = std::max({longest, of_a, of_b});
        shortest = std::min({shortest, of_a, of_b});
        const glm::dvec3 normal = normal_of(surface_, sectors_[i]);
        by_ball += area / (of_a * of_a * of_b * of_b) * normal;
        by_angle += std::atan2(area, glm::dot(a, b)) * normal;
    }
    const glm::dvec3 sum = longest <= even_edges * shortest ? longest * longest * by_ball : by_angle;
    const double length = glm::length(sum);
    return length > 1e-9 ? sum / length : glm::dvec3(0);
}

} // namespace haptel::runtime
