// Coulomb friction on an end of a stylus whose shaft leans on edges. The forces depend on each other in a circle: the
// end's displacement changes how hard the edges push the shaft; these pushes press the end onto its face, on a short
// lever up to a hundred times as hard as the hand; and that pressure limits the friction, which limits the
// displacement. So the caller iterates: each iteration solves the contacts with the present friction and calls
// follow(). Forces are in lattice units: the length by which they stretch the spring of an end.
#pragma once

#include "runtime/contact/contact.h"

#include <glm/glm.hpp>

namespace haptel::runtime {

// One end in one tick, and the plane of what it touches.
struct EndFriction {
    Friction friction;
    bool touches = false;
    bool slides = false; // the dynamic coefficient holds: it slid since it last stuck, or slips in this tick
    bool slips = false;  // static friction was exceeded in this tick
    bool sticks = false; // this iteration takes it as fixed, whatever pushes it
    bool moves = false;  // it moves under the friction of the last iteration
    glm::dvec3 at{0}, normal{0};
    double unfelt = 0;       // of its height over where it is pulled nothing presses
    double bears = 1;        // times the rest: in a groove both its walls press
    FrictionEllipse ellipse; // what friction holds; a disc without a grain
    glm::dvec3 lag{0};       // friction, in the plane: from where the end is pulled to where it comes to rest

    bool drags() const { return touches && friction.static_coefficient > 0; }
    double coefficient() const { return slides ? friction.dynamic_coefficient : friction.static_coefficient; }

    void take_hold(bool of_sides) noexcept;
    // One iteration. With the present friction the contacts of the shaft pull the end toward `aim`, and it comes to
    // rest at `held`; `give` is the matrix from a pull to the end's displacement while the same contacts stay active.
    // Sets the friction that follows, and returns its change over its limit: 0 when it has converged, infinite when the
    // end changed between sticking and slipping.
    double follow(const glm::dvec3& aim, const glm::dvec3& held, const glm::dmat3& give) noexcept;

private:
    double limited(double found) noexcept;
    bool oppose(const glm::dvec3& way, const glm::dmat3& give, double most) noexcept;

    // The limit of friction: taken in the last turns, and found by them.
    double limit_ = 0, limit_before_ = 0, found_before_ = 0;
};

} // namespace haptel::runtime
