#include "runtime/force_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

std::optional<ForceModel> force_model_named(std::string_view name)
{
    const auto found = std::find(force_model_names.begin(), force_model_names.end(), name);
    if (found == force_model_names.end()) return std::nullopt;
    return static_cast<ForceModel>(found - force_model_names.begin());
}

ModelForce model_force(const ForceRule& rule, const TouchedSurface& surface, const TextureSample& texture) noexcept
{
    const double stiffness = surface.stiffness_n_per_m * texture.stiffness_scale;
    const glm::dvec3& normal = surface.normal;
    const glm::dvec3& gradient = texture.surface_gradient;
    // (AP . N): of the way from the tip to the contact along the shaded normal.
    const double pressed = std::max(0.0, surface.depth_m * glm::dot(surface.contact_normal, normal));
    switch (rule.model) {
    case ForceModel::displaced: {
        const double depth = std::max(0.0, surface.depth_m + texture.envelope_m);
        if (depth == 0) break;
        return {stiffness * depth * (normal - gradient_at_depth(gradient, surface.normal_dp, surface.depth_m)), depth};
    }
    case ForceModel::paper: return {stiffness * pressed * (normal - gradient), pressed};
    case ForceModel::paper_unit: return {stiffness * pressed * glm::normalize(normal - gradient), pressed};
    case ForceModel::ho99:
        return {stiffness * (pressed * normal - std::min(pressed, texture.raised_m) * gradient), pressed};
    case ForceModel::lateral:
        return {stiffness * (pressed * normal - std::min(pressed, rule.lateral_depth_m) * gradient), pressed};
    }
    return {};
}

glm::dvec3 gradient_at_depth(const glm::dvec3& gradient, const glm::dmat3& normal_dp, double depth_m) noexcept
{
    constexpr double turn_max = 0.5; // the inverse exists for every norm below 1
    glm::dmat3 turn = depth_m * normal_dp;
    const double size = std::sqrt(glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) + glm::dot(turn[2], turn[2]));
    if (size == 0 || !std::isfinite(size)) return gradient;
    if (size > turn_max) turn *= turn_max / size;
    return glm::inverse(glm::transpose(glm::dmat3(1) - turn)) * gradient;
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
