// Many points at once: each sample of a batch is that of the entry for one point, bit for bit.
#include "jit/codegen/iteration_lanes.h"
#include "tests/jit/codegen/batch.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/haptel_files.h"
#include "tests/support/ir_parse.h"

#include <filesystem>
#include <random>

using namespace haptel;
using test::Batch, test::same;

namespace {

std::vector<haptel_point> random_points(size_t count, std::mt19937_64& random)
{
    std::uniform_real_distribution<double> unit(-1, 1), exponent(-6, 3);
    std::vector<haptel_point> points(count);
    for (haptel_point& point : points) {
        double held[Batch::reals];
        for (double& real : held) real = unit(random) * (random() % 8 == 0 ? std::pow(10, exponent(random)) : 0.05);
        std::memcpy(&point, held, sizeof point);
    }
    points[0] = {}; // whole zeros
    return points;
}

} // namespace

TEST_CASE("batches of every texture of the library and of the examples have the bits of single points", "[code]")
{
    const jit::Precision precision = GENERATE(jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32);
    std::mt19937_64 random(5);
    size_t compared = 0;
    const std::vector<std::filesystem::path> files = test::texture_files();
    for (const std::filesystem::path& file : files) {
        jit::TextureOptions options;
        options.entries = jit::Entries::both_and_batches;
        options.precision = precision;
        options.iterations_in_lanes = false;
        const jit::CompiledTextures compiled = jit::compile_texture_file(file, options);
        INFO(compiled.rendered());
        REQUIRE(compiled.program);
        for (const haptel_texture& texture : compiled.program->textures()) {
            const TextureResult result =
                jit::make_binding(compiled.program, texture.name, test::request_over(0.05), jit::For::figures);
            INFO(file << " " << texture.name << " " << result.diagnostics);
            REQUIRE(result.binding);
            const std::vector<haptel_point> points = random_points(203, random);
            Batch batch(points), heights(points);
            texture.height_gradient_batch(&batch.points, batch.count, result.binding->block, &batch.samples);
            heights.samples = {};
            heights.samples.height_m = heights.outputs[0].data();
            texture.height_batch(&heights.points, heights.count, result.binding->block, &heights.samples);
            size_t different = 0;
            for (size_t i = 0; i < points.size(); ++i) {
                haptel_sample one = blank_sample;
                texture.height_gradient(&points[i], result.binding->block, &one);
                different += !same(one, batch.sample(i)) || !test::same(one.height_m, heights.outputs[0][i]);
            }
            CHECK(different == 0);
            ++compared;
        }
    }
    CHECK(compared > 2 * files.size());
}

TEST_CASE("reals to whole numbers: lanes saturate as one point does, in every precision", "[code]")
{
    std::vector<haptel_point> points;
    for (double x : {0.0, 0.9, -0.9, 1.0, -1.5, 2147483520.0, 2147483646.0, 2147483647.0, 2147483648.0, -2147483648.0,
                     -2147483649.0, 4294967040.0, 4294967295.0, 4294967296.0, 1e30, -1e30, double(INFINITY),
                     -double(INFINITY), double(NAN)})
        points.push_back({{x, 0, 0}, {}, {}, 0, {}, {}, {}, 0, 0, {}, {}, 0});
    for (const auto precision : {jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32})
        for (const char* expression : {"float(int(p.x / 1m))", "float(uint(p.x / 1m))"}) {
            jit::TextureOptions options;
            options.entries = jit::Entries::both_and_batches;
            options.precision = precision;
            const jit::CompiledTextures made =
                jit::compile_texture("texture t() { return 1m * " + std::string(expression) + "; }", options);
            REQUIRE(made.program);
            const haptel_texture& texture = made.program->textures()[0];
            const haptel_block_head block{};
            Batch batch(points);
            texture.height_gradient_batch(&batch.points, batch.count, &block, &batch.samples);
            for (size_t i = 0; i < points.size(); ++i) {
                INFO(expression << " of " << points[i].p[0] << " in precision " << int(precision));
                haptel_sample one = blank_sample;
                texture.height_gradient(&points[i], &block, &one);
                CHECK(same(one, batch.sample(i)));
                const bool is_signed = expression[6] == 'i';
                const double least = is_signed ? -2147483648.0 : 0, most = is_signed ? 2147483647.0 : 4294967295.0;
                const double x = points[i].p[0];
                const double truth = std::isnan(x) ? 0 : std::trunc(std::min(std::max(x, least), most));
                const double rounded = precision == jit::Precision::f64 ? truth : double(float(truth));
                CHECK(std::fabs(one.height_m - truth) <=
                      std::fabs(rounded - truth) + (precision == jit::Precision::f32 ? 256 : 0));
            }
        }
}

// What is behind the greatest real number of 24 bits that fits tells saturation from rounding: as a whole number, and
// only then as a real one, it is small and exact in every precision.
TEST_CASE("reals to whole numbers: what is too large becomes the greatest there is, to its last bit", "[code]")
{
    std::vector<haptel_point> points;
    for (double x : {-1e30, -2147483648.0, -2147483520.0, 0.0, 2147483520.0, 2147483648.0, 4294967040.0, 4294967296.0,
                     1e30, double(INFINITY)})
        points.push_back({{x, 0, 0}, {}, {}, 0, {}, {}, {}, 0, 0, {}, {}, 0});
    for (const auto precision : {jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32}) {
        jit::TextureOptions options;
        options.entries = jit::Entries::both_and_batches;
        options.precision = precision;
        const jit::CompiledTextures made = jit::compile_texture(
            "texture of_int() { int i = int(p.x / 1m); return 1m * float(i > 0 ? i - 2147483520 : i + 2147483520); }\n"
            "texture of_uint() { return 1m * float(uint(p.x / 1m) & 4095u); }",
            options);
        INFO(made.rendered());
        REQUIRE(made.program);
        for (const bool is_signed : {true, false}) {
            const haptel_texture& texture = made.program->textures()[is_signed ? 0 : 1];
            const haptel_block_head block{};
            Batch batch(points);
            texture.height_gradient_batch(&batch.points, batch.count, &block, &batch.samples);
            for (size_t i = 0; i < points.size(); ++i) {
                const double x = points[i].p[0];
                const auto least = is_signed ? int64_t{INT32_MIN} : 0,
                           most = is_signed ? INT32_MAX : int64_t{UINT32_MAX};
                const int64_t whole = x >= double(most) ? most : x <= double(least) ? least : int64_t(x);
                const int64_t shown =
                    is_signed ? (whole > 0 ? whole - 2147483520 : whole + 2147483520) : (whole & 4095);
                haptel_sample one = blank_sample;
                texture.height_gradient(&points[i], &block, &one);
                INFO(texture.name << " of " << x << " in precision " << int(precision));
                CHECK(one.height_m == double(shown));
                CHECK(batch.sample(i).height_m == double(shown));
            }
        }
    }
}

TEST_CASE("mixed precision keeps its place within a cell, however far away; f32 does not", "[code]")
{
    const std::string source = R"(
        texture fractal() { return 1mm * fbm(p / 1mm, 8); }
        texture hills() { return 1mm * perlin(p / 1mm); }
        texture paper() { return 1mm * noise(p / 1mm); }
        texture warped() { return 1mm * perlin(p / 1mm + 0.5 * vec3(perlin(p / 3mm))); }
        texture waves() { return 1mm * fourier(p.xy / 1mm, 7); })";
    jit::TextureOptions options;
    const jit::CompiledTextures exact = jit::compile_texture(source, options);
    options.precision = jit::Precision::mixed;
    const jit::CompiledTextures mixed = jit::compile_texture(source, options);
    options.precision = jit::Precision::f32;
    const jit::CompiledTextures single = jit::compile_texture(source, options);
    REQUIRE((exact.program && mixed.program && single.program));
    std::mt19937_64 random(6);
    for (size_t i = 0; i < exact.program->textures().size(); ++i) {
        const haptel_texture& texture = exact.program->textures()[i];
        for (const double cells : {1.0, 1e3, 1e7}) {
            std::uniform_real_distribution<double> place(-cells * 1e-3, cells * 1e-3);
            double largest = 0, off[2] = {};
            const haptel_block_head block{};
            for (int k = 0; k < 1000; ++k) {
                const haptel_point point{
                    {place(random), place(random), place(random)}, {}, {}, 0, {}, {}, {}, 0, 0, {}, {}, 0};
                haptel_sample truth{}, found{};
                texture.height_gradient(&point, &block, &truth);
                for (const auto& [program, worst] : {std::pair{&mixed, &off[0]}, std::pair{&single, &off[1]}}) {
                    program->program->textures()[i].height_gradient(&point, &block, &found);
                    for (size_t axis = 0; axis < 3; ++axis) {
                        largest = std::max(largest, std::fabs(truth.gradient[axis]));
                        *worst = std::max(*worst, std::fabs(found.gradient[axis] - truth.gradient[axis]));
                    }
                }
            }
            INFO(texture.name << " at " << cells << " cells: mixed " << off[0] / largest << ", f32 "
                              << off[1] / largest);
            CHECK(off[0] < (std::string(texture.name) == "fractal" ? 2e-6 : 4e-6) * largest);
            CHECK((cells < 1e7 || off[1] > 1e-2 * largest));
        }
    }
}

TEST_CASE("mixed precision keeps its place in every texture of the library and of the examples", "[code]")
{
    for (const std::filesystem::path& file : test::texture_files()) {
        jit::TextureOptions options;
        const jit::CompiledTextures exact = jit::compile_texture_file(file, options);
        options.precision = jit::Precision::mixed;
        const jit::CompiledTextures mixed = jit::compile_texture_file(file, options);
        REQUIRE((exact.program && mixed.program));
        for (size_t i = 0; i < exact.program->textures().size(); ++i) {
            const haptel_texture& texture = exact.program->textures()[i];
            INFO(file << " " << texture.name);
            const TextureResult bound =
                jit::make_binding(exact.program, texture.name, test::request_over(0.05), jit::For::figures);
            REQUIRE(bound.binding);
            std::mt19937_64 random(7);
            std::uniform_real_distribution<double> place(-1e3, 1e3); // wavelengths are some millimetres
            double largest = 0, off = 0, highest = 0, height_off = 0;
            for (int k = 0; k < 500; ++k) {
                const haptel_point point{
                    {place(random), place(random), place(random)}, {0, 0, 1}, {}, 0, {}, {}, {}, 0, 0, {}, {}, 0};
                haptel_sample truth{}, found{};
                texture.height_gradient(&point, bound.binding->block, &truth);
                mixed.program->textures()[i].height_gradient(&point, bound.binding->block, &found);
                highest = std::max(highest, std::fabs(truth.height_m));
                height_off = std::max(height_off, std::fabs(found.height_m - truth.height_m));
                for (size_t axis = 0; axis < 3; ++axis) {
                    largest = std::max(largest, std::fabs(truth.gradient[axis]));
                    off = std::max(off, std::fabs(found.gradient[axis] - truth.gradient[axis]));
                }
            }
            CHECK(height_off <= 2e-5 * highest);
            CHECK(off <= 2e-5 * largest);
        }
    }
}

TEST_CASE("what the block holds is one for all lanes, what the point holds is not")
{
    const ir::ParsedModule parsed = ir::parse(R"(function "f" () {
  %0 = input p_x
  %1 = input extent_x
  %2 = r_to_i %1
  %3 = i32 9
  %4 = imin %2, %3
  %5, %6 = for %4 max 9 (%7, %8, %9) from (%1, %1) {
    %10 = add %8, %0
    %11 = mul %9, %9
    yield %10, %11
  }
  %12 = lt %1, %0
  %13, %14 = if %12 {
    yield %1, %1
  } else {
    yield %6, %1
  }
  %15 = lt %1, %6
  %16, %17 = if %15 {
    yield %0, %1
  } else {
    yield %1, %6
  }
  return %5, %16
})");
    INFO(parsed.error);
    REQUIRE(parsed.module);
    const ir::Function& function = parsed.module->functions[0];
    const std::vector<bool> varies = jit::varying_values(function, {});
    std::string results; // of the instructions in their order
    for (const ir::Instruction& made : function.body.instructions) {
        for (ir::Value result : made.results) results += varies[result.index] ? 'v' : 'u';
        results += ' ';
    }
    CHECK(results == "v u u u u vu v vv u vu ");
}
