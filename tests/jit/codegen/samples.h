// Short ways to a compiled texture and to its value at a point.
#pragma once

#include "jit/texture/texture.h"
#include "tests/jit/codegen/engines.h"

#include <array>

namespace haptel::test {

inline std::shared_ptr<const jit::CompiledProgram> compiled(std::string_view text)
{
    const jit::CompiledTextures result = jit::compile_texture(text);
    INFO(result.rendered());
    REQUIRE(result.program);
    return result.program;
}

// Over a cube round the origin.
inline TextureRequest request_over(double side_m)
{
    TextureRequest request;
    for (size_t i = 0; i < 3; ++i) {
        request.box_minimum_m[i] = -side_m / 2;
        request.box_maximum_m[i] = side_m / 2;
    }
    return request;
}

inline haptel_sample sample_at(const TextureBinding& binding, const std::array<double, 3>& p_m)
{
    haptel_point point{};
    std::copy(p_m.begin(), p_m.end(), point.p);
    point.n[2] = 1;
    haptel_sample sample{};
    binding.texture->height_gradient(&point, binding.block, &sample);
    return sample;
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace haptel::test
