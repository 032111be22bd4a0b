#include "runtime/force_model.h"

#include <algorithm>
#include <limits>

namespace haptel::runtime {

std::string_view name_of(ForceModel model)
{
    switch (model) {
    case ForceModel::displaced: return "displaced";
    case ForceModel::paper: return "paper";
    }
    return {};
}

std::optional<ForceModel> force_model_named(std::string_view name)
{
    for (const ForceModel model : {ForceModel::displaced, ForceModel::paper})
        if (name == name_of(model)) return model;
    return std::nullopt;
}

ModelForce model_force(ForceModel model, const TouchedSurface& surface, const TextureSample& texture) noexcept
{
    const double stiffness = surface.stiffness_n_per_m * texture.stiffness_scale;
    const glm::dvec3 perturbed = surface.normal - texture.surface_gradient; // eq. 2; its length is meant
    double depth = 0;
    switch (model) {
    case ForceModel::displaced: depth = surface.depth_m + texture.envelope_m; break;
    case ForceModel::paper: depth = surface.depth_m * glm::dot(surface.contact_normal, surface.normal); break;
    }
    depth = std::max(depth, 0.0);
    return {stiffness * depth * perturbed, depth};
}

glm::dvec3 limited(const glm::dvec3& force_n, double limit_n) noexcept
{
    // Scaled by the largest component first: squares of huge forces would overflow to infinity.
    const glm::dvec3 size = glm::abs(force_n);
    const double largest = std::max({size.x, size.y, size.z});
    if (largest == 0) return force_n;
    const glm::dvec3 scaled = force_n / largest;
    // A few ulp short, so that whoever measures the result finds it within the limit.
    const double limit = limit_n * (1 - 8 * std::numeric_limits<double>::epsilon());
    return largest * glm::length(scaled) <= limit ? force_n : scaled * (limit / glm::length(scaled));
}

} // namespace haptel::runtime
