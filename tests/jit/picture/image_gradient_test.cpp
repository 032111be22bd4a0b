// Gradients of pictures against those of the height fields that they were sampled from.
#include "tests/jit/codegen/samples.h"
#include "tests/jit/picture/pictures.h"
#include "tests/support/folder.h"
#include "tests/support/tries.h"

#include <cmath>
#include <numbers>

using namespace haptel;
using namespace haptel::test;

namespace {

constexpr double pi = std::numbers::pi;

const char* const gradient_source = R"(
texture bicubic(image picture) { return 1m * sample_tiled(picture, p.xy / 1m); }
texture pressed(image picture, float depth = 1mm in 0mm .. 10mm) { return depth * sample(picture, p.xy / 1m); }
texture central(image picture, float epsilon = 0.03 in 0.001 .. 0.4) { return 1m * sample_central(picture, p.xy / 1m, epsilon); }
)";

// Repeats after 1 in u and v; its waves are long against a texel.
double field(double u, double v)
{
    return 0.3 * std::sin(2 * pi * (u + 2 * v)) + 0.2 * std::cos(2 * pi * (3 * u - v));
}
double field_by_u(double u, double v)
{
    return 2 * pi * (0.3 * std::cos(2 * pi * (u + 2 * v)) - 0.6 * std::sin(2 * pi * (3 * u - v)));
}
double field_by_v(double u, double v)
{
    return 2 * pi * (0.6 * std::cos(2 * pi * (u + 2 * v)) + 0.2 * std::sin(2 * pi * (3 * u - v)));
}

struct FieldPictures {
    Folder folder;
    std::shared_ptr<const jit::CompiledProgram> program = compiled(gradient_source);

    TextureBinding bound(const char* texture, std::vector<std::pair<std::string, std::string>> values) const
    {
        TextureRequest request = request_over(4);
        request.folder = folder.path.string();
        request.parameters = std::move(values);
        TextureResult result = jit::make_binding(program, texture, request);
        INFO(result.diagnostics);
        REQUIRE(result.binding);
        return *result.binding;
    }
    // `side` x `side` texels of the field, in 64 bits, so that nothing is lost but between the texels.
    TextureBinding bicubic(int side) const
    {
        const auto place = [side](int i) { return (i + 0.5) / side; };
        folder.write("field.tif", tiff(side, side, {64, Numbers::real},
                                       [&](int column, int row) { return field(place(column), place(row)); }));
        return bound("bicubic", {{"picture", "field.tif"}});
    }
};

struct Error {
    double height = 0, gradient = 0;
};

Error largest_error(const TextureBinding& binding)
{
    Error largest;
    for (int i = 0; i < 4000; ++i) {
        const double u = std::fmod(0.6180339887 * i, 1.0), v = std::fmod(0.7548776662 * i, 1.0);
        const haptel_sample found = sample_at(binding, {u, v, 0});
        largest.height = std::max(largest.height, std::fabs(found.height_m - field(u, v)));
        largest.gradient = std::max({largest.gradient, std::fabs(found.gradient[0] - field_by_u(u, v)),
                                     std::fabs(found.gradient[1] - field_by_v(u, v))});
    }
    return largest;
}

} // namespace

TEST_CASE("image: halving the texels divides the error of the height by 16 and of the gradient by 8")
{
    // Cubic splines: errors of the fourth and third order (de Boor, A Practical Guide to Splines, 1978).
    const FieldPictures pictures;
    Error last = largest_error(pictures.bicubic(24));
    for (const int side : {48, 96, 192}) {
        const Error error = largest_error(pictures.bicubic(side));
        CAPTURE(side, error.height, error.gradient);
        CHECK(std::fabs(std::log2(last.height / error.height) - 4) < 0.35);
        CHECK(std::fabs(std::log2(last.gradient / error.gradient) - 3) < 0.35);
        last = error;
    }
    CHECK(last.gradient < 1e-4 * 2 * pi); // of slopes up to about 9
}

TEST_CASE("image: the central difference weakens a wave as sin(w e) / (w e)")
{
    const FieldPictures pictures;
    constexpr int side = 256, waves = 4;
    pictures.folder.write("wave.tif", tiff(side, 8, {64, Numbers::real}, [](int column, int) {
                              return std::sin(2 * pi * waves * (column + 0.5) / side);
                          }));
    const std::array epsilons{0.5 / side, 2.0 / side, 0.02, 0.05, 0.125, 0.15, 0.2};
    for (const double epsilon : std::span(epsilons).first(test::is_sanitized ? 1 : epsilons.size())) {
        CAPTURE(epsilon);
        const TextureBinding central =
            pictures.bound("central", {{"picture", "wave.tif"}, {"epsilon", std::to_string(epsilon)}});
        const double we = 2 * pi * waves * std::stod(std::to_string(epsilon));
        const double weakened = std::sin(we) / we;
        double dot = 0, square = 0;
        for (int i = 0; i < 500; ++i) { // away from the picture's ends
            const double u = 0.3 + 0.4 * std::fmod(0.6180339887 * i, 1.0);
            const double slope = 2 * pi * waves * std::cos(2 * pi * waves * u);
            const double found = sample_at(central, {u, 0.5, 0}).gradient[0];
            CHECK(std::fabs(found - weakened * slope) < 1e-4 * 2 * pi * waves);
            dot += found * slope;
            square += slope * slope;
        }
        CHECK(std::fabs(dot / square - weakened) < 1e-5);
    }
}

TEST_CASE("image: the depth that a scene gives is in metres, whatever the bits of the picture")
{
    const FieldPictures pictures;
    const auto place = [](int i) { return (i + 0.5) / 32; };
    const Texels gray = [&](int column, int row) { return 0.5 + field(place(column), place(row)) / 1.2; };
    pictures.folder.write("a8.png", png(32, 32, 8, gray));
    pictures.folder.write("a16.png", png(32, 32, 16, gray));
    pictures.folder.write("a32.tif", tiff(32, 32, {32, Numbers::unsigned_whole}, gray));
    pictures.folder.write("real.exr", exr(32, 32, false, {{"Y"}}, gray));
    const struct {
        const char* file;
        double step; // of the numbers in the file
    } files[] = {{"a8.png", 1.0 / 255}, {"a16.png", 1.0 / 65535}, {"a32.tif", 0x1p-32}, {"real.exr", 0x1p-24}};
    for (const auto& [file, step] : files) {
        CAPTURE(file);
        const TextureBinding pressed = pictures.bound("pressed", {{"picture", file}, {"depth", "2mm"}});
        for (int column = 0; column < 32; ++column) {
            const double found = sample_at(pressed, {place(column), place(7), 0}).height_m;
            CHECK(std::fabs(found - 2e-3 * gray(column, 7)) <= 2e-3 * 0.51 * step + 1e-15);
        }
    }
}
