// Between what the public headers name and what the runtime computes with.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "runtime/surface/mesh.h"

#include <glm/glm.hpp>
#include <haptel/device.h>
#include <haptel/mesh.h>

namespace haptel {

inline glm::dvec3 to_glm(const Vec3& v)
{
    return {v.x, v.y, v.z};
}

inline Vec3 from_glm(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

runtime::Mesh to_runtime(Mesh mesh);

} // namespace haptel
