// Coulomb friction on an end of a stylus whose shaft leans on edges. How far the end moves against it decides how hard
// the edges push; their pushes, on a short lever a hundred times the hand's, press the end onto its face and drive it
// along; and by how much it is pressed, so much friction there is. So all of it is found together, in a few turns.
// Lattice units: a force is the way by which it stretches the spring of an end.
//
// Known limit: where both ends touch and slide, and the shaft leans on an edge between them, each is found with the
// other's friction as it is. That may need more turns than there are, and then the shaft may be stopped in that tick.
#pragma once

#include "runtime/contact/contact.h"

#include <glm/glm.hpp>

namespace haptel::runtime {

// One end in one tick, and the plane of what it touches.
struct EndFriction {
    WalkFriction friction;
    bool touches = false;
    bool slides = false; // dynamic friction holds: it slid in the last tick, or slips in this one
    bool slips = false;  // it was found in this tick that it does not stay where it is
    bool sticks = false; // it is taken to stay there: whatever pushes
    bool moves = false;  // it does not stay there, with the friction found last
    glm::dvec3 at{0}, normal{0};
    glm::dvec3 lag{0}; // friction, in the plane: from where the end is aimed to where it comes to rest

    bool drags() const { return touches && friction.static_coefficient > 0; }
    double coefficient() const { return slides ? friction.dynamic_coefficient : friction.static_coefficient; }
    // For the walk, which then holds the end or lets it slide as was found here.
    Friction of_walk() const { return {coefficient(), friction.dynamic_coefficient}; }

    void take_hold(bool of_sides) noexcept;
    // A turn: with the present friction the pushes of the sides would have the hand's end at `aim`, and the end comes
    // to `held`; `give` is how it moves by what pulls it while the same contacts push. Takes the friction that follows
    // from this, and returns by how much that is news, over its limit.
    double follow(const glm::dvec3& aim, const glm::dvec3& held, const glm::dmat3& give) noexcept;

private:
    double limited(double found) noexcept;
    bool oppose(const glm::dvec3& way, const glm::dmat3& give, double most) noexcept;

    // The limit of friction: taken in the last turns, and found by them.
    double limit_ = 0, limit_before_ = 0, found_before_ = 0;
};

} // namespace haptel::runtime
