#include "runtime/force/force_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

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
        const double below_m = surface.depth_m - surface.held_above_m;
        return {stiffness * depth * (normal - gradient_at_depth(gradient, surface.normal_dp, below_m)), depth};
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
    constexpr double turn_max = 0.5;
    glm::dmat3 turn = depth_m * normal_dp;
    // It has no part across the surface: two eigenvalues from trace and principal minors, the third is 0.
    const double half_trace = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2]);
    const auto minor = [&](int i, int j) { return turn[i][i] * turn[j][j] - turn[i][j] * turn[j][i]; };
    const double minors = minor(0, 1) + minor(0, 2) + minor(1, 2);
    const double largest = half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - minors));
    if (turn == glm::dmat3(0) || !std::isfinite(largest)) return gradient;
    if (largest > turn_max) turn *= turn_max / largest;
    const glm::dvec3 felt = glm::inverse(glm::transpose(glm::dmat3(1) - turn)) * gradient;
    return std::isfinite(felt.x + felt.y + felt.z) ? felt : gradient;
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
