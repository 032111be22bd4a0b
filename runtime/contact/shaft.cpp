#include "runtime/contact/shaft.h"

#include "runtime/geometry/predicates.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

Passing passing(const Shaft& shaft, const glm::dvec3& edge0, const glm::dvec3& edge1) noexcept
{
    Passing result;
    const glm::dvec3 along = shaft.tail - shaft.tip, edge = edge1 - edge0, between = edge0 - shaft.tip;
    result.edge_length = glm::length(edge);
    result.shaft_length = glm::length(along);
    const glm::dvec3 across = glm::cross(along, edge);
    const double square = glm::dot(across, across), length = std::sqrt(square);
    result.parallel = !(length > shaft_tolerance::parallel * result.shaft_length * result.edge_length);
    if (result.parallel) return result;
    result.normal = across / length;
    result.height = -glm::dot(between, result.normal);
    result.on_shaft = glm::dot(glm::cross(between, edge), across) / square;
    const double share = glm::dot(glm::cross(between, along), across) / square;
    result.on_edge = share * result.edge_length;
    result.edge_point = edge0 + share * edge;
    return result;
}

namespace {

// A product of three vectors is off by less than this, times their lengths.
constexpr double crossing_rounding = 0x1p-50;

// Rising roots in [0, 1) of c0 + c1 t + c2 t^2 at which it changes its sign.
int roots(double c0, double c1, double c2, double (&t)[2])
{
    int count = 0;
    const auto take = [&](double root) {
        if (root >= 0 && root < 1) t[count++] = root;
    };
    const double discriminant = c1 * c1 - 4 * c2 * c0;
    if (discriminant <= 0) return 0;
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    if (q != 0) take(c0 / q);
    if (c2 != 0) take(q / c2);
    if (count == 2 && t[1] < t[0]) std::swap(t[0], t[1]);
    return count;
}

} // namespace

bool meets(const Shaft& from, const Shaft& to, const glm::dvec3& edge0, const glm::dvec3& edge1, double before,
           EdgeMeeting& meeting) noexcept
{
    const glm::dvec3 edge = edge1 - edge0;
    const glm::dvec3 along = from.tail - from.tip, turn = (to.tail - to.tip) - along;
    const glm::dvec3 offset = from.tip - edge0, way = to.tip - from.tip;
    const glm::dvec3 across = glm::cross(along, edge), across_turn = glm::cross(turn, edge);
    double c0 = glm::dot(across, offset);
    // Where rounding may have decided on which side it begins, exact arithmetic does.
    const double doubt = crossing_rounding * glm::length(along) * glm::length(edge) * glm::length(offset);
    if (std::fabs(c0) <= doubt) c0 = -side_of_line(from.tip, from.tail, edge0, edge1) * doubt;
    const double c1 = glm::dot(across_turn, offset) + glm::dot(across, way), c2 = glm::dot(across_turn, way);
    const double c = c0 + c1 + c2;
    const glm::dvec3 across_then = across + across_turn;
    meeting.close = c * c < shaft_tolerance::rest_gap * shaft_tolerance::rest_gap * glm::dot(across_then, across_then);
    double t[2];
    const int count = roots(c0, c1, c2, t);
    for (int i = 0; i < count && t[i] < before; ++i) {
        const Shaft there{from.tip + t[i] * way, from.tail + t[i] * (to.tail - from.tail)};
        const Passing at = passing(there, edge0, edge1);
        if (at.parallel || !at.within(0, 0, shaft_tolerance::reach)) continue;
        const double slope = c1 + 2 * c2 * t[i];
        meeting.time = t[i];
        meeting.side = slope > 0 ? -1 : 1;
        return true;
    }
    return false;
}

} // namespace haptel::runtime
