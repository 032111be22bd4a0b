// Friction that depends on the direction, as on brushed metal: along the grain it is so many times that across it.
//
// What friction can hold in the plane of a contact is then no disc but an ellipse. A proxy slips as the principle of
// maximum dissipation has it: of all that friction can hold, it holds what is nearest to what pulls, and the proxy goes
// the rest, at right angles to the ellipse's edge. So friction takes as much as it can from every motion and never
// gives, leads a hand that crosses the grain aslant toward the grain, and depends on displacement alone, as Coulomb's
// law in a disc does. A rule that only shortens the way by what friction has in its direction would take energy, too,
// but push across the motion with no damping for it: two hands that go nearly alike could be driven apart.
#pragma once

#include <glm/glm.hpp>

namespace haptel::runtime {

// The symmetric tensor by which the coefficients are multiplied, less the unit tensor: (s - 1) e e^T for friction along
// the unit vector e that is s times that across. A direction and its opposite are one, and means of several are means
// of their tensors: two grains that cross are no grain.
struct Grain {
    bool is_there = false;            // else the rest is 0, and nobody looks at it
    glm::dvec3 diagonal{0}, mixed{0}; // xx yy zz, yz zx xy

    bool operator==(const Grain& other) const
    {
        return is_there == other.is_there && (!is_there || (diagonal == other.diagonal && mixed == other.mixed));
    }
};

// Beyond these friction along the grain is as good as none, or as good as a rail: 1/1024 of 1 N is less than hands
// feel.
inline constexpr double least_grain = 1.0 / 1024, most_grain = 1024;

// Of what faces along the unit `normal`, with the part of `direction` across it, of any length. None where that is
// nothing but rounding, or where anything is not finite.
Grain grain_along(const glm::dvec3& direction, double scale, const glm::dvec3& normal) noexcept;
// `share` of the second.
Grain mixed(const Grain& from, const Grain& to, double share) noexcept;
Grain turned(const Grain& grain, const glm::dmat3& rotation) noexcept;

// In the plane of a unit normal. Lengths are in any unit.
class FrictionEllipse {
public:
    FrictionEllipse() noexcept {} // none yet
    FrictionEllipse(const Grain& grain, const glm::dvec3& normal) noexcept;

    // What a vector of the plane becomes where the ellipse becomes the unit disc; what is across the plane is left out.
    glm::dvec3 as_in_disc(const glm::dvec3& v) const noexcept;
    double size(const glm::dvec3& v) const noexcept { return glm::length(as_in_disc(v)); }
    // Of all that are no larger than `most`, the one that is nearest to v.
    glm::dvec3 nearest(const glm::dvec3& v, double most) const noexcept;

    // Each as long as friction across the grain is times that along the axis: what they make of the unit disc is the
    // ellipse.
    const glm::dvec3& half_axis(int i) const noexcept { return half_[i]; }

private:
    glm::dvec3 axis_[2], half_[2];
    double scale_[2];
};

// Where in the disc |m| <= most the form sum of gives[i] m[i]^2 / 2 + ways[i] m[i] is least; each gives > 0. Returns
// the multiplier by which the edge holds it, 0 inside: gives[i] m[i] + ways[i] = -multiplier m[i].
double least_in_disc(const double (&gives)[2], const double (&ways)[2], double most, double (&m)[2]) noexcept;

} // namespace haptel::runtime
