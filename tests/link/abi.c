/* The contract from plain C99: its layout is a promise to libraries that were compiled before, so it is written down
 * here in bytes, for machines with 8-byte doubles and pointers. */
#include "lang/abi/abi.h"

#include <stddef.h>
#include <stdio.h>

static int wrong;

static void expect(const char* what, size_t expected, size_t found)
{
    if (expected == found) return;
    printf("%s: expected %lu bytes, found %lu\n", what, (unsigned long)expected, (unsigned long)found);
    wrong = 1;
}

static void flat(const haptel_point* point, const void* block, haptel_sample* sample)
{
    (void)point;
    sample->height_m = ((const haptel_block_head*)block)->footprint_m;
    sample->faults = 0;
}

int main(void)
{
    static haptel_point point;
    static haptel_block_head block;
    static haptel_sample sample;
    static haptel_texture texture;

    texture.abi = HAPTEL_ABI_VERSION;
    texture.size = sizeof texture;
    texture.height = flat;
    block.footprint_m = 0.125;
    texture.height(&point, &block, &sample);
    if (sample.height_m != 0.125) wrong = 1;

    expect("haptel_point", 288, sizeof(haptel_point));
    expect("haptel_point.n", 24, offsetof(haptel_point, n));
    expect("haptel_point.uv", 48, offsetof(haptel_point, uv));
    expect("haptel_point.time_s", 64, offsetof(haptel_point, time_s));
    expect("haptel_point.n_dp", 72, offsetof(haptel_point, n_dp));
    expect("haptel_point.uv_dp", 144, offsetof(haptel_point, uv_dp));
    expect("haptel_point.velocity", 192, offsetof(haptel_point, velocity));
    expect("haptel_point.normal_force_n", 216, offsetof(haptel_point, normal_force_n));
    expect("haptel_point.tool_radius_m", 224, offsetof(haptel_point, tool_radius_m));
    expect("haptel_point.tangent", 232, offsetof(haptel_point, tangent));
    expect("haptel_point.bitangent", 256, offsetof(haptel_point, bitangent));
    expect("haptel_point.curvature_per_m", 280, offsetof(haptel_point, curvature_per_m));
    expect("haptel_sample.gradient", 8, offsetof(haptel_sample, gradient));
    expect("haptel_sample.stiffness_scale", 32, offsetof(haptel_sample, stiffness_scale));
    expect("haptel_sample.friction_scale", 40, offsetof(haptel_sample, friction_scale));
    expect("haptel_sample.faults", 48, offsetof(haptel_sample, faults));
    expect("haptel_sample.static_friction_scale", 56, offsetof(haptel_sample, static_friction_scale));
    expect("haptel_sample.dynamic_friction_scale", 64, offsetof(haptel_sample, dynamic_friction_scale));
    expect("haptel_sample.damping_scale", 72, offsetof(haptel_sample, damping_scale));
    expect("haptel_sample.friction_along_scale", 80, offsetof(haptel_sample, friction_along_scale));
    expect("haptel_sample.friction_direction", 88, offsetof(haptel_sample, friction_direction));
    expect("haptel_sample.vibration_n", 112, offsetof(haptel_sample, vibration_n));
    expect("haptel_sample.vibration_hz", 120, offsetof(haptel_sample, vibration_hz));
    expect("haptel_samples.faults", 48, offsetof(haptel_samples, faults));
    expect("haptel_samples.friction_direction", 88, offsetof(haptel_samples, friction_direction));
    expect("haptel_samples.vibration_n", 112, offsetof(haptel_samples, vibration_n));
    expect("haptel_block_head.extent", 24, offsetof(haptel_block_head, extent));
    expect("haptel_block_head.footprint_m", 48, offsetof(haptel_block_head, footprint_m));
    expect("haptel_block_head", 56, sizeof(haptel_block_head));
    expect("haptel_facts.continuity", 32, offsetof(haptel_facts, continuity));
    expect("haptel_parameter.value", 32, offsetof(haptel_parameter, value));
    expect("haptel_texture.name", 24, offsetof(haptel_texture, name));
    expect("haptel_texture.facts", 40, offsetof(haptel_texture, facts));
    expect("haptel_texture.height", 80, offsetof(haptel_texture, height));
    expect("haptel_texture.height_gradient", 88, offsetof(haptel_texture, height_gradient));
    expect("haptel_texture.height_gradient_batch", 104, offsetof(haptel_texture, height_gradient_batch));
    expect("haptel_texture.choices", 112, offsetof(haptel_texture, choices));
    return wrong;
}
