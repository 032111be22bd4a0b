// What Mesa makes of each operation of the IR in GLSL, beside the interpreter: off by how many units in the last place
// of a float.
#include "lang/emit_glsl/source.h"
#include "tests/lang/emit_glsl/square.h"

using namespace haptel;
using namespace haptel::test;

TEST_CASE("every operation in GLSL, and how far it is off")
{
    struct Term {
        const char* text;
        double ulp;       // of a float
        double least = 0; // no smaller one than this number's: near 0 a sum has lost what it is made of
    };
    constexpr Term terms[] = {{"sin(p.x)", 2},
                              {"cos(p.x)", 2},
                              {"tan(p.x)", 4},
                              {"asin(0.25 * p.x)", 2},
                              {"acos(0.25 * p.x)", 2},
                              {"atan(p.x)", 2},
                              {"atan(p.x, p.y)", 2},
                              {"atanpi(p.x, p.y)", 2},
                              {"sinh(p.x)", 4},
                              {"cosh(p.x)", 4},
                              {"tanh(p.x)", 4},
                              {"asinh(p.x)", 4, 1},
                              {"acosh(p.x)", 4},
                              {"atanh(0.25 * p.x)", 4, 1},
                              {"exp(p.x)", 2},
                              {"exp2(p.x)", 2},
                              {"log(p.x)", 2},
                              {"log2(p.x)", 2},
                              {"pow(p.x, p.y)", 6},
                              {"pow(abs(p.x), 16.0 * p.y)", 32},
                              {"pow(p.x, float(a % 8))", 6},
                              {"sinturn(p.x)", 2},
                              {"costurn(p.x)", 2},
                              {"sqrt(p.x)", 0.5},
                              {"length(p.xy)", 2},
                              {"length(p)", 2},
                              {"length(vec4(p, p.x))", 2},
                              {"mod(p.x, 0.5)", 0.5},
                              {"fract(p.x)", 0.5},
                              {"min(p.x, p.y)", 0.5},
                              {"max(p.x, p.y)", 0.5},
                              {"abs(p.x)", 0.5},
                              {"sign(p.x)", 0.5},
                              {"floor(p.x)", 0.5},
                              {"ceil(p.x)", 0.5},
                              {"trunc(p.x)", 0.5},
                              {"round(p.x)", 0.5},
                              {"p.x / p.y", 2.5},
                              {"p.x < p.y ? p.z : 2.0 * p.z", 0.5},
                              {"float(int(p.x))", 0.5},
                              {"float(uint(p.x))", 0.5},
                              {"float(a + b)", 0.5},
                              {"float(a - b)", 0.5},
                              {"float(a * b)", 0.5},
                              {"float(a / b)", 0.5},
                              {"float(a % b)", 0.5},
                              {"float(a & b)", 0.5},
                              {"float(a | b)", 0.5},
                              {"float(a ^ b)", 0.5},
                              {"float(a << b)", 0.5},
                              {"float(a >> b)", 0.5},
                              {"float(min(a, b))", 0.5},
                              {"float(max(a, b))", 0.5},
                              {"float(c / d)", 0.5},
                              {"float(c % d)", 0.5},
                              {"float(c >> d)", 0.5},
                              {"float(min(c, d))", 0.5},
                              {"float(max(c, d))", 0.5},
                              {"float(int(c))", 0.5},
                              {"a < b ? 1.0 : 0.0", 0.5},
                              {"c < d ? 1.0 : 0.0", 0.5},
                              {"a == b || c <= d ? 1.0 : 0.0", 0.5},
                              {"a != b && !(a <= b) ? 1.0 : 0.0", 0.5},
                              {"(a < b) != (c < d) ? 1.0 : 0.0", 0.5}};
    std::string text;
    for (size_t i = 0; i < std::size(terms); ++i)
        text += "texture t" + std::to_string(i) + "(int a = 1, int b = 1, uint c = 1u, uint d = 1u) { return 1.0 * (" +
                terms[i].text + "); }\n";
    const auto program = program_of("t.haptel", text);
    const std::vector<emit_c::LibraryTexture> textures = textures_of(*program);
    ir::Interpreter<double> interpreter(program->module);
    const ShaderContext context;
    std::mt19937 random(3);
    constexpr uint32_t words[] = {0, 1, ~0u, 0x80000000u, 0x7fffffffu, 31, 33};
    for (size_t index = 0; index < textures.size(); ++index) {
        const ir::Texture& texture = program->module.textures[index];
        const Term& term = terms[index];
        // Each alone: Mesa takes as long over the others in its text, which are not called.
        const std::string glsl = emit_glsl::source("t", std::span(&textures[index], 1));
        FloatStimuli stimuli(5);
        Square square(stimuli, 16);
        for (haptel_point& point : square.points)
            for (double& number : point.p) number = static_cast<float>(number * 200); // -4 .. 4
        for (const char* version : versions) {
            const auto shader = square.shader(version, glsl, texture.name);
            double worst = 0;
            for (int round = 0; round < 8; ++round) {
                std::vector<double> block(texture.block_size / sizeof(double));
                for (const ir::Parameter& parameter : texture.parameters) {
                    const uint32_t word =
                        random() % 2 ? static_cast<uint32_t>(random()) : words[random() % std::size(words)];
                    std::memcpy(reinterpret_cast<char*>(block.data()) + parameter.offset, &word, sizeof word);
                }
                set_block(*shader, texture, block, 0);
                const std::vector<float> made = shader->run();
                for (size_t i = 0; i < square.points.size(); ++i) {
                    const double truth = interpreted(interpreter, texture, square.points[i], block, false).height_m;
                    const auto near = static_cast<float>(std::max(std::fabs(truth), term.least));
                    const double ulp = std::nextafterf(near, HUGE_VALF) - near;
                    worst = std::max(worst, std::fabs(square.result(made, i, 5) - truth) / ulp);
                }
            }
            CAPTURE(term.text, version, worst);
            CHECK(worst <= term.ulp);
        }
    }
}
