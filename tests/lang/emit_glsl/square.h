// A square of points at random, and textures over it as shaders have them. All numbers are such that floats hold them.
#pragma once

#include "lang/emit_glsl/names.h"
#include "tests/lang/emit/float_truth.h"
#include "tests/lang/emit_glsl/shader.h"

namespace haptel::test {

inline constexpr int targets = 5;
inline constexpr const char* versions[] = {"300 es", "320 es"}; // without `precise`, and with it

// What a texture makes of a texel's point: height and gradient, faults, the height alone and its faults, outputs.
inline std::string fragment(const std::string& text, const std::string& name, int side)
{
    return text + "const int side = " + std::to_string(side) + ";" + R"(
uniform highp sampler2D numbers;
uniform haptel_block_)" +
           name + R"( block;
layout(location = 0) out vec4 result0;
layout(location = 1) out vec4 result1;
layout(location = 2) out vec4 result2;
layout(location = 3) out vec4 result3;
layout(location = 4) out vec4 result4;
void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float v[36];
    for (int i = 0; i < 9; ++i) {
        vec4 part = texelFetch(numbers, ivec2(i, at.y * side + at.x), 0);
        for (int j = 0; j < 4; ++j) v[4 * i + j] = part[j];
    }
    haptel_point point = haptel_point_at(vec3(v[0], v[1], v[2]));
    point.n = vec3(v[3], v[4], v[5]);
    point.uv = vec2(v[6], v[7]);
    point.time_s = v[8];
    for (int i = 0; i < 3; ++i) point.n_dp[i] = vec3(v[9 + 3 * i], v[10 + 3 * i], v[11 + 3 * i]);
    for (int i = 0; i < 2; ++i) point.uv_dp[i] = vec3(v[18 + 3 * i], v[19 + 3 * i], v[20 + 3 * i]);
    point.velocity = vec3(v[24], v[25], v[26]);
    point.normal_force_n = v[27];
    point.tool_radius_m = v[28];
    point.tangent = vec3(v[29], v[30], v[31]);
    point.bitangent = vec3(v[32], v[33], v[34]);
    point.curvature_per_m = v[35];
    haptel_sample made = haptel_height_gradient_)" +
           name + R"((point, block), alone = haptel_height_)" + name + R"((point, block);
    result0 = vec4(made.height_m, made.gradient);
    result1 = vec4(float(made.faults), alone.height_m, float(alone.faults), made.stiffness_scale);
    result2 = vec4(made.friction_scale, made.static_friction_scale, made.dynamic_friction_scale, made.damping_scale);
    result3 = vec4(made.friction_direction, made.friction_along_scale);
    result4 = vec4(made.vibration_n, made.vibration_hz, 0.0, 0.0);
}
)";
}

inline void set_block(const Shader& shader, const ir::Texture& texture, const std::vector<double>& block, int32_t image)
{
    const auto floats = [](const double* from, size_t count) { return std::vector<float>(from, from + count); };
    shader.set("block.head.center", floats(block.data(), 3));
    shader.set("block.head.extent", floats(block.data() + 3, 3));
    shader.set("block.head.footprint_m", floats(block.data() + 6, 1));
    const std::vector<std::string> members = emit_glsl::member_names(texture);
    for (size_t i = 0; i < members.size(); ++i) {
        const ir::Parameter& parameter = texture.parameters[i];
        const char* const place = reinterpret_cast<const char*>(block.data()) + parameter.offset;
        double real = 0;
        uint32_t word = 0;
        std::memcpy(&word, place, sizeof word);
        if (parameter.type == ir::Type::real) std::memcpy(&real, place, sizeof real);
        const std::string name = "block." + members[i];
        switch (parameter.type) {
        case ir::Type::real: shader.set(name, floats(&real, 1)); break;
        case ir::Type::u32: shader.set(name, word); break;
        case ir::Type::i32:
        case ir::Type::boolean: shader.set(name, static_cast<int32_t>(word)); break;
        case ir::Type::image: shader.set(name, image); break;
        }
    }
}

// A square of points, and what shaders make of them.
class Square {
public:
    Square(FloatStimuli& stimuli, int of_side) : side(of_side)
    {
        for (int i = 0; i < side * side; ++i) points.push_back(stimuli.point());
    }
    std::unique_ptr<Shader> shader(const std::string& version, const std::string& text, const std::string& name) const
    {
        std::vector<float> numbers;
        for (const haptel_point& point : points) {
            double of_point[numbers_of_point];
            std::memcpy(of_point, &point, sizeof of_point);
            numbers.insert(numbers.end(), of_point, of_point + numbers_of_point);
        }
        auto made = std::make_unique<Shader>(version, fragment(text, name, side), side, targets);
        made->set_numbers("numbers", numbers_of_point / 4, numbers);
        return made;
    }
    // Of what run() gave: of a point, the number that fragment() writes at that place.
    float result(const std::vector<float>& made, size_t point, size_t place) const
    {
        return made[place / 4 * 4 * points.size() + 4 * point + place % 4];
    }

    const int side;
    std::vector<haptel_point> points;
};

} // namespace haptel::test
