#include "runtime/contact/walk_contact.h"

#include "runtime/geometry/finite.h"
#include "runtime/surface/box_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

// Below this many lattice units the direction from hand to proxy is rounding.
constexpr double direction_needs = 64;

} // namespace

WalkContact::WalkContact(std::shared_ptr<const Surface> surface) : surface_(std::move(surface)) {}

void WalkContact::reset() noexcept
{
    contact_ = {};
    counters_ = {};
    proxy_ = {};
    clear_ = {};
    placed_ = false;
}

void WalkContact::tick(const glm::dvec3& hand_m, const Friction& friction) noexcept
{
    if (!take(hand_m)) return;
    const Friction coulomb = checked(friction);
    proxy_.sliding = proxy_.sliding && contact_.touching &&
                     slides_on({&contact_, 1}, surface_->lattice.metres(hand_) - contact_.hand_m, coulomb);
    if (placed_ && !proxy_.touches()) {
        move_freely(hand_);
    } else if (!placed_) {
        placed_ = true;
        proxy_.at = hand_;
    }
    if (proxy_.touches()) walk(*surface_, proxy_, hand_, coulomb, counters_);
    describe();
}

void WalkContact::follow(const glm::dvec3& hand_m) noexcept
{
    if (!take(hand_m)) return;
    placed_ = true;
    proxy_.at = hand_;
    clear_.radius = 0; // it may be out of it
    describe();
}

double WalkContact::gap_m(const glm::dvec3& hand_m) const noexcept
{
    const double in_ball = clear_.radius - glm::distance(hand_, clear_.at);
    return std::max(surface_->gap_to_box_m(hand_m, hand_m), in_ball * surface_->lattice.unit_m);
}

// Takes the pose; false if there has never been a good one.
bool WalkContact::take(const glm::dvec3& hand_m) noexcept
{
    if (!finite(hand_m)) return placed_;
    clear_.unspared = -1;
    before_ = std::exchange(true_hand_, surface_->lattice.units(hand_m));
    hand_ = Lattice::snap_units(true_hand_);
    return true;
}

void WalkContact::move_freely(const glm::dvec3& hand) noexcept
{
    const double step = glm::distance(hand, proxy_.at);
    if (step == 0 || clear_.spares(glm::distance(hand, clear_.at))) {
        proxy_.at = hand;
        return;
    }
    // Beyond the workspace the hand is clamped, and its way between two such places is another than the straight one.
    glm::dvec3 from = proxy_.at, to = hand;
    const bool outside = Lattice::beyond_workspace(true_hand_) || Lattice::beyond_workspace(before_);
    if (outside) from = before_, to = true_hand_;
    Crossing crossing;
    if ((!outside || Lattice::clip_to_workspace(from, to)) &&
        first_crossing(*surface_, from, to, StartsOn::nothing(), crossing, counters_)) {
        land(*surface_, proxy_, crossing, from, to);
        proxy_.sliding = false; // static friction holds what comes down
        return;
    }
    proxy_.at = hand;
    clear_.unspared = step;
}

void WalkContact::look_around() noexcept
{
    clear_.look(proxy_.at, [&](double radius) { return clearance(*surface_, proxy_.at, radius); });
}

void WalkContact::describe() noexcept
{
    const Lattice& lattice = surface_->lattice;
    contact_.touching = proxy_.touches();
    contact_.sliding = contact_.touching && proxy_.sliding;
    contact_.proxy_m = lattice.metres(proxy_.at);
    contact_.hand_m = lattice.metres(hand_);
    if (!contact_.touching) return;

    contact_.face = proxy_.face;
    contact_.side = proxy_.side;
    contact_.barycentric = barycentric_of(*surface_, proxy_.face, proxy_.at);
    contact_.facet_normal = contact_.normal = surface_->facet_normal(proxy_.face, proxy_.side);

    const glm::dvec3 from_hand = proxy_.at - hand_;
    glm::dvec3 across = from_hand; // the part that no sliding along the feature changes
    if (proxy_.on == Proxy::On::edge) {
        const glm::dvec3 along = glm::normalize(surface_->vertex(proxy_.face, (proxy_.index + 1) % 3) -
                                                surface_->vertex(proxy_.face, proxy_.index));
        across -= glm::dot(across, along) * along;
    }
    double depth = glm::length(across);
    if (proxy_.on != Proxy::On::face && depth > direction_needs)
        contact_.normal = across / depth;
    else
        depth = std::max(0.0, glm::dot(from_hand, contact_.normal));
    contact_.depth_m = depth * lattice.unit_m;
    contact_.pressed_m = proxy_.pressed * lattice.unit_m;
    contact_.lag_m = (from_hand - depth * contact_.normal) * lattice.unit_m;
}

} // namespace haptel::runtime
