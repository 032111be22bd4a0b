#include "runtime/geometry/placement.h"

#include <cmath>

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

std::string placement_fault(const Placement& placement)
{
    if (!finite(placement)) return "the placement is not finite";
    if (!is_rotation(placement.rotation))
        return "the rotation is not one: its columns must be unit vectors at right angles to each other, right-handed";
    return {};
}

} // namespace haptel::runtime
