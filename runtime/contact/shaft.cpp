#include "runtime/contact/shaft.h"

#include "runtime/geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

Passing passing(const Shaft& shaft, const glm::dvec3& edge0, const glm::dvec3& edge1) noexcept
{
    Passing result;
    const glm::dvec3 along = shaft.tail - shaft.tip, edge = edge1 - edge0, between = edge0 - shaft.tip;
    result.edge_length = glm::length(edge);
    result.shaft_length = glm::length(along);
    const glm::dvec3 across = glm::cross(along, edge);
    const double square = glm::dot(across, across), length = std::sqrt(square);
    result.parallel = !(length > nearly_parallel * result.shaft_length * result.edge_length);
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
    if (c0 * (c0 + c1 + c2) > 0 && (c0 * c1 >= 0 || c0 * (c1 + 2 * c2) <= 0)) return 0; // it does not turn between
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

ShaftMove::ShaftMove(const Shaft& from, const Shaft& to) noexcept
    : from_(from)
    , way_(to.tip - from.tip)
    , along_(from.tail - from.tip)
    , turn_(to.tail - to.tip - along_)
    , way_by_along_(glm::cross(way_, along_))
    , way_by_turn_(glm::cross(way_, turn_))
    , along_square_(glm::dot(along_, along_))
    , along_then_square_(glm::dot(along_ + turn_, along_ + turn_))
{
}

bool ShaftMove::meets(const glm::dvec3& edge0, const glm::dvec3& edge1, double before,
                      EdgeMeeting& meeting) const noexcept
{
    const glm::dvec3 edge = edge1 - edge0, offset = from_.tip - edge0;
    double c0 = glm::dot(glm::cross(offset, along_), edge);
    // Where rounding may have decided on which side it begins, exact arithmetic does.
    const double edge_square = glm::dot(edge, edge);
    const double doubt =
        crossing_rounding * crossing_rounding * along_square_ * edge_square * glm::dot(offset, offset); // squared
    if (c0 * c0 <= doubt) c0 = -side_of_line(from_.tip, from_.tail, edge0, edge1) * std::sqrt(doubt);
    const double c1 = glm::dot(glm::cross(offset, turn_) + way_by_along_, edge), c2 = glm::dot(way_by_turn_, edge);
    const double c = c0 + c1 + c2, gap_square = shaft_tolerance::rest_gap * shaft_tolerance::rest_gap;
    meeting.close = false;
    if (c * c < gap_square * along_then_square_ * edge_square) {
        const glm::dvec3 across_then = glm::cross(along_ + turn_, edge);
        meeting.close = c * c < gap_square * glm::dot(across_then, across_then);
    }
    double t[2];
    const int count = roots(c0, c1, c2, t);
    for (int i = 0; i < count && t[i] < before; ++i) {
        const glm::dvec3 tip = from_.tip + t[i] * way_;
        const Passing at = passing({tip, tip + along_ + t[i] * turn_}, edge0, edge1);
        if (at.parallel || !at.within(0, shaft_tolerance::reach)) continue;
        const double slope = c1 + 2 * c2 * t[i];
        meeting.time = t[i];
        meeting.side = slope > 0 ? -1 : 1;
        return true;
    }
    return false;
}

} // namespace haptel::runtime
