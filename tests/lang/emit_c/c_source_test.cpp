// Textures as C text: compiled by the compilers of this machine, without a warning, they are what the interpreter says,
// in float what rounding can make of it.
#include "lang/emit_c/header.h"
#include "lang/emit_c/source.h"
#include "tests/lang/emit/float_truth.h"
#include "tests/support/haptel_files.h"

#include <array>

using namespace haptel;
using namespace haptel::test;

namespace {

constexpr const char* warnings = " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror ";

struct Compiler {
    const char *name, *command; // %d: the folder of the text
};
constexpr Compiler c_compilers[] = {{"gcc", "gcc -std=c99 -O2"}, {"clang", "clang -std=c99 -O2"}};
constexpr Compiler cpp_compilers[] = {{"g++", "g++ -std=c++17 -x c++"}, {"clang++", "clang++ -std=c++17 -x c++"}};

bool is_here(const Compiler& compiler)
{
    return std::system(("command -v " + std::string(compiler.name) + " >/dev/null").c_str()) == 0;
}

// How many of so many samples of each texture differ from the interpreter's in a bit.
size_t different_samples(const lang::Program& program, const ForeignTextures& library, int rounds)
{
    ir::Interpreter<double> interpreter(program.module);
    Stimuli stimuli(11);
    size_t different = 0;
    for (const ir::Texture& texture : program.module.textures) {
        const haptel_texture* const made = library.texture(texture.name);
        REQUIRE(made);
        REQUIRE(made->block_size == texture.block_size);
        for (int round = 0; round < rounds; ++round) {
            const std::vector<double> block = stimuli.block(*made);
            const haptel_point point = stimuli.point();
            for (const bool with_gradient : {false, true}) {
                haptel_sample sample = blank_sample;
                (with_gradient ? made->height_gradient : made->height)(&point, block.data(), &sample);
                different += !same_samples(sample, interpreted(interpreter, texture, point, block, with_gradient));
            }
        }
    }
    return different;
}

std::string library_command(const Compiler& compiler, const std::string& more = "")
{
    return compiler.command + std::string(warnings) + more + " -shared -fPIC '%d/textures.c' -o '%o' -Wl,-z,defs -lm";
}

// As expected() numbers them.
std::array<double, 18> numbers_of(const haptel_texture& texture, const haptel_point& point,
                                  const std::vector<double>& block)
{
    haptel_sample sample = blank_sample, alone = blank_sample;
    texture.height_gradient(&point, block.data(), &sample);
    texture.height(&point, block.data(), &alone);
    std::array<double, 18> all = {sample.height_m,
                                  sample.gradient[0],
                                  sample.gradient[1],
                                  sample.gradient[2],
                                  static_cast<double>(sample.faults),
                                  alone.height_m,
                                  static_cast<double>(alone.faults)};
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t) {
        for (size_t i = 0; i < output.components; ++i)
            all[output_places[&output - output_table] + i] = components_of(sample, output)[i];
    });
    return all;
}

// Of every kind of parameter, and of names that C has taken.
constexpr const char* odd_texture = R"(
/// Ends */ nothing, "quotes" nothing \ at all.
texture odd(float register = 1mm in 0mm .. 2mm, int class = 3 in 1 .. 5, uint u = 4000000000u, bool on = true,
            vec2 size = vec2(1mm, 2mm), int kind = flat in {flat, round, torn})
{
    float h = 0.0;
    for (int i = 0; i < class; i++) h += sinturn(p.x / size.x + float(i)) / float(i + 1);
    if (on && kind == 1) h = abs(h);
    return register * h * float(u % 7) / 7.0 + 1um * length(vec4(p.xyz / size.y, 1.0));
}
)";

} // namespace

TEST_CASE("C text has the bits of the interpreter, whatever compiles it, and no warning")
{
    size_t compiled = 0;
    const std::vector<std::filesystem::path> files = all_texture_files();
    const size_t without_materials = texture_files().size();
    for (const Compiler& compiler : c_compilers) {
        if (!is_here(compiler)) continue;
        for (size_t i = 0; i < files.size(); ++i) {
            // The materials, which call the library's functions alone, by one of them each.
            if (i >= without_materials && is_here(c_compilers[i % 2]) && &compiler != &c_compilers[i % 2]) continue;
            const std::filesystem::path& file = files[i];
            CAPTURE(compiler.name, file);
            const auto program = program_of(file, text_of(file));
            ForeignTextures library;
            library.write("textures.c", emit_c::source("textures", textures_of(*program), false));
            library.open(library_command(compiler));
            CHECK(different_samples(*program, library, 40) == 0);
            ++compiled;
        }
    }
    CHECK(compiled > 0);
}

TEST_CASE("every operation in C has the bits of the interpreter, at any operand")
{
    constexpr const char* terms[] = {"sin(p.x)",
                                     "cos(p.x)",
                                     "tan(p.x)",
                                     "asin(p.x)",
                                     "acos(p.x)",
                                     "atan(p.x)",
                                     "atan(p.x, p.y)",
                                     "atanpi(p.x, p.y)",
                                     "sinh(p.x)",
                                     "cosh(p.x)",
                                     "tanh(p.x)",
                                     "asinh(p.x)",
                                     "acosh(p.x)",
                                     "atanh(p.x)",
                                     "exp(p.x)",
                                     "exp2(p.x)",
                                     "log(p.x)",
                                     "log2(p.x)",
                                     "pow(p.x, p.y)",
                                     "sinturn(p.x)",
                                     "costurn(p.x)",
                                     "sqrt(p.x)",
                                     "length(p.xy)",
                                     "length(p)",
                                     "length(vec4(p, p.x))",
                                     "mod(p.x, p.y)",
                                     "fract(p.x)",
                                     "min(p.x, p.y)",
                                     "max(p.x, p.y)",
                                     "abs(p.x)",
                                     "sign(p.x)",
                                     "floor(p.x)",
                                     "ceil(p.x)",
                                     "trunc(p.x)",
                                     "round(p.x)",
                                     "p.x < p.y ? p.z : 2.0 * p.z",
                                     "float(int(p.x))",
                                     "float(uint(p.x))",
                                     "float(a + b)",
                                     "float(a - b)",
                                     "float(a * b)",
                                     "float(a / b)",
                                     "float(a % b)",
                                     "float(a & b)",
                                     "float(a | b)",
                                     "float(a ^ b)",
                                     "float(a << b)",
                                     "float(a >> b)",
                                     "float(min(a, b))",
                                     "float(max(a, b))",
                                     "float(c / d)",
                                     "float(c % d)",
                                     "float(c >> d)",
                                     "float(min(c, d))",
                                     "float(max(c, d))",
                                     "float(int(c))",
                                     "a < b ? 1.0 : 0.0",
                                     "c < d ? 1.0 : 0.0",
                                     "a == b || c <= d ? 1.0 : 0.0",
                                     "a != b && !(a <= b) ? 1.0 : 0.0",
                                     "(a < b) != (c < d) ? 1.0 : 0.0"};
    std::string text;
    for (size_t i = 0; i < std::size(terms); ++i)
        text += "texture t" + std::to_string(i) + "(int a = 1, int b = 1, uint c = 1u, uint d = 1u) { return 1.0 * (" +
                terms[i] + "); }\n";
    const auto program = program_of("t.haptel", text);
    ForeignTextures library;
    library.write("textures.c", emit_c::source("t", textures_of(*program), false));
    library.open(library_command(c_compilers[0]));
    ir::Interpreter<double> interpreter(program->module);
    std::mt19937_64 random(3);
    constexpr double edges[] = {0.0, -0.0, 1, -1, 0.5, -0.5, 2, 1e22, 4294967296.0, HUGE_VAL, -HUGE_VAL, NAN};
    constexpr uint32_t words[] = {0, 1, ~0u, 0x80000000u, 0x7fffffffu, 31, 33};
    for (const ir::Texture& texture : program->module.textures) {
        size_t different = 0;
        for (int i = 0; i < 3000; ++i) {
            haptel_point point{};
            for (double& number : point.p)
                number = i % 3 == 0   ? std::bit_cast<double>(random())
                         : i % 3 == 1 ? std::uniform_real_distribution(-4.0, 4.0)(random)
                                      : edges[random() % std::size(edges)];
            std::vector<double> block(texture.block_size / sizeof(double));
            for (const ir::Parameter& parameter : texture.parameters) {
                const uint32_t word =
                    random() % 2 ? static_cast<uint32_t>(random()) : words[random() % std::size(words)];
                std::memcpy(reinterpret_cast<char*>(block.data()) + parameter.offset, &word, sizeof word);
            }
            haptel_sample sample = blank_sample;
            library.texture(texture.name)->height_gradient(&point, block.data(), &sample);
            different += !same_samples(sample, interpreted(interpreter, texture, point, block, true));
        }
        CAPTURE(terms[&texture - program->module.textures.data()]);
        CHECK(different == 0);
    }
}

TEST_CASE("C text is C++, too, and so is the header by itself")
{
    const auto program = program_of("odd.haptel", odd_texture);
    const std::vector<emit_c::LibraryTexture> textures = textures_of(*program);
    for (const bool is_single : {false, true})
        for (const Compiler& compiler : cpp_compilers) {
            if (!is_here(compiler)) continue;
            CAPTURE(compiler.name, is_single);
            ForeignTextures library;
            library.write("textures.c", emit_c::source("odd", textures, is_single));
            library.open(library_command(compiler));
            if (!is_single) CHECK(different_samples(*program, library, 300) == 0);
        }
    for (const char* compiler : {"gcc -std=c99", "g++ -std=c++98 -Wno-long-long -x c++"}) {
        ForeignTextures library;
        library.write("textures.c", emit_c::source("odd", textures, false));
        library.write("odd.h", emit_c::header("odd", textures));
        library.write("other.h", emit_c::header("an other", {}));
        library.write("main.c", "#include \"odd.h\"\n#include \"other.h\"\n#include \"odd.h\"\n"
                                "const haptel_texture* first(void) { return &haptel_texture_odd; }\n"
                                "double depth(void) { return haptel_defaults_odd.register_; }\n");
        library.open("cd '%d' && gcc -std=c99 -fPIC -c textures.c && " + std::string(compiler) + warnings +
                     "-shared -fPIC main.c -x none textures.o -o '%o' -Wl,-z,defs -lm");
    }
}

TEST_CASE("a texture's parameters are described in C as they are in Haptel")
{
    const auto program = program_of("odd.haptel", odd_texture);
    ForeignTextures library;
    library.write("textures.c", emit_c::source("odd", textures_of(*program), false));
    library.open(library_command(c_compilers[0]));
    const haptel_texture& made = *library.texture("odd");
    const ir::Texture& texture = program->module.textures[0];
    CHECK(made.abi == HAPTEL_ABI_VERSION);
    CHECK(made.size == sizeof made);
    CHECK(std::string(made.name) == "odd");
    CHECK(made.reads == texture.reads);
    CHECK(made.facts.height_max_m == HUGE_VAL);
    CHECK(made.facts.operations_max == 42);
    REQUIRE(made.parameter_count == texture.parameters.size());
    for (uint32_t i = 0; i < made.parameter_count; ++i) {
        const haptel_parameter& row = made.parameters[i];
        const ir::Parameter& parameter = texture.parameters[i];
        CHECK(row.name == parameter.name);
        CHECK(row.unit == parameter.unit);
        CHECK(row.doc == parameter.doc);
        CHECK(row.type == static_cast<uint32_t>(parameter.type));
        CHECK(row.offset == parameter.offset);
        CHECK(row.value == parameter.value);
        CHECK(row.minimum == parameter.minimum);
        CHECK(row.maximum == parameter.maximum);
        // The block of defaults is what the rows say.
        const char* const place = static_cast<const char*>(library.defaults("odd")) + row.offset;
        double real = 0;
        uint32_t word = 0;
        std::memcpy(&real, place, sizeof real);
        std::memcpy(&word, place, sizeof word);
        const double held = row.type == HAPTEL_FLOAT  ? real
                            : row.type == HAPTEL_UINT ? static_cast<double>(word)
                                                      : static_cast<int32_t>(word);
        CHECK(held == row.value);
    }
    CHECK(std::string(made.choices[made.parameter_count - 1][2]) == "torn");
    CHECK(made.choices[0] == nullptr);
}

TEST_CASE("in float C text gives what rounding each operation to f32 can lead to")
{
    size_t samples = 0, undecided = 0, numbers = 0, wrong = 0;
    const std::vector<std::filesystem::path> files = all_texture_files();
    for (size_t i = 0; i < files.size(); ++i) {
        const Compiler& compiler = c_compilers[is_here(c_compilers[i % 2]) ? i % 2 : 0];
        CAPTURE(files[i], compiler.name);
        const auto program = program_of(files[i], text_of(files[i]));
        ForeignTextures library;
        library.write("textures.c", emit_c::source("textures", textures_of(*program), true));
        library.open(library_command(compiler, "-Wdouble-promotion"));
        ir::Interpreter<Ball> interpreter(program->module);
        FloatStimuli stimuli(7);
        for (const ir::Texture& texture : program->module.textures)
            for (int round = 0; round < 8; ++round) {
                const std::vector<double> block = stimuli.block(texture, round % 2 == 0);
                const haptel_point point = stimuli.point();
                const std::vector<Expected> all = expected(interpreter, texture, point, block);
                ++samples;
                undecided += all.empty();
                const std::array<double, 18> made = numbers_of(*library.texture(texture.name), point, block);
                for (const Expected& number : all) {
                    ++numbers;
                    if (number.ball.may_be(made[number.place])) continue;
                    CAPTURE(texture.name, number.what, made[number.place]);
                    CHECK(static_cast<double>(number.ball) == made[number.place]);
                    ++wrong;
                }
            }
    }
    WARN("of " << samples << " samples rounding decides " << undecided << "; " << numbers << " numbers compared");
    CHECK(wrong == 0);
    CHECK(undecided < samples / 4);
}

// Noise in float near the origin is off by some 1e-6 of its range: docs/performance.md.
TEST_CASE("in float a texture of noise is near the one in double")
{
    const auto program = program_of(
        "n.haptel", "texture n() { return 1mm * fbm(p / 1mm, 4) + 0.1mm * sin(p.x / 1mm) * exp(p.y / 1m); }");
    ForeignTextures single, wide;
    single.write("textures.c", emit_c::source("n", textures_of(*program), true));
    wide.write("textures.c", emit_c::source("n", textures_of(*program), false));
    single.open(library_command(c_compilers[0], "-Wdouble-promotion"));
    wide.open(library_command(c_compilers[0]));
    std::mt19937 random(1);
    const std::vector<double> block(7);
    double most = 0;
    for (int i = 0; i < 5000; ++i) {
        haptel_point point{};
        for (double& number : point.p) number = std::uniform_real_distribution(-5e-3, 5e-3)(random);
        haptel_sample a = blank_sample, b = blank_sample;
        single.texture("n")->height_gradient(&point, block.data(), &a);
        wide.texture("n")->height_gradient(&point, block.data(), &b);
        most = std::max(most, std::fabs(a.height_m - b.height_m));
        for (size_t k = 0; k < 3; ++k) CHECK(std::fabs(a.gradient[k] - b.gradient[k]) < 1e-4);
    }
    CHECK(most < 1e-8);
    CHECK(most > 1e-13); // it is not double in disguise
}

TEST_CASE("equal textures give equal text, which asks for no heap and tells its cost")
{
    const auto program = program_of("odd.haptel", odd_texture);
    const std::string text = emit_c::source("odd", textures_of(*program), false);
    CHECK(text == emit_c::source("odd", textures_of(*program), false));
    for (const char* word : {"malloc(", "alloca(", "free("}) CHECK(text.find(word) == text.npos);
    CHECK(text.find("operations for the height") != text.npos);
    CHECK(text.find("Constant tables: 0 bytes") != text.npos);
}

TEST_CASE("a microcontroller's compiler takes the text")
{
    const std::string compiler =
        "arm-none-eabi-gcc -std=c99 -Os -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 ";
    if (std::system(("echo '#include <math.h>' | " + compiler + "-E -x c - >/dev/null 2>&1").c_str()) != 0) {
        WARN("not tried: gcc-arm-none-eabi and libnewlib-arm-none-eabi are not here");
        return;
    }
    const auto size_of = [&](const std::string& name, const std::string& text, bool is_single) {
        CAPTURE(name, is_single);
        const Folder folder;
        folder.write("n.c", emit_c::source("n", textures_of(*program_of(name, text)), is_single));
        REQUIRE(std::system(("cd '" + folder.path.string() + "' && " + compiler + warnings +
                             " -c n.c && arm-none-eabi-size n.o >size && arm-none-eabi-nm -u n.o >called")
                                .c_str()) == 0);
        const std::string called = text_of(folder.path / "called");
        for (const char* heap : {"malloc", "free", "memcpy"}) CHECK(called.find(heap) == called.npos);
        return text_of(folder.path / "size");
    };
    const std::vector<std::filesystem::path> files = all_texture_files();
    for (size_t i = 0; i < files.size(); i += 10) size_of(files[i], text_of(files[i]), i % 20 == 0);
    for (const bool is_single : {true, false})
        WARN((is_single ? "in float, bytes:\n" : "in double, bytes:\n")
             << size_of("n.haptel", "texture n() { return 1mm * fbm(p / 1mm, 4); }", is_single));
}
