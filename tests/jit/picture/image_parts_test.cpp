// Channels and coarser levels of pictures, as textures read them: against means that this test makes by itself.
#include "jit/check/check_gradient.h"
#include "jit/check/oracle.h"
#include "jit/picture/image_file.h"
#include "lang/math/spline.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/folder.h"

#include <cmath>
#include <numbers>
#include <random>

using namespace haptel;
using test::height_at;

namespace {

// Of 2^5 x 2^3 texels, so that each texel of a level is the mean of a square of the file's.
constexpr int file_width = 32, file_height = 8, levels = 6;

uint8_t byte(int column, int row, int channel)
{
    return static_cast<uint8_t>((29 * column + 83 * row + 57 * channel + column * row * (channel + 1)) % 256);
}

double mean(int column, int row, int channel, int level)
{
    const int across = std::min(1 << level, file_width), down = std::min(1 << level, file_height);
    double sum = 0;
    for (int y = row * down; y < (row + 1) * down; ++y)
        for (int x = column * across; x < (column + 1) * across; ++x) sum += byte(x, y, channel) / 255.0;
    return sum / (across * down);
}

// TGA, type 2: true colour, not packed, 32 bits, the lowest row first, blue before green before red.
std::string tga()
{
    std::string bytes("\0\0\2\0\0\0\0\0\0\0\0\0", 12);
    for (int number : {file_width, file_height}) bytes += {static_cast<char>(number), '\0'};
    bytes += {'\x20', '\x08'};
    for (int row = 0; row < file_height; ++row)
        for (int column = 0; column < file_width; ++column)
            for (int channel : {2, 1, 0, 3}) bytes += static_cast<char>(byte(column, row, channel));
    return bytes;
}

const char* const parts_source = R"(
texture part(image picture, int colour = 0 in -5 .. 9, int level = 0 in -5 .. 99)
{
    return 1m * sample(coarser(channel(picture, colour), level), p.xy / 1m);
}
texture turned_round(image picture, int colour = 0 in -5 .. 9, int level = 0 in -5 .. 99)
{
    return 1m * sample(channel(coarser(coarser(picture, level), 0), colour), p.xy / 1m);
}
texture by_place(image picture)
{
    return 1m * sample(coarser(channel(picture, int(floor(5.0 * p.x / 1m))), int(floor(7.0 * p.y / 1m))), p.xy / 1m);
}
float through(image a, vec2 q) { return sample_mirrored(channel(a, 1), q) * image_width(coarser(a, 2)); }
texture passed(image picture) { return 1m * through(coarser(picture, 1), p.xy / 1m); }
texture colours(image picture) { return 1m * dot(sample_rgba(picture, p.xy / 1m), vec4(1.0, 2.0, 3.0, 4.0)); }
texture filtered(image picture, float wavelength = 0.0 in -1.0 .. 1e6) { return 1m * sample_filtered(picture, p.xy / 1m, wavelength); }
texture whole(image picture) { return 1m * sample(picture, p.xy / 1m); }
)";

std::shared_ptr<const jit::CompiledProgram> with_batches()
{
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    options.precision = jit::Precision::f64;
    options.iterations_in_lanes = false; // which adds in another order
    const jit::CompiledTextures result = jit::compile_texture(parts_source, options);
    INFO(result.rendered());
    REQUIRE(result.program);
    return result.program;
}

struct PartsOfPictures {
    test::Folder folder;
    std::shared_ptr<const jit::CompiledProgram> program = with_batches();

    PartsOfPictures() { folder.write("a.tga", tga()); }

    TextureBinding bound(const char* texture, std::vector<std::pair<std::string, std::string>> values = {}) const
    {
        TextureRequest request = test::request_over(2);
        request.folder = folder.path.string();
        request.parameters = std::move(values);
        request.parameters.emplace_back("picture", "a.tga");
        TextureResult result = jit::make_binding(program, texture, request, jit::For::figures);
        INFO(result.diagnostics);
        REQUIRE(result.binding);
        return *result.binding;
    }
};

std::shared_ptr<const ir::SplineImage> image_of(const std::vector<double>& texels, int64_t columns, int64_t rows)
{
    std::string error;
    return ir::SplineImage::make({texels, {}, columns, rows}, {.channels = 15, .levels = true}, error);
}

} // namespace

TEST_CASE("image parts: each channel at each level is the mean of the file's texels under its own")
{
    const PartsOfPictures pictures;
    for (int colour = -1; colour < 6; ++colour)
        for (int level = -1; level < levels + 3; ++level) {
            CAPTURE(colour, level);
            const int channel = std::clamp(colour, 0, 3), coarse = std::clamp(level, 0, levels - 1);
            const int columns = std::max(file_width >> coarse, 1), rows = std::max(file_height >> coarse, 1);
            const std::vector<std::pair<std::string, std::string>> values = {{"colour", std::to_string(colour)},
                                                                             {"level", std::to_string(level)}};
            const TextureBinding part = pictures.bound("part", values), same = pictures.bound("turned_round", values);
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column) {
                    const double u = (column + 0.5) / columns, v = (row + 0.5) / rows;
                    REQUIRE(std::fabs(height_at(part, u, v) - mean(column, row, channel, coarse)) < 1e-13);
                    REQUIRE(height_at(part, u, v) == height_at(same, u, v));
                }
        }
}

TEST_CASE("image parts: the mean stays where sides are odd, and a ramp stays one")
{
    std::mt19937 random(3);
    for (const auto& [columns, rows] : {std::pair<int64_t, int64_t>{7, 5}, {1, 9}, {13, 1}, {31, 2}}) {
        std::vector<double> texels;
        double sum = 0;
        for (int64_t i = 0; i < columns * rows; ++i)
            texels.push_back(std::uniform_real_distribution(-1.0, 1.0)(random));
        for (const double texel : texels) sum += texel;
        const auto image = image_of(texels, columns, rows);
        REQUIRE(image);
        const haptel_image* const last = ir::image_coarser(&image->view(), 99);
        CHECK((last->width == 1 && last->height == 1));
        CHECK(std::fabs(ir::spline(last, 0.3, 0.7, 0) - sum / static_cast<double>(texels.size())) < 1e-14);
        const double alpha = ir::spline(ir::image_channel(&image->view(), 3), 0.0, 0.0, 0);
        CHECK(std::fabs(alpha - 1) < 1e-15); // none in the file: opaque
        CHECK(ir::spline(ir::image_channel(&image->view(), 2), 0.0, 0.0, 0) ==
              ir::spline(&image->view(), 0.0, 0.0, 0)); // no colour: gray
    }
    const auto ramp = image_of({0, 1, 2, 3, 4, 5, 6}, 7, 1);
    const haptel_image* const half = ir::image_coarser(&ramp->view(), 1); // texels of 7/4
    REQUIRE(half->width == 4);
    for (int i = 0; i < 4; ++i) {
        const double from = 1.75 * i, to = from + 1.75; // the mean of the staircase floor(x) over these
        double area = 0;
        for (int k = 0; k < 7; ++k) area += k * std::max(0.0, std::min(to, k + 1.0) - std::max(from, k + 0.0));
        CHECK(std::fabs(ir::spline(half, double(i), 0.0, 0) - area / 1.75) < 1e-14);
    }
    CHECK(ir::image_coarser(nullptr, 3) == nullptr);
    CHECK(ir::image_channel(nullptr, 3) == nullptr);
    CHECK(ir::image_coarser(&jit::white_image().view(), 3) == &jit::white_image().view());
}

TEST_CASE("image parts: code, lanes, interpreter and oracle agree, and bounds hold what is found", "[code]")
{
    const PartsOfPictures pictures;
    for (const char* name : {"part", "by_place", "passed", "colours", "filtered"}) {
        CAPTURE(name);
        std::vector<std::pair<std::string, std::string>> values;
        if (std::string(name) == "part") values = {{"colour", "2"}, {"level", "1"}};
        if (std::string(name) == "filtered") values = {{"wavelength", "0.3"}};
        const TextureBinding binding = pictures.bound(name, values);
        constexpr size_t count = 300;
        std::vector<double> x(count), y(count), z(count), heights(count);
        for (size_t i = 0; i < count; ++i) {
            haptel_point point{};
            point.p[0] = x[i] = std::fmod(0.618 * double(i), 1.6) - 0.3;
            point.p[1] = y[i] = std::fmod(0.755 * double(i), 1.6) - 0.3;
            haptel_sample code{};
            binding.texture->height_gradient(&point, binding.block, &code);
            const haptel_sample slow = jit::interpret_sample(*pictures.program, binding, point);
            CHECK(test::same(code.height_m, slow.height_m));
            for (int axis : {0, 1, 2}) CHECK(test::same(code.gradient[axis], slow.gradient[axis]));
            CHECK(code.height_m >= binding.facts.height_min_m);
            CHECK(code.height_m <= binding.facts.height_max_m);
            heights[i] = code.height_m;
        }
        REQUIRE(binding.texture->height_batch);
        haptel_points points{};
        points.p[0] = x.data(), points.p[1] = y.data(), points.p[2] = z.data();
        std::vector<double> together(count);
        haptel_samples samples{};
        samples.height_m = together.data();
        binding.texture->height_batch(&points, count, binding.block, &samples);
        CHECK(together == heights);
        if (std::string(name) == "by_place") continue; // it jumps
        const jit::CheckBox box{{-0.5, -0.5, -0.5}, {0.9, 0.9, 0.9}};
        const jit::GradientCheck check = jit::check_gradient(pictures.program, binding, box, 500, 1);
        CHECK(check.failures == std::vector<std::string>{});
    }
}

TEST_CASE("image parts: bounds are as near as those of the part that is read")
{
    const PartsOfPictures pictures;
    const haptel_facts facts = pictures.bound("part", {{"colour", "1"}, {"level", "9"}}).facts;
    const double all = mean(0, 0, 1, levels - 1);
    CHECK(std::fabs(facts.height_min_m - all) < 1e-9);
    CHECK(std::fabs(facts.height_max_m - all) < 1e-9);
}

TEST_CASE("image parts: what is finer than the wavelength is averaged away, and no more than that")
{
    const PartsOfPictures pictures;
    const TextureBinding whole = pictures.bound("whole");
    double total = 0;
    for (int row = 0; row < file_height; ++row)
        for (int column = 0; column < file_width; ++column)
            total += 0.299 * byte(column, row, 0) + 0.587 * byte(column, row, 1) + 0.114 * byte(column, row, 2);
    for (const auto& [wavelength, is_mean] :
         {std::pair{"0", false}, {"-1", false}, {"0.0625", false}, {"1000", true}}) {
        CAPTURE(wavelength);
        const TextureBinding filtered = pictures.bound("filtered", {{"wavelength", wavelength}});
        for (const double u : {0.1, 0.33, 0.77}) {
            const double expected = is_mean ? total / (255.0 * file_width * file_height) : height_at(whole, u, 0.4);
            CHECK(std::fabs(height_at(filtered, u, 0.4) - expected) < 1e-13);
        }
    }
    // waves of 4 texels are gone and waves of 64 nearly whole where 16 texels are the shortest
    constexpr int side = 256;
    const auto swing = [&](double texels_a_wave) {
        test::Folder folder;
        std::string file = "P5\n256 4\n65535\n";
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < side; ++column) {
                const auto gray = static_cast<uint16_t>(
                    32768 + 30000 * std::sin(2 * std::numbers::pi * (column + 0.5) / texels_a_wave));
                file += {static_cast<char>(gray >> 8), static_cast<char>(gray & 255)};
            }
        folder.write("waves.pgm", file);
        TextureRequest request = test::request_over(2);
        request.folder = folder.path.string();
        request.parameters = {{"picture", "waves.pgm"}, {"wavelength", std::to_string(16.0 / side)}};
        const TextureResult bound = jit::make_binding(pictures.program, "filtered", request, jit::For::figures);
        REQUIRE(bound.binding);
        double least = 1, most = 0;
        for (int i = 0; i < 1000; ++i) {
            const double here = height_at(*bound.binding, 0.3 + 0.4 * i / 1000, 0.5);
            least = std::min(least, here), most = std::max(most, here);
        }
        return (most - least) * 65535 / 60000;
    };
    CHECK(swing(4) < 1e-4);
    CHECK(swing(64) > 0.97);
}
