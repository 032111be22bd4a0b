#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace haptel::runtime {

inline bool finite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace haptel::runtime
