// What a hand would feel below it, for pictures: the explored object with its texture, seen along the hand's -z.
#pragma once

#include "runtime/hand/hand.h"
#include "runtime/scene/scene.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <optional>

namespace haptel::tools::plot {

// Unit normal of the textured surface below (x, y), all in the hand's space; nothing where nothing lies below.
using NormalBelow = std::function<std::optional<glm::dvec3>(double x_m, double y_m)>;

// Of the scene's first object, where it is at the start, its texture so many times as steep. Empty without an object.
NormalBelow textured_normal_below(const std::shared_ptr<const runtime::Scene>& scene,
                                  const runtime::Workspace& workspace, double exaggeration = 1);

} // namespace haptel::tools::plot
