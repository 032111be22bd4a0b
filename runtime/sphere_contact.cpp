#include "runtime/sphere_contact.h"

#include "runtime/box_tree.h"
#include "runtime/finite.h"
#include "runtime/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace haptel::runtime {

namespace {

// Lattice units (below 2e-12 of the object): what rounding may take from a distance.
constexpr double rounding = 1;
// A ball smaller than this is a point that rounding can move through a face.
constexpr double least_radius = 0x1p20;

// Of the radius: how far around is looked at once at least, and when anew; and what is left of a way counts as none.
constexpr double margin_most = 1.0 / 16, margin_least = 1.0 / 64, settled = 1e-8;

// Where there are fewer faces the ball looks farther around, where there are more less far.
constexpr std::size_t few_faces = 16, many_faces = 64;

// Faces in reach at once. Where there are more, the ball takes shorter steps.
constexpr std::size_t faces_most = 1 << 14;

class Collect final : public BallVisitor {
public:
    explicit Collect(std::vector<uint32_t>& faces) : faces_(faces) { faces_.clear(); }
    double visit(uint32_t face) noexcept override
    {
        full = faces_.size() == faces_.capacity();
        if (!full) faces_.push_back(face);
        return full ? 0 : std::numeric_limits<double>::infinity();
    }
    bool full = false;

private:
    std::vector<uint32_t>& faces_;
};

} // namespace

SphereContact::SphereContact(std::shared_ptr<const Surface> surface, double radius_m)
    : surface_(std::move(surface)), radius_(radius_m / surface_->lattice.unit_m), grown_(radius_)
{
    const std::size_t room = std::min(faces_most, surface_->faces.size());
    faces_.reserve(room);
    planes_.reserve(room);
    plane_of_.reserve(room);
    touched_.reserve(room);
}

void SphereContact::reset() noexcept
{
    placed_ = sliding_ = false;
    around_ = {};
    contact_count_ = 0;
    counters_ = {};
}

std::span<const Contact> SphereContact::update(const glm::dvec3& centre_m, const Friction& friction) noexcept
{
    ++counters_.ticks;
    if (!finite(centre_m)) {
        ++counters_.hands_held;
        for (Contact& contact : contacts_) contact.hand_held = true;
        return {contacts_, contact_count_};
    }
    hand_ = surface_->lattice.snap(centre_m);
    if (!placed_) place();
    if (placed_) move(friction);
    counters_.touching_ticks += contact_count_ > 0;
    return {contacts_, contact_count_};
}

void SphereContact::follow(const glm::dvec3& centre_m) noexcept
{
    ++counters_.ticks;
    ++counters_.skipped;
    if (finite(centre_m)) centre_ = hand_ = surface_->lattice.snap(centre_m);
}

double SphereContact::gap_m(const glm::dvec3& centre_m) const noexcept
{
    return std::max(0.0, surface_->gap_to_box_m(centre_m, centre_m) - radius_ * surface_->lattice.unit_m);
}

// As large as fits where the hand is.
void SphereContact::place() noexcept
{
    centre_ = hand_;
    if (!look_around(0)) return;
    grown_ = 0;
    lay_planes(radius_);
    grown_ = radius_;
    for (const glm::dvec3& point : touched_) grown_ = std::min(grown_, glm::distance(point, centre_));
    placed_ = grown_ >= std::min(least_radius, radius_);
}

// Finds the faces within the radius and a margin, or within less where there are too many. False: nothing less is left.
bool SphereContact::look_around(double margin) noexcept
{
    for (int attempt = 0; attempt < 24; ++attempt, margin *= 0.5) {
        Collect found(faces_);
        surface_->tree->ball(centre_, radius_ + margin + rounding, found);
        ++counters_.sweeps;
        counters_.triangles_tested += faces_.size();
        if (found.full) continue;
        around_ = {centre_, margin};
        if (faces_.size() < few_faces) margin_ = std::min(2 * std::max(margin, margin_), Lattice::extent);
        if (faces_.size() > many_faces) margin_ = 0.5 * margin;
        return true;
    }
    around_.margin = -1;
    return false;
}

// How far the centre may move before something may be met that was not found.
double SphereContact::room() const noexcept
{
    return around_.margin - glm::distance(centre_, around_.centre);
}

// Of the faces that may be met within `reach`.
void SphereContact::lay_planes(double reach) noexcept
{
    planes_.clear();
    plane_of_.clear();
    touched_.clear();
    const double near = grown_ + reach + rounding;
    for (const uint32_t face : faces_) {
        const auto& corners = surface_->faces[face].vertex;
        const glm::dvec3 point = nearest_point(surface_->vertices[corners[0]], surface_->vertices[corners[1]],
                                               surface_->vertices[corners[2]], centre_)
                                     .at;
        const glm::dvec3 away = centre_ - point;
        const double square = glm::dot(away, away);
        if (square > near * near) continue;
        const double distance = std::sqrt(square);
        const glm::dvec3 normal = distance > 0 ? away / distance : surface_->faces[face].normal;
        planes_.push_back({normal, glm::dot(normal, centre_) - distance + grown_});
        plane_of_.push_back(face);
        touched_.push_back(point);
    }
}

// One straight step toward the hand, or to where the planes around let it come.
NearestInHalfSpaces SphereContact::approach(double step_max) noexcept
{
    lay_planes(step_max);
    const glm::dvec3 to_hand = hand_ - centre_;
    if (path_length_ == 0) { // in the air: first straight on, to where it touches
        const double length = glm::length(to_hand);
        const double within = length > step_max ? step_max / length : 1;
        const double open = open_share(planes_, centre_, within * to_hand, 0);
        centre_ += open * within * to_hand;
        if (open == 1) return {centre_, 0, {}, {}};
        path_[path_length_++] = centre_;
        step_max -= open * within * length;
    }
    NearestInHalfSpaces found = nearest_in(planes_, hand_, centre_, rounding);
    const glm::dvec3 way = found.at - centre_;
    const double length = glm::length(way);
    centre_ += length > step_max ? step_max / length * way : way;
    return found;
}

void SphereContact::move(const Friction& friction) noexcept
{
    path_length_ = 0;
    if (contact_count_ > 0) path_[path_length_++] = centre_;
    NearestInHalfSpaces found;
    uint32_t round = 0;
    bool on_the_way = false; // the last step was as long as it might be
    for (; round < rounds_max; ++round) {
        const double want = glm::distance(hand_, centre_);
        if (want == 0) break;
        if (room() < std::min(want, margin_least * radius_)) {
            const double most = std::max(margin_, margin_most * radius_);
            if (!look_around(std::clamp(2 * want, margin_least * radius_, most))) {
                ++counters_.walks_cut; // too much at once: what is touched stays touched
                return;
            }
        }
        const glm::dvec3 before = centre_;
        const double step_max = std::min(want, room());
        found = approach(step_max);
        if (found.count == 0) path_length_ = 0;
        if (path_length_ > 0 && path_length_ <= rounds_max) path_[path_length_++] = centre_;
        const double step = glm::distance(before, centre_);
        if (step <= std::max(4 * rounding, settled * radius_)) break;
        on_the_way = step > 0.5 * step_max;
    }
    counters_.walk_steps += round;
    counters_.walk_steps_max = std::max<uint64_t>(counters_.walk_steps_max, round);
    counters_.walks_cut += round == rounds_max;
    counters_.skipped += round == 0;
    if (grown_ < radius_) {
        double nearest = radius_;
        for (const glm::dvec3& point : touched_) nearest = std::min(nearest, glm::distance(point, centre_));
        grown_ = std::max(grown_, nearest - rounding);
    }
    // The planes here do not know how deep the hand is where it is: until the ball is there what was felt is felt, but
    // of what the hand has left.
    if (round == rounds_max && on_the_way) {
        if (contact_count_ > 0 && glm::dot(hand_ - centre_, contacts_[0].normal) >= 0) contact_count_ = 0;
        return;
    }
    if (found.count == 0) {
        sliding_ = false;
        contact_count_ = 0;
        return;
    }
    const glm::dvec3 nearest = centre_;
    hold_by_friction(friction);
    describe(found);
    const glm::dvec3 lag_m = (centre_ - nearest) * surface_->lattice.unit_m;
    double depth_m = 0;
    for (std::size_t i = 0; i < contact_count_; ++i) depth_m += contacts_[i].depth_m;
    for (std::size_t i = 0; i < contact_count_; ++i)
        contacts_[i].lag_m = depth_m > 0 ? contacts_[i].depth_m / depth_m * lag_m : glm::dvec3(0);
}

// Friction is a way that ends early, by coefficient times depth, or does not begin.
void SphereContact::hold_by_friction(const Friction& friction) noexcept
{
    const auto [rest, slide] = checked(friction);
    const double depth = glm::distance(centre_, hand_);
    double way = 0;
    for (uint32_t i = 1; i < path_length_; ++i) way += glm::distance(path_[i - 1], path_[i]);
    if (rest > 0 && way <= (sliding_ ? slide : rest) * depth) {
        centre_ = path_[0];
        sliding_ = false;
        return;
    }
    double back = slide * depth;
    sliding_ = way - back > rounding;
    for (uint32_t i = path_length_ - 1; i > 0 && back > 0; --i) {
        const double length = glm::distance(path_[i - 1], path_[i]);
        centre_ = length <= back ? path_[i - 1] : path_[i] + back / length * (path_[i - 1] - path_[i]);
        back -= length;
    }
}

void SphereContact::describe(const NearestInHalfSpaces& found) noexcept
{
    std::array<uint32_t, 3> order{0, 1, 2}; // who presses most first
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {0, 1}})
        if (b < static_cast<int>(found.count) && found.push[order[b]] > found.push[order[a]])
            std::swap(order[a], order[b]);
    contact_count_ = found.count;
    for (std::size_t i = 0; i < found.count; ++i) {
        const uint32_t plane = found.active[order[i]];
        const auto& corners = surface_->faces[plane_of_[plane]].vertex;
        Contact& contact = contacts_[i];
        contact = {};
        contact.touching = true;
        contact.sliding = sliding_;
        contact.face = plane_of_[plane];
        contact.normal = planes_[plane].normal;
        contact.side = glm::dot(contact.normal, surface_->faces[contact.face].normal) >= 0 ? 0 : 1;
        contact.facet_normal = surface_->facet_normal(contact.face, contact.side);
        contact.barycentric = nearest_point(surface_->vertices[corners[0]], surface_->vertices[corners[1]],
                                            surface_->vertices[corners[2]], touched_[plane])
                                  .barycentric;
        contact.proxy_m = surface_->lattice.metres(touched_[plane]);
        contact.hand_m = surface_->lattice.metres(hand_);
        contact.depth_m = found.push[order[i]] * surface_->lattice.unit_m;
    }
}

} // namespace haptel::runtime
