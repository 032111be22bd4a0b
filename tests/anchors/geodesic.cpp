#include "tests/anchors/geodesic.h"

#include "runtime/surface/shapes.h"

#include <cmath>
#include <cstdint>

namespace haptel::test {

using glm::dvec3;
using runtime::Mesh;

Mesh make_unit_geodesic(uint32_t parts)
{
    Mesh mesh = runtime::make_geodesic(parts);
    for (dvec3& p : mesh.positions_m) p *= 2;
    return mesh;
}

namespace {

constexpr double bump_m = 0.02, wave = 8;

// Gradient of |p| - radius(p / |p|), which is 0 on the surface: its normal, not of unit length.
dvec3 outward(const dvec3& p)
{
    const double length = glm::length(p);
    const dvec3 d = p / length, s(std::sin(wave * d.x), std::sin(wave * d.y), std::sin(wave * d.z)),
                c(std::cos(wave * d.x), std::cos(wave * d.y), std::cos(wave * d.z));
    const dvec3 by_direction = bump_m * wave * dvec3(c.x * s.y * s.z, s.x * c.y * s.z, s.x * s.y * c.z);
    return d - (by_direction - glm::dot(by_direction, d) * d) / length;
}

} // namespace

double BumpySphere::radius_m(const dvec3& d)
{
    return 1 + bump_m * std::sin(wave * d.x) * std::sin(wave * d.y) * std::sin(wave * d.z);
}

dvec3 BumpySphere::nearest_m(const dvec3& point_m)
{
    const auto onto = [](const dvec3& p) { return glm::normalize(p) * radius_m(glm::normalize(p)); };
    dvec3 foot = onto(point_m);
    for (int i = 0; i < 40; ++i) { // each round errs by distance over radius of curvature times what the last one did
        const dvec3 normal = glm::normalize(outward(foot)), to = point_m - foot;
        const dvec3 along = to - glm::dot(to, normal) * normal;
        foot = onto(foot + along);
        if (glm::dot(along, along) < 1e-24) break;
    }
    return foot;
}

Mesh BumpySphere::mesh(uint32_t parts)
{
    Mesh mesh = make_unit_geodesic(parts);
    for (dvec3& p : mesh.positions_m) p *= radius_m(p);
    return mesh;
}

} // namespace haptel::test
