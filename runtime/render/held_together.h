// What several contacts of one probe hold together.
//
// Alone, a contact pushes with a spring: minus the gradient of half the square of how deep the hand is below what is
// felt. Of several at one end of the probe, X is the shortest way from the hand to a place above all of
//
//   N_i . X >= N_i . a_i + D_i.
//
// On i is felt what is below the place at the way a_i from the hand, to which the others push it: so that stays where
// they hold it; of what holds little, little, and nothing steps where a contact begins. D_i is how deep the hand would
// be there below what is felt, and N_i its normal: that of the smooth surface, if facets stand for one, which turns
// with the place and does not step. Of a stylus X is the way of both its ends, and N_i . X that of the place which
// touches.
//
// What all push together is minus the gradient of |X|^2 / 2: the sum over the rows of their pushes p_i, how much of X
// is along N_i, times the gradient of N_i . (X - a_i) - D_i, X kept. Left out is how the normals of facets, which tell
// a_i, turn where a ball rolls over an edge and with the shaft of a stylus; and where flat facets are felt by a share,
// how N_i turns with that. This is what is left on closed paths (tests/runtime/force/closed_paths.cpp).
//
// Friction and damping are felt by shares: of each contact as if it held all of the hand, times what it holds.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/contact/crease_rows.h"
#include "runtime/contact/project.h"
#include "runtime/geometry/placement.h"
#include "runtime/render/object_force.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptel::runtime {

// One of several contacts.
struct Row {
    uint32_t part;
    bool is_first;              // of the part
    const Placement* placement; // of its object
    Contact contact;            // in that one's space
    double below_m;             // of what is touched there, the hand: less than 0 above it, in a narrow groove
    double share = 1;           // of that, held by this contact: of several nearly in one plane a part, else all
    // Of what is held together with others, in the world frame; `_dp`: gradients by the places of both ends.
    glm::dvec3 normal{0}; // unit, of the facet
    Shaft direction{};    // along that, of a push
    Shaft depth_dp{};     // of contact.depth_m
    double held = 0;      // 0 .. 1, in how far places on the others stay where they are along it:
    double still_m = 0;   // by so much of its depth
    Shaft still_dp{};
    double off_m = 0; // how far the hand is from where this one does not hold
    Shaft off_dp{};
    double felt_m = 0; // how deep the hand would be below what is felt, at its place on this row
    glm::dvec3 felt_dp{0};
    glm::dvec3 felt_normal{0}; // unit, of what is felt there,
    glm::dmat3 normal_dp{0};   // 1/m: and how it turns with the place
    Shaft felt_direction{};
    double raised_m = 0; // along it: how far the proxy is below what is felt, mostly less than 0
    Shaft raised_dp{};
    double eased_m = 0; // that is less by so much while contact begins
    Shaft eased_dp{};
    Shaft at_ends_n{}; // felt there besides `force`
    ObjectForce force{};

    Contact whole() const // as if it held all of it
    {
        Contact all = contact;
        all.depth_m /= share;
        all.lag_m /= share;
        return all;
    }
};

// The rows at one end of the probe; of a stylus at both.
class HeldTogether {
public:
    enum class At : uint8_t { tip, tail, both };

    HeldTogether() noexcept {} // none; of the array nothing is set to 0
    // Tells of each row there what it holds, and moves its place of contact to where the others hold it still.
    HeldTogether(std::span<Row> rows, At where) noexcept;
    // When each row knows what is felt on it: tells `at_ends_n`, and lets no force pull.
    void push() const noexcept;

private:
    std::span<Row* const> rows() const { return {row_.data(), count_}; }
    void hold_still() const noexcept;
    Shaft felt_by(const Row& row, const glm::dvec3& by_place) const noexcept;
    void raise(Row& row) const noexcept;
    Shaft below_dp(const Row& row, const Shaft& way_m, const Shaft& at_m) const noexcept;
    void ease_in() const noexcept;

    std::array<Row*, CreaseRows::rows_most> row_;
    std::size_t count_ = 0;
    Shaft way_m_; // from the hand to the proxy
};

} // namespace haptel::runtime
