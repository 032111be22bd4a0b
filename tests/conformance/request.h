// The last texture of a case, with the box and the parameters of an evaluation.
#pragma once

#include "jit/texture/texture.h"
#include "tests/conformance/case.h"

namespace haptel::lang::test {

inline TextureRequest request_for(const jit::CompiledProgram& program, const Evaluation& at)
{
    TextureRequest request;
    for (size_t i = 0; i < 3; ++i) {
        request.box_minimum_m[i] = at.head.center[i] - at.head.extent[i] / 2;
        request.box_maximum_m[i] = at.head.center[i] + at.head.extent[i] / 2;
    }
    request.footprint_m = at.head.footprint_m;
    const haptel_texture& texture = program.textures().back();
    for (const auto& [name, value] : at.parameters)
        for (uint32_t i = 0; i < texture.parameter_count; ++i)
            if (name == texture.parameters[i].name)
                request.parameters.emplace_back(
                    name, texture.parameters[i].type == HAPTEL_BOOL ? (value == "0" ? "false" : "true") : value);
    return request;
}

} // namespace haptel::lang::test
