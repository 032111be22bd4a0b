// What a ball says of where it touches: row by row what holds it.
#include "runtime/contact/sphere_contact.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// Cosine between the normals of what bends within the ball's way; difference of cosines that rounding makes.
constexpr double same_piece = 0.5, same_plane = 1e-9;

} // namespace

// The planes here do not know how deep the hand is where it is: until the ball is there what was felt is felt, as far
// as the spring pulls now, but of what the hand has left.
void SphereContact::keep_told() noexcept
{
    if (contact_count_ == 0 || glm::dot(hand_ - proxy_.at, contacts_[0].normal) >= 0) return tell_free();
    const double way_m = glm::distance(proxy_.at, hand_) * surface_->lattice.unit_m;
    glm::dvec3 told_m(0);
    for (const Contact& contact : contacts()) told_m += contact.depth_m * contact.normal + contact.lag_m;
    const double told = glm::length(told_m), kept = told > way_m ? way_m / told : 1;
    for (std::size_t i = 0; i < contact_count_; ++i) {
        contacts_[i].depth_m *= kept;
        contacts_[i].lag_m *= kept;
        contacts_[i].hand_m = surface_->lattice.metres(hand_);
    }
}

const NearestPoint& SphereContact::nearest_on(uint32_t face, const glm::dvec3& centre) noexcept
{
    if (face == nearest_.face && centre == nearest_.centre) return nearest_.at;
    const auto [a, b, c] = surface_->corners(face);
    nearest_ = {face, centre, nearest_point(a, b, c, centre)};
    return nearest_.at;
}

// The face that a ball touches which `normal` pushes there. Friction may hold it off the place where `face` does.
uint32_t SphereContact::touching_face(uint32_t face, const glm::dvec3& normal, const glm::dvec3& centre) noexcept
{
    glm::dvec3 at = nearest_on(face, centre).at;
    double distance = glm::distance(at, centre);
    if (distance > grown_ + touching_gap)
        faces_.for_each_near(centre, distance, [&](uint32_t other) {
            const glm::dvec3& there = nearest_on(other, centre).at;
            const double away = glm::distance(there, centre);
            if (away >= distance || glm::dot(centre - there, normal) < same_piece * away) return;
            distance = away;
            at = there;
            face = other;
        });
    if (surface_->is_clean()) return face;
    // Of the faces that meet there the one that turns to it most: another may be the bottom of an object that lies on
    // the other's top, and ends in the same edge where nobody can come to it. Of those in one plane the first.
    const auto turned = [&](uint32_t number) { return std::fabs(glm::dot(surface_->faces[number].normal, normal)); };
    if (surface_->origins.empty() && turned(face) > 1 - same_plane) return face;
    const double same_place = std::sqrt(touching_gap * grown_); // by that: where a point touches, an angle of 3e-4
    faces_.for_each_near(centre, distance + touching_gap, [&](uint32_t other) {
        const double more = turned(other) - turned(face);
        if (more < -same_plane || (more <= same_plane && other > face)) return;
        const glm::dvec3& there = nearest_on(other, centre).at;
        if (more <= same_plane && glm::distance(there, centre) > distance + distance_rounding) return;
        if (glm::distance(there, at) < same_place) face = other;
    });
    return face;
}

void SphereContact::tell_free() noexcept
{
    proxy_.on = Proxy::On::nothing;
    proxy_.sliding = false;
    tell_nothing();
}

void SphereContact::tell_nothing() noexcept
{
    if (contacts_[0].touching) contacts_[0] = {};
    contact_count_ = 0;
    contacts_[0].proxy_m = surface_->lattice.metres(proxy_.at);
    contacts_[0].hand_m = surface_->lattice.metres(hand_);
}

// What holds the ball where it is, off the nearest place by friction.
void SphereContact::tell(const Held& held, const glm::dvec3& nearest) noexcept
{
    contact_count_ = 0;
    const double sum = held.pushes();
    glm::dvec3 way(0);
    double kept = 1;
    if (held.count > 1 && sum > 0) {
        for (std::size_t i = 0; i < held.count; ++i) way += held.row[i].push * held.row[i].normal;
        kept = std::min(1.0, opposed_most * glm::length(way) / sum);
    }
    const glm::dvec3 lag_m = (proxy_.at - nearest) * surface_->lattice.unit_m;
    for (std::size_t i = 0; i < held.count; ++i) {
        const auto& [face, normal, push] = held.row[i];
        if (is_point_ && push == 0) continue; // by the radius alone
        Contact& contact = contacts_[contact_count_++];
        contact = {};
        contact.touching = true;
        contact.sliding = proxy_.sliding;
        contact.normal = normal;
        contact.face = touching_face(face, normal, proxy_.at);
        const NearestPoint& point = nearest_on(contact.face, proxy_.at);
        // In the plane of the face, as at the rim of a lid, the front: rounding does not choose.
        contact.side = glm::dot(contact.normal, surface_->faces[contact.face].normal) >= -same_plane ? 0 : 1;
        contact.facet_normal = surface_->facet_normal(contact.face, contact.side);
        contact.barycentric = point.barycentric;
        contact.proxy_m = surface_->lattice.metres(point.at);
        contact.hand_m = surface_->lattice.metres(hand_);
        contact.radius_m = is_point_ ? 0.0 : grown_ * surface_->lattice.unit_m;
        contact.depth_m = contact.pressed_m = push * surface_->lattice.unit_m;
        contact.lag_m = sum > 0 ? push / sum * lag_m : glm::dvec3(0);
        if (kept < 1) { // walls that push against each other: the sum stays
            const glm::dvec3 shared = kept * contact.normal + (1 - kept) / sum * way;
            const double length = glm::length(shared);
            if (length > 0) contact.normal = shared / length;
            contact.depth_m *= length;
            contact.on_crease = true;
        }
    }
    if (contact_count_ == 0) tell_nothing();
    proxy_.on = Proxy::On::face;
}

} // namespace haptel::runtime
