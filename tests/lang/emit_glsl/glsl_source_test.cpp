// Textures as GLSL: glslang takes the text in every version that it is for, and what Mesa computes with it is what
// rounding each operation to f32 can lead to from the 113-bit truth (support/ball.h).
#include "lang/emit_glsl/image_words.h"
#include "lang/emit_glsl/names.h"
#include "lang/emit_glsl/source.h"
#include "tests/fuzz/random_source.h"
#include "tests/lang/emit_glsl/square.h"
#include "tests/support/haptel_files.h"
#include "tests/support/tries.h"

using namespace haptel;
using namespace haptel::test;

namespace {

// Of all textures of a program in Mesa, by each version in turns: numbers that rounding cannot lead to are failures.
class Comparison {
public:
    void add(const lang::Program& program)
    {
        ir::Interpreter<Ball> interpreter(program.module);
        for (const emit_c::LibraryTexture& one : textures_of(program)) {
            const ir::Texture& texture = *one.texture;
            // Each alone: Mesa takes as long over the others in its text, which are not called.
            const std::string text = emit_glsl::source("textures", std::span(&one, 1)),
                              name = emit_glsl::texture_names(std::array{&texture})[0];
            CAPTURE(texture.name);
            FloatStimuli stimuli(7);
            const Square square(stimuli, 3);
            std::vector<uint32_t> words;
            const int32_t image = emit_glsl::append_image(words, stimuli.picture());
            const char* const version = versions[count++ % std::size(versions)];
            const std::unique_ptr<Shader> shader = square.shader(version, text, name);
            shader->set_words("haptel_images", 16, words);
            for (const bool is_default : {true, false}) {
                const std::vector<double> block = stimuli.block(texture, is_default);
                set_block(*shader, texture, block, image);
                const std::vector<float> made = shader->run();
                for (size_t point = 0; point < square.points.size(); ++point) {
                    const std::vector<Expected> all = expected(interpreter, texture, square.points[point], block);
                    ++samples;
                    undecided += all.empty();
                    for (const Expected& number : all) {
                        ++numbers;
                        loose += !(number.ball.radius < 1e-3 * fabs(number.ball.middle) + 1e-7);
                        const float found = square.result(made, point, number.place);
                        if (number.ball.may_be(found)) continue;
                        CAPTURE(version, point, number.what, found);
                        CHECK(static_cast<double>(number.ball) == found);
                    }
                }
            }
        }
    }
    // How much the comparison says.
    void tell() const
    {
        WARN(context.renderer() << ": of " << samples << " samples rounding decides " << undecided << "; of " << numbers
                                << " numbers it may change " << loose << " by a thousandth or more");
    }

    size_t count = 0, samples = 0, undecided = 0, numbers = 0, loose = 0;

private:
    const ShaderContext context;
};

} // namespace

TEST_CASE("in Mesa a texture's GLSL gives what rounding to f32 can lead to")
{
    Comparison comparison;
    for (const auto& file : all_texture_files()) {
        CAPTURE(file);
        comparison.add(*program_of(file, text_of(file)));
    }
    comparison.tell();
    CHECK(comparison.undecided < comparison.samples / 4);
    CHECK(comparison.loose < comparison.numbers / 4);
}

TEST_CASE("in Mesa random programs give what rounding to f32 can lead to")
{
    Comparison comparison;
    for (uint64_t seed = 0; seed < tries(60u); ++seed) {
        if (seed % 8 == 3) continue; // those may be refused
        const std::string text = fuzz::random_source(seed);
        const lang::CompileResult result = lang::compile({"random.haptel", text}, {});
        if (!result.program) continue; // larger than the language allows
        CAPTURE(seed, text);
        comparison.add(*result.program);
    }
    comparison.tell();
    CHECK(comparison.count >= tries(40u));
    CHECK(comparison.numbers > tries(3000u));
}

TEST_CASE("several texts stand in one shader, whatever textures and parameters are called")
{
    const auto odd = program_of("odd.haptel", R"(
/// Ends with a backslash \\
texture a__b(float highp = 1mm in 0mm .. 2mm, int sample = 3 in 1 .. 5, uint u = 4000000000u, bool on = true,
             vec2 size = vec2(1mm, 2mm), int kind = flat in {flat, round}, float gl_x = 1mm, float head = 0mm,
             float length = 1mm, float x__y = 1mm, float x_y = 2mm)
{
    return on ? highp * sinturn(p.x / size.y) + x__y + x_y + gl_x + head + length : 0mm;
}
texture a_b(float isampler2D = 3mm) { return isampler2D * cos(p.x / 1m); }
)");
    const auto other = program_of("other.haptel", "texture main(int depth = -2147483648) { return 1mm * "
                                                  "cos(p.x / 1m) * float(depth) / 2147483648.0 * sinturn(p.y / 1m); }");
    const std::string both =
        emit_glsl::source("odd", textures_of(*odd)) + emit_glsl::source("the other", textures_of(*other));
    const ShaderContext context;
    FloatStimuli stimuli(1);
    const Square square(stimuli, 2);
    for (const char* version : versions) {
        for (const auto& [program, index, name] : {std::tuple{odd, 0, "a_b"}, {odd, 1, "a_b_"}, {other, 0, "main"}}) {
            const ir::Texture& texture = program->module.textures[static_cast<size_t>(index)];
            CAPTURE(version, name);
            const auto shader = square.shader(version, both, name);
            const std::vector<double> block = stimuli.block(texture, true);
            set_block(*shader, texture, block, 0);
            const std::vector<float> made = shader->run();
            ir::Interpreter<double> interpreter(program->module);
            for (size_t i = 0; i < square.points.size(); ++i) {
                const double truth = interpreted(interpreter, texture, square.points[i], block, false).height_m;
                CHECK(std::fabs(square.result(made, i, 0) - truth) < 1e-6 * (std::fabs(truth) + 1e-4));
            }
        }
    }
}

TEST_CASE("glslang takes a texture's GLSL in every version that it is for")
{
    if (std::system("command -v glslangValidator >/dev/null") != 0) {
        WARN("not tried: glslangValidator (glslang-tools) is not here");
        return;
    }
    const Folder folder;
    std::string files;
    size_t count = 0;
    for (const auto& file : all_texture_files()) {
        const auto program = program_of(file, text_of(file));
        const std::string text = emit_glsl::source(file.stem().string(), textures_of(*program));
        for (const char* version : {"300 es", "320 es", "330", "450"}) {
            const std::string name = std::to_string(count++) + ".frag";
            folder.write(name, "#version " + std::string(version) + "\n" + text +
                                   "out highp vec4 colour;\nvoid main()\n{\n    colour = vec4(0.0);\n}\n");
            files += " " + name;
        }
    }
    INFO(folder.path);
    CHECK(std::system(("cd '" + folder.path.string() + "' && glslangValidator" + files + " >said").c_str()) == 0);
    INFO(text_of(folder.path / "said"));
    CHECK(text_of(folder.path / "said").find("ERROR") == std::string::npos);
}
