#include "bench/generated_texture.h"

#include <algorithm>

namespace haptel::bench {
namespace {

constexpr uint32_t lines_per_part = 15; // with its call

std::string part(uint32_t index)
{
    const std::string number = std::to_string(index);
    return "/// Part " + number +
           " of the field.\n"
           "float part" +
           number +
           "(vec3 q, float gain)\n"
           "{\n"
           "    float a = dot(q, vec3(0.3, " +
           std::to_string(index % 7) +
           ".5, 0.2));\n"
           "    float b = sinturn(a) * gain;\n"
           "    for (int i = 0; i < 3; ++i) {\n"
           "        b += 0.25 * perlin(q + vec3(a, b, float(i)));\n"
           "        if (b > 2.0) b -= 1.0;\n"
           "    }\n"
           "    vec2 w = q.xy * (1.0 + 0.1 * b);\n"
           "    b = mix(b, noise(w), smoothstep(0.0, 1.0, a));\n"
           "    return clamp(b, -4.0, 4.0);\n"
           "}\n"
           "\n";
}

} // namespace

std::string generated_texture(uint32_t lines)
{
    const uint32_t parts = std::max(lines, 40u) / lines_per_part;
    std::string text, calls;
    for (uint32_t i = 0; i < parts; ++i) {
        text += part(i);
        calls += "    h += part" + std::to_string(i) + "(q, 0.5);\n";
    }
    return text +
           "texture field(float depth = 50um in 0um .. 200um, float wavelength = 3mm in 1mm .. 9mm)\n"
           "{\n"
           "    vec3 q = p / wavelength;\n"
           "    float h = 0.0;\n" +
           calls + "    return depth * h;\n}\n";
}

} // namespace haptel::bench
