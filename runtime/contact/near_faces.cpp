#include "runtime/contact/near_faces.h"

#include "runtime/geometry/nearest_point.h"
#include "runtime/surface/discs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

// No ball is held by this.
const HalfSpace nothing{glm::dvec3(0), -std::numeric_limits<double>::infinity()};

// For a start a plane at right angles to the way to a triangle's middle, which costs less than its nearest point.
inline HalfSpace roughly_before(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& facet,
                                const glm::dvec3& centre)
{
    const glm::dvec3 away = centre - (a + b + c) * (1.0 / 3);
    const double square = glm::dot(away, away);
    const glm::dvec3 normal = square > 0 ? away * (1 / std::sqrt(square)) : facet;
    return {normal, std::max({glm::dot(normal, a), glm::dot(normal, b), glm::dot(normal, c)})};
}

} // namespace

NearFaces::NearFaces(const Surface& surface) : surface_(&surface)
{
    const std::size_t room = std::min(faces_most, 2 * surface.faces.size()); // also for groups that were looked into
    faces_.reserve(room);
    planes_.reserve(room);
    corners_.reserve(room);
    laid_.reserve(room);
    picked_.reserve(room);
    place_of_.reserve(room);
}

bool NearFaces::find(const glm::dvec3& centre, double radius, std::size_t most) noexcept
{
    picked_.clear();
    place_of_.clear();
    see_from(centre);
    renewed_at_ = centre;
    renewed_since_ = centres_;
    const bool all = surface_->tree->ball(centre, radius, std::min(most, faces_.capacity()), faces_);
    boxes_ += faces_.size();
    if (!all) faces_.clear();
    const auto& faces = surface_->faces;
    const auto& vertices = surface_->vertices;
    const std::size_t boxes = faces_.size();
    planes_.resize(boxes);
    corners_.resize(boxes);
    // Which of them stay is as good as random: all are written, and those that stay are counted.
    std::size_t found = 0;
    for (std::size_t i = 0; i < boxes; ++i) {
        if (i + 2 * BoxTree::lookahead < boxes) __builtin_prefetch(&faces[faces_[i + 2 * BoxTree::lookahead]]);
        if (i + BoxTree::lookahead < boxes)
            for (const uint32_t corner : faces[faces_[i + BoxTree::lookahead]].vertex)
                __builtin_prefetch(&vertices[corner]);
        const Face& face = faces[faces_[i]];
        const glm::dvec3 &a = vertices[face.vertex[0]], &b = vertices[face.vertex[1]], &c = vertices[face.vertex[2]];
        const HalfSpace plane = roughly_before(a, b, c, face.normal, centre);
        faces_[found] = faces_[i];
        planes_[found] = plane;
        corners_[found] = {a, b, c};
        found += !(ahead(plane) > radius + distance_rounding);
    }
    laid_.assign(found, 0);
    keep(found_ = found);
    return all;
}

bool NearFaces::find_groups(const glm::dvec3& centre, double ball_radius, double radius) noexcept
{
    picked_.clear();
    place_of_.clear();
    keep(0);
    see_from(centre);
    renewed_at_ = found_at_ = centre;
    renewed_since_ = centres_;
    radius_ = ball_radius;
    found_within_ = radius;
    const bool all = add_behind(0);
    found_ = faces_.size();
    return all;
}

// What is behind a node and may be met while that is known which is around: groups that keep off the ball, and faces.
// False: there is no room for it, and none is added.
bool NearFaces::add_behind(uint32_t node) noexcept
{
    const std::size_t before = faces_.size();
    std::array<uint32_t, BoxTree::depth_max*(BoxTree::width - 1) + BoxTree::width> waiting;
    std::size_t count = 0;
    waiting[count++] = node;
    const BoxTree& tree = *surface_->tree;
    const auto& vertices = surface_->vertices;
    while (count > 0) {
        const uint32_t next = waiting[--count];
        std::array<uint32_t, BoxTree::width> children;
        std::size_t met = 0;
        for (uint32_t bits = tree.children_near(next, found_at_, found_within_); bits != 0; bits &= bits - 1)
            children[met++] = tree.nodes()[next].child[std::countr_zero(bits)];
        boxes_ += met;
        if (faces_.size() + met > faces_.capacity()) {
            keep(before);
            return false;
        }
        // They are far apart in memory: all are asked for before the first is waited for.
        for (std::size_t i = 0; i < met; ++i)
            if (const uint32_t child = children[i]; child & BoxTree::is_face)
                __builtin_prefetch(&surface_->faces[child & ~BoxTree::is_face]);
            else
                __builtin_prefetch(&tree.disc(child));
        for (std::size_t i = 0; i < met; ++i)
            if (children[i] & BoxTree::is_face)
                for (const uint32_t corner : surface_->faces[children[i] & ~BoxTree::is_face].vertex)
                    __builtin_prefetch(&vertices[corner]);
        for (std::size_t i = 0; i < met; ++i) {
            const uint32_t child = children[i];
            if (child & BoxTree::is_face) {
                const Face& face = surface_->faces[child & ~BoxTree::is_face];
                const glm::dvec3 &a = vertices[face.vertex[0]], &b = vertices[face.vertex[1]],
                                 &c = vertices[face.vertex[2]];
                faces_.push_back(child & ~BoxTree::is_face);
                corners_.push_back({a, b, c});
                planes_.push_back(roughly_before(a, b, c, face.normal, centre_));
                laid_.push_back(0);
                continue;
            }
            const DiscBound bound = bound_of(tree.disc(child), centre_);
            if (bound.distance < radius_ + distance_rounding) {
                waiting[count++] = child;
                for (int line = 0; line < 4; ++line)
                    __builtin_prefetch(reinterpret_cast<const char*>(&tree.nodes()[child]) + 64 * line);
                continue;
            }
            faces_.push_back(child | group);
            corners_.push_back({});
            planes_.push_back({bound.normal, glm::dot(bound.normal, centre_) - bound.distance});
            laid_.push_back(centres_);
        }
    }
    return true;
}

// Has what is behind a group take its place.
bool NearFaces::look_into(std::size_t place) noexcept
{
    if (boxes_ > 2 * per_tick || !add_behind(faces_[place] & ~group)) return false;
    planes_[place] = nothing;
    return true;
}

double NearFaces::gap() const noexcept
{
    double least = std::numeric_limits<double>::infinity();
    for (const HalfSpace& plane : planes_) least = std::min(least, ahead(plane));
    return least - radius_ - distance_rounding;
}

double NearFaces::distance(const glm::dvec3& centre, double most) noexcept
{
    see_from(centre);
    double least = most;
    for (std::size_t place = 0; place < planes_.size(); ++place) {
        if (ahead(planes_[place]) >= least) continue;
        lay(place);
        const double here = ahead(planes_[place]);
        if (here < least && (!is_group(place) || !look_into(place))) least = here;
    }
    return least;
}

void NearFaces::see_from(const glm::dvec3& centre) noexcept
{
    if (centre == centre_) return;
    centre_ = centre;
    ++centres_;
}

void NearFaces::lay(std::size_t place) noexcept
{
    laid_[place] = centres_;
    if (is_group(place)) {
        const DiscBound bound = bound_of(surface_->tree->disc(faces_[place] & ~group), centre_);
        if (bound.distance > ahead(planes_[place]))
            planes_[place] = {bound.normal, glm::dot(bound.normal, centre_) - bound.distance};
        return;
    }
    const auto& [a, b, c] = corners_[place];
    const glm::dvec3 away = centre_ - nearest_point(a, b, c, centre_).at;
    const double distance = glm::length(away);
    const glm::dvec3 normal = distance > 0 ? away / distance : surface_->faces[faces_[place]].normal;
    planes_[place] = {normal, glm::dot(normal, centre_) - distance};
}

} // namespace haptel::runtime
