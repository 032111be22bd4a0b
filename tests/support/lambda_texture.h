// Textures made of C++ functions, so that the runtime is tested without a compiler.
#pragma once

#include "lang/abi/outputs.h"
#include "lang/abi/texture_binding.h"

#include <glm/glm.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>

namespace haptel::tests {

// Height in metres at a point of object space; writes the gradient.
using HeightFunction = std::function<double(const haptel_point&, glm::dvec3& gradient)>;

inline constexpr uint32_t reads_everything =
    HAPTEL_READS_POINT | HAPTEL_READS_NORMAL | HAPTEL_READS_UV | HAPTEL_READS_TIME;

// Writes the whole sample, which comes blank (outputs.h).
using SampleFunction = std::function<void(const haptel_point&, haptel_sample&)>;

// A binding of the function, whose height is promised to stay within [minimum, maximum].
inline TextureBinding sample_lambda(SampleFunction function, double minimum_m, double maximum_m,
                                    uint32_t reads = reads_everything)
{
    struct Block {
        haptel_block_head head = {};
        const SampleFunction* function = nullptr;
    };
    struct Owner {
        SampleFunction function;
        Block block;
        haptel_texture texture = {};
    };
    auto owner = std::make_shared<Owner>();
    owner->function = std::move(function);
    owner->block.function = &owner->function;
    owner->texture.abi = HAPTEL_ABI_VERSION;
    owner->texture.size = sizeof(haptel_texture);
    owner->texture.reads = reads;
    owner->texture.writes = all_outputs;
    owner->texture.block_size = sizeof(Block);
    owner->texture.name = "lambda";
    owner->texture.height_gradient = [](const haptel_point* point, const void* block, haptel_sample* sample) {
        *sample = blank_sample;
        (*static_cast<const Block*>(block)->function)(*point, *sample);
    };

    TextureBinding binding;
    binding.texture = &owner->texture;
    binding.block = &owner->block;
    binding.facts.height_min_m = minimum_m;
    binding.facts.height_max_m = maximum_m;
    binding.owner = std::move(owner);
    return binding;
}

// The same of height and gradient alone.
inline TextureBinding lambda_texture(HeightFunction function, double minimum_m, double maximum_m,
                                     uint32_t reads = reads_everything)
{
    return sample_lambda(
        [function = std::move(function)](const haptel_point& point, haptel_sample& sample) {
            glm::dvec3 gradient(0);
            sample.height_m = function(point, gradient);
            for (int i = 0; i < 3; ++i) sample.gradient[i] = gradient[i];
        },
        minimum_m, maximum_m, reads);
}

inline TextureBinding flat_texture(double height_m)
{
    return lambda_texture([height_m](const haptel_point&, glm::dvec3&) { return height_m; }, height_m, height_m, 0);
}

// A sin(2 pi x / wavelength), along x.
inline TextureBinding sine_texture(double amplitude_m, double wavelength_m)
{
    const double w = 2 * 3.14159265358979323846 / wavelength_m;
    return lambda_texture(
        [amplitude_m, w](const haptel_point& at, glm::dvec3& gradient) {
            gradient.x = amplitude_m * w * std::cos(w * at.p[0]);
            return amplitude_m * std::sin(w * at.p[0]);
        },
        -amplitude_m, amplitude_m);
}

} // namespace haptel::tests
