// Short ways to a compiled texture and to its value at a point.
#pragma once

#include "jit/texture/texture.h"
#include "lang/abi/outputs.h"
#include "tests/jit/codegen/engines.h"

#include <array>
#include <chrono>
#include <thread>

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
    haptel_sample sample = blank_sample;
    binding.texture->height_gradient(&point, binding.block, &sample);
    return sample;
}

inline double height_at(const TextureBinding& binding, double u, double v)
{
    return sample_at(binding, {u, v, 0}).height_m;
}

// With patience: what compiles in the background keeps the program at which it is until it is done with it.
inline bool programs_fall_to(size_t most)
{
    using namespace std::chrono_literals;
    const auto patience = std::chrono::steady_clock::now() + 60s;
    while (jit::programs_alive() > most && std::chrono::steady_clock::now() < patience)
        std::this_thread::sleep_for(1ms);
    return jit::programs_alive() <= most;
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace haptel::test
