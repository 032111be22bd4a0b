#include "runtime/geometry/placement.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace haptel::runtime {

namespace {

bool is_rotation(const glm::dmat3& m)
{
    const glm::dmat3 square = glm::transpose(m) * m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::fabs(square[i][j] - (i == j)) < orthonormal_within)) return false;
    return glm::determinant(m) > 0;
}

} // namespace

glm::dmat3 rotation_about_axes(const glm::dvec3& turn_deg)
{
    glm::dmat4 rotation(1);
    for (const int axis : {2, 1, 0}) { // the last factor turns first
        glm::dvec3 direction(0);
        direction[axis] = 1;
        if (turn_deg[axis] != 0) rotation = glm::rotate(rotation, glm::radians(turn_deg[axis]), direction);
    }
    return glm::dmat3(rotation);
}

std::string placement_fault(const Placement& placement)
{
    if (!finite(placement)) return "the placement is not finite";
    if (!is_rotation(placement.rotation))
        return "the rotation is not one: its columns must be unit vectors at right angles to each other, right-handed";
    return {};
}

} // namespace haptel::runtime
