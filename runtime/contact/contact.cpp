#include "runtime/contact/contact.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

bool slides_on(std::span<const Contact> held, const glm::dvec3& way_m, const Friction& friction) noexcept
{
    glm::dvec3 push_m(0), lag_m(0);
    double pressed_m = 0;
    for (const Contact& contact : held) {
        push_m += contact.depth_m * contact.normal;
        pressed_m += contact.pressed_m;
        lag_m += contact.lag_m;
    }
    const double least = sticks_again * friction.dynamic_coefficient;
    const auto is_held = [&](const glm::dvec3& from_m) {
        return glm::dot(from_m, from_m) >= least * pressed_m * (least * pressed_m);
    };
    const bool nears = glm::dot(lag_m, way_m) > 0; // else it goes farther away, as while it slides
    if (!nears && !friction.grain.is_there) return is_held(lag_m);
    const double length_m = glm::length(push_m);
    if (!(length_m > 0)) return !nears && is_held(lag_m);
    const glm::dvec3 normal = push_m / length_m;
    glm::dvec3 from_m, along_m;    // of the hand, seen from the proxy
    if (friction.grain.is_there) { // where the ellipse is a disc
        const FrictionEllipse ellipse(friction.grain, normal);
        from_m = -ellipse.as_in_disc(lag_m), along_m = ellipse.as_in_disc(way_m);
        if (glm::dot(from_m, along_m) >= 0) return is_held(from_m);
    } else {
        const auto across = [&](const glm::dvec3& v) { return v - glm::dot(v, normal) * normal; };
        from_m = -across(lag_m), along_m = across(way_m);
    }
    const double square = glm::dot(along_m, along_m);
    const double share =
        square > 0 ? glm::clamp(-glm::dot(from_m, along_m) / square, 0.0, 1.0) : 0.0; // where it is nearest
    const double then_m = std::max(0.0, pressed_m - share * glm::dot(way_m, normal));
    return glm::length(from_m + share * along_m) >= least * then_m;
}

} // namespace haptel::runtime
