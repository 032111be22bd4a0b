// Distances to outlines in the plane, from their corners alone: the truth for signed distances and for tiles.
#pragma once

#include <array>
#include <vector>

namespace haptel::test {

using Vec2 = std::array<double, 2>;

// From q to the straight line between two points; they may be one.
double segment_distance(const Vec2& q, const Vec2& a, const Vec2& b);

// Below 0 inside. By all edges, and by how often a ray crosses them.
double polygon_distance(const Vec2& q, const std::vector<Vec2>& corners);

std::vector<Vec2> rectangle(double left, double bottom, double right, double top);

// So many corners round the origin, in turn at these two radii, the first at this angle.
std::vector<Vec2> corners_round(int count, double first_radius, double second_radius, double first_angle_rad);

} // namespace haptel::test
