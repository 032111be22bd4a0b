// Pictures as textures: from the file to the gradient, against arithmetic of this test alone.
#include "jit/check/check_gradient.h"
#include "jit/check/oracle.h"
#include "jit/picture/image_file.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/folder.h"

#include <cmath>
#include <numbers>

using namespace haptel;
using test::compiled;
using test::contains;
using test::height_at;
using test::request_over;
using test::sample_at;

namespace {

constexpr int width = 24, height = 16;

// The lowest row first.
double texel(int column, int row)
{
    const double gray = 127.5 + 60 * std::sin(0.9 * column) + 50 * std::cos(0.7 * row + 0.2 * column);
    return std::round(gray) / 255;
}

// Binary PGM of 8 bits; its first row is the top one.
std::string pgm(int columns, int rows, double (*gray)(int, int))
{
    std::string text = "P5\n" + std::to_string(columns) + " " + std::to_string(rows) + "\n255\n";
    for (int row = rows - 1; row >= 0; --row)
        for (int column = 0; column < columns; ++column)
            text += static_cast<char>(static_cast<unsigned char>(std::lround(255 * gray(column, row))));
    return text;
}

const char* const source = R"(
texture pressed(image picture, float depth = 1mm in 0mm .. 1mm) { return depth * sample(picture, p.xy / 1m); }
texture tiled(image picture) { return 1mm * sample_tiled(picture, p.xy / 1m); }
texture mirrored(image picture) { return 1mm * sample_mirrored(picture, p.xy / 1m); }
texture central(image picture, float epsilon = 0.03 in 0.001 .. 0.1) { return 1m * sample_central(picture, p.xy / 1m, epsilon); }
texture single(image picture, int column = 0 in -100 .. 100, int row = 0 in -100 .. 100) { return 1m * texel(picture, column, row); }
texture wide(image picture) { return 1mm * float(image_width(picture)) + 1um * float(image_height(picture)); }
float through(vec2 q, image b, float k(image, vec2), image a) { return k(a, q) + grad(sample)(b, q).x; }
texture passed(image first, image second) { return 1um * through(p.xy / 1m, first, sample_tiled, second); }
)";

struct Pictures {
    test::Folder folder;
    std::shared_ptr<const jit::CompiledProgram> program = compiled(source);

    Pictures() { folder.write("a.pgm", pgm(width, height, texel)); }

    TextureResult bind(const char* texture, std::vector<std::pair<std::string, std::string>> values) const
    {
        TextureRequest request = request_over(2);
        request.folder = folder.path.string();
        request.parameters = std::move(values);
        return jit::make_binding(program, texture, request, jit::For::figures);
    }
    TextureBinding bound(const char* texture, std::vector<std::pair<std::string, std::string>> values) const
    {
        TextureResult result = bind(texture, std::move(values));
        INFO(result.diagnostics);
        REQUIRE(result.binding);
        CHECK(!contains(result.diagnostics, "warning:")); // beside the note that the picture is one of 8 bits
        return *result.binding;
    }
};

} // namespace

TEST_CASE("image: heights are those of the file at its texels, v upwards, clamped outside or repeated")
{
    const Pictures pictures;
    const TextureBinding pressed = pictures.bound("pressed", {{"picture", "a.pgm"}}),
                         tiled = pictures.bound("tiled", {{"picture", "a.pgm"}});
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const double u = (column + 0.5) / width, v = (row + 0.5) / height;
            CHECK(std::fabs(height_at(pressed, u, v) - 1e-3 * texel(column, row)) < 1e-16);
            CHECK(std::fabs(height_at(tiled, u + 3, v - 2) - 1e-3 * texel(column, row)) < 1e-14);
        }
    CHECK(height_at(pressed, 1e9, 0.5) == height_at(pressed, 2, 0.5));
    CHECK(std::fabs(height_at(pressed, 100, -100) - 1e-3 * texel(width - 1, 0)) < 1e-17);
    for (int column : {-7, 0, 5, width + 20})
        CHECK(std::fabs(height_at(pictures.bound("single", {{"picture", "a.pgm"}, {"column", std::to_string(column)}}),
                                  0, 0) -
                        texel(std::clamp(column, 0, width - 1), 0)) < 1e-13);
    CHECK(height_at(pictures.bound("wide", {{"picture", "a.pgm"}}), 0, 0) == 1e-3 * width + 1e-6 * height);
}

TEST_CASE("image: code, interpreter and oracle agree, and the gradient is that of the height", "[code]")
{
    const Pictures pictures;
    for (const char* name : {"pressed", "tiled", "mirrored", "passed"}) {
        CAPTURE(name);
        const bool of_two = std::string(name) == "passed";
        const TextureBinding binding = of_two ? pictures.bound(name, {{"first", "a.pgm"}, {"second", "a.pgm"}})
                                              : pictures.bound(name, {{"picture", "a.pgm"}});
        const jit::Oracle oracle(pictures.program, binding);
        for (int i = 0; i < 200; ++i) {
            haptel_point point{};
            point.p[0] = std::fmod(0.618 * i, 1.6) - 0.3;
            point.p[1] = std::fmod(0.755 * i, 1.6) - 0.3;
            haptel_sample code{};
            binding.texture->height_gradient(&point, binding.block, &code);
            const haptel_sample slow = jit::interpret_sample(*pictures.program, binding, point);
            CHECK(test::same(code.height_m, slow.height_m));
            for (int axis : {0, 1, 2}) CHECK(test::same(code.gradient[axis], slow.gradient[axis]));
        }
        const jit::CheckBox box{{-0.5, -0.5, -0.5}, {0.9, 0.9, 0.9}};
        const jit::GradientCheck check = jit::check_gradient(pictures.program, binding, box, 500, 1);
        CHECK(check.failures == std::vector<std::string>{});
    }
}

TEST_CASE("image: bounds of a binding hold its picture and are not far off")
{
    const Pictures pictures;
    const TextureBinding binding = pictures.bound("pressed", {{"picture", "a.pgm"}});
    double low = 1, high = -1, slope = 0;
    for (int i = 0; i < 400; ++i)
        for (int j = 0; j < 400; ++j) {
            const haptel_sample sample = sample_at(binding, {-1 + i / 200.0, -1 + j / 200.0, 0});
            low = std::min(low, sample.height_m);
            high = std::max(high, sample.height_m);
            slope = std::max(slope, std::hypot(sample.gradient[0], sample.gradient[1]));
        }
    CHECK((binding.facts.height_min_m <= low && binding.facts.height_max_m >= high));
    CHECK(binding.facts.slope_max >= slope);
    CHECK(binding.facts.height_max_m - binding.facts.height_min_m < 1.05 * (high - low));
    CHECK(binding.facts.slope_max < 1.5 * slope);
    CHECK(binding.facts.continuity == HAPTEL_CONTINUITY_C1);
}

TEST_CASE("image: sample_central has the spline's height and the gradient of equations 4 to 6")
{
    const Pictures pictures;
    const double epsilon = 0.025;
    const TextureBinding central = pictures.bound("central", {{"picture", "a.pgm"}, {"epsilon", "0.025"}}),
                         pressed = pictures.bound("pressed", {{"picture", "a.pgm"}});
    double differs = 0;
    for (int i = 0; i < 300; ++i) {
        const double u = std::fmod(0.618 * i, 1.2) - 0.1, v = std::fmod(0.755 * i, 1.2) - 0.1;
        const haptel_sample found = sample_at(central, {u, v, 0}), exact = sample_at(pressed, {u, v, 0});
        CHECK(std::fabs(found.height_m - 1e3 * exact.height_m) < 1e-13);
        const double by_u =
            1e3 * (height_at(pressed, u + epsilon, v) - height_at(pressed, u - epsilon, v)) / (2 * epsilon);
        const double by_v =
            1e3 * (height_at(pressed, u, v + epsilon) - height_at(pressed, u, v - epsilon)) / (2 * epsilon);
        CHECK(std::fabs(found.gradient[0] - by_u) < 1e-11);
        CHECK(std::fabs(found.gradient[1] - by_v) < 1e-11);
        differs = std::max(differs, std::fabs(found.gradient[0] - 1e3 * exact.gradient[0]));
    }
    CHECK(differs > 0.1);                                 // it is another gradient than the height's
    CHECK(std::isinf(central.facts.curvature_max_per_m)); // of which nothing is claimed
    CHECK(central.facts.height_max_m < 1.5);              // while the height is bounded as ever
}

TEST_CASE("image: mirrored copies go on where the last one ends, the other way round, and are level there")
{
    const Pictures pictures;
    const TextureBinding mirrored = pictures.bound("mirrored", {{"picture", "a.pgm"}}),
                         pressed = pictures.bound("pressed", {{"picture", "a.pgm"}});
    for (int i = 0; i < 300; ++i) {
        const double u = std::fmod(0.618 * i, 1.0), v = std::fmod(0.7553 * i, 1.0);
        const haptel_sample once = sample_at(mirrored, {u, v, 0}), turned = sample_at(mirrored, {-u, 2 - v, 0}),
                            again = sample_at(mirrored, {u + 2, v - 4, 0});
        for (const haptel_sample* copy : {&turned, &again}) {
            const int sign = copy == &turned ? -1 : 1;
            CHECK(std::fabs(copy->height_m - once.height_m) < 1e-16);
            CHECK(std::fabs(copy->gradient[0] - sign * once.gradient[0]) < 1e-14);
            CHECK(std::fabs(copy->gradient[1] - sign * once.gradient[1]) < 1e-14);
        }
        // What is outside counts 2 - sqrt(3) times less with each texel from the edge.
        const double texels = std::min((0.5 - std::fabs(u - 0.5)) * width, (0.5 - std::fabs(v - 0.5)) * height);
        CHECK(std::fabs(once.height_m - height_at(pressed, u, v)) < 1e-3 * std::pow(0.27, texels));
        for (const double seam : {-1.0, 0.0, 1.0, 2.0})
            CHECK(std::fabs(sample_at(mirrored, {seam, v, 0}).gradient[0]) < 1e-14);
    }
    CHECK(mirrored.facts.continuity == HAPTEL_CONTINUITY_C1);
}

TEST_CASE("image: without a picture a texture is flat, and that is said")
{
    const Pictures pictures;
    const TextureResult result = pictures.bind("pressed", {});
    REQUIRE(result.binding);
    CHECK(contains(result.diagnostics, "warning: parameter 'picture' of texture 'pressed' has no picture and is flat"));
    CHECK(height_at(*result.binding, 0.3, 0.4) == 0);
    CHECK((result.binding->facts.height_min_m == 0 && result.binding->facts.height_max_m == 0));
    CHECK(pictures.program->find("pressed")->parameters[0].type == HAPTEL_IMAGE);
}

TEST_CASE("image: each picture that is missing is said")
{
    const TextureResult result = Pictures().bind("passed", {});
    CHECK(contains(result.diagnostics, "parameter 'first' of texture 'passed' has no picture"));
    CHECK(contains(result.diagnostics, "parameter 'second' of texture 'passed' has no picture"));
}

TEST_CASE("image: what a hand may feel of a picture's file is noted")
{
    const Pictures pictures;
    const auto said = [&](const std::string& depth, const std::string& name) {
        const TextureResult result = pictures.bind("pressed", {{"depth", depth}, {"picture", name}});
        INFO(result.diagnostics);
        REQUIRE(result.binding);
        return result.diagnostics;
    };
    // 1 mm over 255 levels is 3.92 um.
    pictures.folder.write("ramp.pgm", pgm(256, 1, [](int column, int) { return column / 255.0; }));
    CHECK(contains(said("1mm", "ramp.pgm"),
                   "note: parameter 'picture' of texture 'pressed': 'ramp.pgm' has 256 levels, "
                   "so heights go in steps of 3.9 um"));
    CHECK(contains(said("0.5mm", "ramp.pgm"), "in steps of 2 um"));
    CHECK(said("0.2mm", "ramp.pgm") == ""); // 0.8 um, below what a finger feels
    pictures.folder.write("mask.pgm", pgm(8, 8, [](int column, int) { return column < 4 ? 0.0 : 1.0; }));
    CHECK(said("1mm", "mask.pgm") == ""); // black and white: there is no level between
    std::string fine = "P5\n4 1\n65535\n";
    for (const char* texel : {"\x10\x00", "\x20\x07", "\x30\x0f", "\x40\x55"}) fine += std::string(texel, 2);
    pictures.folder.write("fine.pgm", fine);
    CHECK(said("1mm", "fine.pgm") == "");
    // Said again of a picture that is not read again.
    CHECK(said("1mm", "ramp.pgm") == said("1mm", "ramp.pgm"));
}

TEST_CASE("image: files that are missing, damaged or no pictures give messages")
{
    const Pictures pictures;
    const auto said = [&](const std::string& name) {
        const TextureResult result = pictures.bind("pressed", {{"picture", name}});
        CHECK(!result.binding);
        return result.diagnostics;
    };
    CHECK(contains(said("b.pgm"), "there is no file 'b.pgm'"));
    CHECK(contains(said("b.pgm"), (pictures.folder.path / "b.pgm").string()));
    CHECK(contains(said("."), "'.' is a folder"));
    pictures.folder.write("text.png", "not a picture");
    CHECK(contains(said("text.png"), "no picture that can be read"));
    pictures.folder.write("cut.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x10\0\0\0\x10\x10\0\0\0\0", 29));
    CHECK(contains(said("cut.png"), "'cut.png'"));
    pictures.folder.write("huge.pgm", "P5\n1000000 1000000\n255\n");
    CHECK(contains(said("huge.pgm"), "'huge.pgm'"));
    CHECK(contains(said(""), "expected the name of a picture's file"));
}

TEST_CASE("image: one file is read once, and again when it changes")
{
    const Pictures pictures;
    const TextureBinding first = pictures.bound("pressed", {{"picture", "a.pgm"}}),
                         second = pictures.bound("tiled", {{"picture", "a.pgm"}});
    CHECK(jit::read_image("a.pgm", pictures.folder.path.string(), {}).image ==
          jit::read_image(pictures.folder.file("a.pgm"), {}, {}).image);
    pictures.folder.replace("a.pgm", pgm(3, 2, [](int, int) { return 1.0; }));
    CHECK(std::fabs(height_at(pictures.bound("pressed", {{"picture", "a.pgm"}}), 0.1, 0.7) - 1e-3) < 1e-15);
    CHECK(std::fabs(height_at(first, 0.5 / width, 0.5 / height) - 1e-3 * texel(0, 0)) <
          1e-15); // keeps what it was made of
}
