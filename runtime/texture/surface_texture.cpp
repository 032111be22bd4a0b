#include "runtime/texture/surface_texture.h"

#include "lang/abi/contact_limits.h"
#include "lang/abi/outputs.h"
#include "runtime/geometry/finite.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>

namespace haptel::runtime {

namespace {

// Heights may exceed their bound by rounding only.
constexpr double bound_slack_m = 1e-12;

// Unit, along the surface, where the coordinate with this gradient grows and that with the other stays; 0: nowhere.
glm::dvec3 way_of_growth(const glm::dvec3& gradient, const glm::dvec3& other, const glm::dvec3& normal)
{
    const glm::dvec3 along = glm::cross(other, normal);
    const double length = glm::length(along), growth = glm::dot(gradient, along);
    return length > 0 && growth != 0 ? along * (std::copysign(1.0, growth) / length) : glm::dvec3(0);
}

// What tells of the contact itself, within contact_limits.h.
template <typename Set>
void take_in_contact(const SurfacePoint& at, uint32_t reads, const Set& set, haptel_point& point)
{
    if (reads & HAPTEL_READS_VELOCITY) {
        const double speed = glm::length(at.velocity_m_per_s);
        const double share = speed > contact_speed_max_m_per_s ? contact_speed_max_m_per_s / speed : 1.0;
        set(point.velocity, finite(at.velocity_m_per_s) ? share * at.velocity_m_per_s : glm::dvec3(0));
    }
    if (reads & HAPTEL_READS_NORMAL_FORCE)
        set(point.normal_force_n, std::clamp(at.normal_force_n, 0.0, normal_force_max_n));
    if (reads & HAPTEL_READS_TOOL_RADIUS) set(point.tool_radius_m, std::min(at.tool_radius_m, tool_radius_max_m));
    if (reads & HAPTEL_READS_TANGENT) {
        const glm::dmat2x3 by_coordinate = glm::transpose(at.shading.uv_dp);
        set(point.tangent, way_of_growth(by_coordinate[0], by_coordinate[1], at.shading.normal));
        set(point.bitangent, way_of_growth(by_coordinate[1], by_coordinate[0], at.shading.normal));
    }
    if (reads & HAPTEL_READS_CURVATURE) {
        const glm::dmat3& turn = at.shading.normal_dp;
        set(point.curvature_per_m,
            std::clamp((turn[0][0] + turn[1][1] + turn[2][2]) / 2, -curvature_max_per_m, curvature_max_per_m));
    }
}

// Takes the inputs that the entry reads into a point whose others are zero. Whether one of them is another than it was.
bool take_in(haptel_point& point, const SurfacePoint& at, uint32_t reads)
{
    bool changed = false;
    const auto set = [&](double& input, double value) {
        changed |= std::bit_cast<uint64_t>(input) != std::bit_cast<uint64_t>(value);
        input = value;
    };
    for (int i = 0; i < 3; ++i) set(point.p[i], at.p_m[i]);
    if (reads & HAPTEL_READS_NORMAL) {
        for (int i = 0; i < 3; ++i) {
            set(point.n[i], at.shading.normal[i]);
            for (int j = 0; j < 3; ++j) set(point.n_dp[i][j], at.shading.normal_dp[j][i]);
        }
    }
    if (reads & HAPTEL_READS_UV) {
        for (int i = 0; i < 2; ++i) {
            set(point.uv[i], at.shading.uv[i]);
            for (int j = 0; j < 3; ++j) set(point.uv_dp[i][j], at.shading.uv_dp[j][i]);
        }
    }
    if (reads & HAPTEL_READS_TIME) set(point.time_s, at.time_s);
    if (reads >= HAPTEL_READS_VELOCITY)
        take_in_contact(
            at, reads,
            [&](auto& input, const auto& value) {
                if constexpr (std::is_array_v<std::remove_reference_t<decltype(input)>>)
                    for (int i = 0; i < 3; ++i) set(input[i], value[i]);
                else
                    set(input, value);
            },
            point);
    return changed;
}

// Bindings are made by code that is not ours: the guarantees of abi.h are checked again at the last door before the
// motors.
void distrust(haptel_sample& sample, uint32_t writes)
{
    glm::dvec3 gradient(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
    const double sum = sample.height_m + gradient.x + gradient.y + gradient.z; // finite if they are not too large
    if (!(writes & ~outputs_always_written) && std::isfinite(sum + sample.stiffness_scale + sample.friction_scale) &&
        sample.stiffness_scale >= 0 && sample.friction_scale >= 0)
        return;
    const bool height_ok = std::isfinite(sample.height_m);
    if (!height_ok) {
        sample.height_m = 0;
        sample.faults |= HAPTEL_FAULT_HEIGHT_NOT_FINITE;
    }
    if (!finite(gradient)) sample.faults |= HAPTEL_FAULT_GRADIENT_NOT_FINITE;
    if (!height_ok || !finite(gradient))
        for (double& g : sample.gradient) g = 0;
    for (const OutputInfo& output : output_table) {
        const std::span components(components_of(sample, output), output.components);
        if (std::ranges::all_of(components,
                                [&](double x) { return std::isfinite(x) && (x >= 0 || !output.is_never_negative); }))
            continue;
        std::ranges::fill(components, output.value);
        sample.faults |= HAPTEL_FAULT_OUTPUT_NOT_FINITE;
    }
}

void evaluate(const TextureBinding& binding, const haptel_point& point, haptel_sample& sample)
{
    sample = blank_sample;
    binding.texture->height_gradient(&point, binding.block, &sample);
    distrust(sample, binding.texture->writes);
}

TextureSample felt_within(const TextureBinding& binding, const haptel_sample& sample, const glm::dvec3& normal)
{
    TextureSample result;
    result.height_m = sample.height_m;
    result.envelope_m = std::min(0.0, sample.height_m - binding.facts.height_max_m);
    result.raised_m = std::max(0.0, sample.height_m - std::min(0.0, binding.facts.height_min_m));
    result.gradient = {sample.gradient[0], sample.gradient[1], sample.gradient[2]};
    result.stiffness_scale = sample.stiffness_scale;
    result.static_friction_scale = sample.friction_scale * sample.static_friction_scale;
    result.dynamic_friction_scale = sample.friction_scale * sample.dynamic_friction_scale;
    result.damping_scale = sample.damping_scale;
    result.vibration_n = sample.vibration_n;
    result.vibration_hz = sample.vibration_hz;
    result.faults = sample.faults;
    if (binding.texture->writes & HAPTEL_WRITES_FRICTION_DIRECTION) {
        const auto& d = sample.friction_direction;
        result.grain = grain_along({d[0], d[1], d[2]}, sample.friction_along_scale, normal);
    }
    if (sample.height_m - binding.facts.height_max_m > bound_slack_m) {
        result.gradient = glm::dvec3(0);
        result.faults |= fault_height_above_bound;
    }
    return result;
}

// `beyond` the beginning of a shoulder, > 0: what is left of it, and how fast that grows with it.
struct Bent {
    double value, slope;
    Bent(double beyond, double shoulder)
    {
        const double t = std::min(1.0, beyond / shoulder);
        value = shoulder * (t - t * t * t * (1 - 0.5 * t));
        slope = 1 - t * t * (3 - 2 * t);
    }
};

// Where a shoulder begins, at the lower and the upper end.
bool is_on_shoulder(const TextureBinding& binding, double height_m)
{
    const double* shoulder_m = binding.shoulder_m;
    return (shoulder_m[1] > 0 && height_m > binding.facts.height_max_m - 0.5 * shoulder_m[1]) ||
           (shoulder_m[0] > 0 && height_m < binding.facts.height_min_m + 0.5 * shoulder_m[0]);
}

haptel_sample bent_on_shoulder(const TextureBinding& binding, haptel_sample sample)
{
    const double lower = binding.facts.height_min_m + 0.5 * binding.shoulder_m[0],
                 upper = binding.facts.height_max_m - 0.5 * binding.shoulder_m[1];
    const bool below = binding.shoulder_m[0] > 0 && sample.height_m < lower;
    const Bent bent = below ? Bent(lower - sample.height_m, binding.shoulder_m[0])
                            : Bent(sample.height_m - upper, binding.shoulder_m[1]);
    sample.height_m = below ? std::max(lower - bent.value, binding.facts.height_min_m)
                            : std::min(upper + bent.value, binding.facts.height_max_m);
    for (double& g : sample.gradient) g *= bent.slope;
    sample.faults |= fault_height_bent;
    return sample;
}

TextureSample felt(const TextureBinding& binding, const haptel_sample& sample, const glm::dvec3& normal)
{
    if (is_on_shoulder(binding, sample.height_m))
        return felt_within(binding, bent_on_shoulder(binding, sample), normal);
    return felt_within(binding, sample, normal);
}

TextureSample sample_again(const PublishedBinding& published, const SurfacePoint& at, LastSample& last)
{
    const auto& [serial, binding] = published;
    if (!binding.texture) return {};
    const bool is_new = last.serial != serial;
    if (is_new) last = {.serial = serial};
    if (take_in(last.point, at, binding.texture->reads) || is_new) evaluate(binding, last.point, last.sample);
    return felt(binding, last.sample, at.shading.normal);
}

} // namespace

TextureSample sample_texture(const TextureBinding& binding, const SurfacePoint& at) noexcept
{
    if (!binding.texture) return {};
    haptel_point point = {};
    haptel_sample sample;
    take_in(point, at, binding.texture->reads);
    evaluate(binding, point, sample);
    return felt(binding, sample, at.shading.normal);
}

TextureSample sample_texture(const TextureReader& reader, const SurfacePoint& at, LastSample& last) noexcept
{
    if (!reader.fading()) return sample_again(reader.to(), at, last);
    return mixed(sample_texture(reader.from().binding, at), sample_again(reader.to(), at, last), reader.weight());
}

TextureSample mixed(const TextureSample& from, const TextureSample& to, double share) noexcept
{
    const auto mix = [share](const auto& a, const auto& b) { return a + share * (b - a); };
    const double vibration_n = mix(from.vibration_n, to.vibration_n);
    // By how strong each is: what comes or goes keeps its frequency.
    const double weight = vibration_n > 0 ? share * to.vibration_n / vibration_n : 0.0;
    return {.height_m = mix(from.height_m, to.height_m),
            .envelope_m = mix(from.envelope_m, to.envelope_m),
            .raised_m = mix(from.raised_m, to.raised_m),
            .gradient = mix(from.gradient, to.gradient),
            .stiffness_scale = mix(from.stiffness_scale, to.stiffness_scale),
            .static_friction_scale = mix(from.static_friction_scale, to.static_friction_scale),
            .dynamic_friction_scale = mix(from.dynamic_friction_scale, to.dynamic_friction_scale),
            .damping_scale = mix(from.damping_scale, to.damping_scale),
            .vibration_n = vibration_n,
            .vibration_hz = std::lerp(from.vibration_hz, to.vibration_hz, weight),
            .grain = mixed(from.grain, to.grain, share),
            .faults = from.faults | to.faults};
}

uint32_t texture_reads(const TextureReader& reader) noexcept
{
    const auto reads = [](const PublishedBinding& p) { return p.binding.texture ? p.binding.texture->reads : 0u; };
    return reads(reader.to()) | (reader.fading() ? reads(reader.from()) : 0u);
}

} // namespace haptel::runtime
