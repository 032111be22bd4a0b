#include "tests/stdlib/outlines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptel::test {

double segment_distance(const Vec2& q, const Vec2& a, const Vec2& b)
{
    const double x = b[0] - a[0], y = b[1] - a[1], length = std::hypot(x, y);
    if (length == 0) return std::hypot(q[0] - a[0], q[1] - a[1]);
    const double along = ((q[0] - a[0]) * x + (q[1] - a[1]) * y) / length;
    const double across = ((q[0] - a[0]) * y - (q[1] - a[1]) * x) / length;
    return std::hypot(across, std::max({-along, along - length, 0.0}));
}

double polygon_distance(const Vec2& q, const std::vector<Vec2>& corners)
{
    double least = INFINITY;
    bool inside = false;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        least = std::min(least, segment_distance(q, a, b));
        if ((a[1] > q[1]) != (b[1] > q[1]) && q[0] < a[0] + (q[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside ? -least : least;
}

std::vector<Vec2> rectangle(double left, double bottom, double right, double top)
{
    return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

std::vector<Vec2> corners_round(int count, double first_radius, double second_radius, double first_angle_rad)
{
    std::vector<Vec2> corners;
    for (int i = 0; i < count; ++i) {
        const double radius = i % 2 ? second_radius : first_radius,
                     angle = first_angle_rad + 2 * 3.14159265358979323846 * i / count;
        corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return corners;
}

} // namespace haptel::test
