#include "runtime/force/force_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

ModelForce model_force(const ForceRule& rule, const Foot& foot, double stiffness_n_per_m,
                       const TextureSample& texture) noexcept
{
    const double stiffness = stiffness_n_per_m * texture.stiffness_scale;
    if (rule.model == ForceModel::displaced) {
        const double depth = std::max(0.0, foot.depth_m + texture.envelope_m);
        if (depth == 0) return {};
        const glm::dvec3 slope = texture.gradient == glm::dvec3(0) ? glm::dvec3(0) : foot.felt(texture.gradient);
        return {stiffness * depth * (foot.push - slope), depth};
    }
    const glm::dvec3& normal = foot.normal;
    const glm::dvec3 gradient = tangential(texture.gradient, normal);
    // (AP . N): of the way from the tip to the contact along the normal.
    const double pressed = std::max(0.0, foot.depth_m * glm::dot(foot.way, normal));
    switch (rule.model) {
    case ForceModel::displaced: break;
    case ForceModel::paper: return {stiffness * pressed * (normal - gradient), pressed};
    case ForceModel::paper_unit: return {stiffness * pressed * glm::normalize(normal - gradient), pressed};
    case ForceModel::ho99:
        return {stiffness * (pressed * normal - std::min(pressed, texture.raised_m) * gradient), pressed};
    case ForceModel::lateral:
        return {stiffness * (pressed * normal - std::min(pressed, rule.lateral_depth_m) * gradient), pressed};
    }
    return {};
}

glm::dvec3 limited(const glm::dvec3& force_n, double limit_n) noexcept
{
    // Far below, which is nearly always, squares say so; those of huge forces may be infinite.
    if (glm::dot(force_n, force_n) < 0.99 * limit_n * limit_n) return force_n;
    // Scaled by the largest component first, so that no square overflows.
    const glm::dvec3 size = glm::abs(force_n);
    const double largest = std::max({size.x, size.y, size.z});
    if (largest == 0) return force_n;
    const glm::dvec3 scaled = force_n / largest;
    // A few ulp short, so that whoever measures the result finds it within the limit.
    const double limit = limit_n * (1 - 8 * std::numeric_limits<double>::epsilon());
    return largest * glm::length(scaled) <= limit ? force_n : scaled * (limit / glm::length(scaled));
}

} // namespace haptel::runtime
