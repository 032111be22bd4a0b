#include "runtime/texture/surface_texture.h"

#include "lang/abi/outputs.h"
#include "runtime/geometry/finite.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace haptel::runtime {

namespace {

// Heights may exceed their bound by rounding only.
constexpr double bound_slack_m = 1e-12;

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
        if (std::ranges::all_of(components, [&](double x) { return std::isfinite(x) && (x >= 0 || !output.is_scale); }))
            continue;
        std::ranges::fill(components, output.value);
        sample.faults |= HAPTEL_FAULT_OUTPUT_NOT_FINITE;
    }
}

haptel_sample evaluate(const TextureBinding& binding, const haptel_point& point)
{
    haptel_sample sample = blank_sample;
    binding.texture->height_gradient(&point, binding.block, &sample);
    distrust(sample, binding.texture->writes);
    return sample;
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

} // namespace

TextureSample sample_texture(const TextureBinding& binding, const SurfacePoint& at) noexcept
{
    if (!binding.texture) return {};
    haptel_point point = {};
    take_in(point, at, binding.texture->reads);
    return felt(binding, evaluate(binding, point), at.shading.normal);
}

TextureSample sample_texture(const TextureReader& reader, const SurfacePoint& at, LastSample& last) noexcept
{
    const auto& [serial, binding] = reader.to();
    TextureSample to;
    if (binding.texture) {
        const bool is_new = last.serial != serial;
        if (is_new) last = {.serial = serial};
        if (take_in(last.point, at, binding.texture->reads) || is_new) last.sample = evaluate(binding, last.point);
        to = felt(binding, last.sample, at.shading.normal);
    }
    return reader.fading() ? mixed(sample_texture(reader.from().binding, at), to, reader.weight()) : to;
}

TextureSample mixed(const TextureSample& from, const TextureSample& to, double share) noexcept
{
    const auto mix = [share](const auto& a, const auto& b) { return a + share * (b - a); };
    return {.height_m = mix(from.height_m, to.height_m),
            .envelope_m = mix(from.envelope_m, to.envelope_m),
            .raised_m = mix(from.raised_m, to.raised_m),
            .gradient = mix(from.gradient, to.gradient),
            .stiffness_scale = mix(from.stiffness_scale, to.stiffness_scale),
            .static_friction_scale = mix(from.static_friction_scale, to.static_friction_scale),
            .dynamic_friction_scale = mix(from.dynamic_friction_scale, to.dynamic_friction_scale),
            .damping_scale = mix(from.damping_scale, to.damping_scale),
            .grain = mixed(from.grain, to.grain, share),
            .faults = from.faults | to.faults};
}

uint32_t texture_reads(const TextureReader& reader) noexcept
{
    const auto reads = [](const PublishedBinding& p) { return p.binding.texture ? p.binding.texture->reads : 0u; };
    return reads(reader.to()) | (reader.fading() ? reads(reader.from()) : 0u);
}

} // namespace haptel::runtime
