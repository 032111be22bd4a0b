// Contact of a probe with one surface: the proxy, a point that stays on the free side of the surface, as near to the
// hand as it can slide.
//
// The proxy is (position, feature, side). In free space it is the hand, and each move is swept against the object: its
// box, then the boxes of its triangles, then triangles, all decided exactly. On the surface it walks by steepest
// descent of its distance to the hand, from feature to feature by the links of surface.h: a cost that does not depend
// on the size of the mesh, no wedging in creases, and no query. It lifts off only when the hand lies on the free side
// of the nearest feature around it. Which side it is on is a stored bit, not a distance, so that no tolerance can lose
// it.
#pragma once

#include "runtime/contact/end_contact.h"

#include <cstdint>
#include <memory>
#include <span>

namespace haptel::runtime {

class WalkContact final : public EndContact {
public:
    explicit WalkContact(std::shared_ptr<const Surface> surface);

    void tick(const glm::dvec3& hand_m, const Friction& friction) noexcept override;
    void follow(const glm::dvec3& hand_m) noexcept override;
    void look_around() noexcept override;
    void reset() noexcept override;
    double gap_m(const glm::dvec3& hand_m) const noexcept override;
    std::span<const Contact> contacts() const noexcept override { return {&contact_, contact_.touching ? 1u : 0u}; }
    const Contact& contact() const noexcept override { return contact_; }
    const Proxy& proxy() const noexcept override { return proxy_; }

private:
    bool take(const glm::dvec3& hand_m) noexcept;
    void move_freely(const glm::dvec3& hand) noexcept;
    void describe() noexcept;

    std::shared_ptr<const Surface> surface_;
    Contact contact_;
    Proxy proxy_;
    glm::dvec3 hand_{0};                  // lattice units, and below: a lattice point of the workspace
    glm::dvec3 true_hand_{0}, before_{0}; // neither rounded nor clamped: the hand in this tick and in the last
    bool placed_ = false;
    Clearance<glm::dvec3> clear_;
};

} // namespace haptel::runtime
