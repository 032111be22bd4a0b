// What shaders' authors write means what its mathematics says: each pattern's compiled height and gradient against its
// twin's, and what is told of its borders against what is true.
#include "jit/check/check_gradient.h"
#include "jit/check/short_paths.h"
#include "lang/analyse.h"
#include "stdlib/stdlib.h"
#include "tests/ports/twin.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <set>

using namespace haptel;
using namespace haptel::ports;

namespace {

constexpr double reach_m = 0.1; // points are within this of the origin along each axis

// As a share of the depth. A sine hash multiplies what two libraries' sines differ by, 2e-16, by up to 43759.
constexpr double height_error_max = 1e-10;
// As a share of the steepest slope. Differences of the twin leave up to 3e-8 (see slopes_of).
constexpr double gradient_error_max = 1e-7;

std::vector<Twin> all_twins()
{
    std::vector<Twin> all;
    for (const auto& some :
         {value_twins, gradient_twins, cell_twins, scatter_twins, tile_twins, woven_twins, shape_twins, field_twins})
        all.insert(all.end(), some().begin(), some().end());
    return all;
}

std::string file_of(const Twin& twin)
{
    return test::project_path(std::string("tests/ports/patterns/") + twin.pattern + ".haptel");
}

std::string text_of(const Twin& twin)
{
    std::ifstream in(file_of(twin), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A pattern's texture with one choice of its depth and size.
class Pattern {
public:
    Pattern(const std::shared_ptr<const jit::CompiledProgram>& program, double depth, double size)
        : depth_m(depth), size_m(size)
    {
        TextureRequest request;
        request.parameters = {{"depth", written(depth)}, {"size", written(size)}};
        std::fill_n(request.box_minimum_m, 3, -reach_m);
        std::fill_n(request.box_maximum_m, 3, reach_m);
        TextureResult made = jit::make_binding(program, "", request);
        INFO(made.diagnostics);
        REQUIRE(made.binding);
        binding = *made.binding;
    }

    const double depth_m, size_m;
    TextureBinding binding;

    haptel_sample at(const dvec3& p_m) const
    {
        haptel_point point{};
        haptel_sample sample{};
        for (int i = 0; i < 3; ++i) point.p[i] = p_m[i];
        binding.texture->height_gradient(&point, binding.block, &sample);
        return sample;
    }

private:
    static std::string written(double metres) // to the bit
    {
        char text[40];
        std::snprintf(text, sizeof text, "%.17gm", metres);
        return text;
    }
};

class Points {
public:
    explicit Points(uint64_t seed) : random(seed) {}
    dvec3 next(double reach) { return reach * dvec3(coordinate(), coordinate(), coordinate()); }

private:
    std::mt19937_64 random;
    double coordinate() { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; } // the same on every machine
};

struct Slopes {
    dvec3 slope;     // of the twin, by q
    double mismatch; // between a step and its half: of a kink, within the step
};

Slopes slopes_of(const Twin& twin, const dvec3& q)
{
    constexpr double step = 0x1p-20; // of a cell: third derivatives of the finest octave leave 3e-8, rounding 1e-9
    Slopes found{{}, 0};
    for (int i = 0; i < 3; ++i) {
        const auto slope = [&](double by) {
            dvec3 a = q, b = q;
            a[i] -= by, b[i] += by;
            return (twin.height(b) - twin.height(a)) / (b[i] - a[i]);
        };
        found.slope[i] = slope(step / 2);
        found.mismatch = std::max(found.mismatch, std::fabs(found.slope[i] - slope(step)));
    }
    return found;
}

// The greatest jump of a twin that paths meet, each halved toward the greater change until it has no inner numbers.
double greatest_jump(const Twin& twin)
{
    Points points(11);
    double greatest = 0;
    for (int path = 0; path < 1000; ++path) {
        dvec3 a = points.next(5), b = a + points.next(0.4);
        if (path % 2 == 0) b.z = a.z;
        double at_a = twin.height(a), at_b = twin.height(b);
        for (int i = 0; i < 46; ++i) {
            const dvec3 middle = 0.5 * (a + b);
            const double between = twin.height(middle);
            const bool is_left = std::fabs(between - at_a) > std::fabs(at_b - between);
            (is_left ? b : a) = middle;
            (is_left ? at_b : at_a) = between;
        }
        greatest = std::max(greatest, std::fabs(at_b - at_a));
    }
    return greatest;
}

struct Errors {
    double height = 0, gradient = 0; // largest, of the depth; of the steepest slope
    int compared = 0, smooth = 0;    // points; of these those whose gradient was compared
};

Errors errors_of(const Twin& twin, const Pattern& pattern, int count, uint64_t seed)
{
    struct Compared {
        dvec3 q;
        double height;
        dvec3 gradient; // by q
        Slopes slopes;
    };
    std::vector<Compared> all;
    double steepest = 1e-9; // where all is flat
    Points points(seed);
    Errors errors;
    for (int i = 0; i < count; ++i) {
        const dvec3 p_m = points.next(reach_m), q = p_m / pattern.size_m;
        const haptel_sample sample = pattern.at(p_m);
        CHECK(sample.faults == 0);
        const dvec3 gradient(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
        all.push_back(
            {q, sample.height_m / pattern.depth_m, gradient * (pattern.size_m / pattern.depth_m), slopes_of(twin, q)});
        steepest = std::max(steepest, glm::length(all.back().slopes.slope));
        if (twin.friction) CHECK(std::fabs(sample.friction_scale - twin.friction(q)) < 1e-9);
    }
    for (const Compared& at : all) {
        const double error = std::fabs(at.height - twin.height(at.q));
        CAPTURE(at.q.x, at.q.y, at.q.z, at.height, twin.height(at.q));
        CHECK(error <= height_error_max);
        errors.height = std::max(errors.height, error);
        ++errors.compared;
        if (at.slopes.mismatch > gradient_error_max * steepest) continue;
        const double gradient_error = glm::length(at.gradient - at.slopes.slope) / steepest;
        CAPTURE(at.gradient.x, at.gradient.y, at.gradient.z, at.slopes.slope.x, at.slopes.slope.y, at.slopes.slope.z);
        CHECK(gradient_error <= gradient_error_max);
        errors.gradient = std::max(errors.gradient, gradient_error);
        ++errors.smooth;
    }
    return errors;
}

} // namespace

TEST_CASE("ports: each pattern has its twin")
{
    std::set<std::string> files, twins;
    for (const auto& file : std::filesystem::directory_iterator(test::project_path("tests/ports/patterns")))
        files.insert(file.path().stem());
    for (const Twin& twin : all_twins()) twins.insert(twin.pattern);
    CHECK(files == twins);
    CHECK(twins.size() >= 40);
}

TEST_CASE("ports: height and gradient of a pattern are its twin's")
{
    Errors largest;
    int index = 0;
    for (const Twin& twin : all_twins()) {
        if (test::is_sanitized && index++ % 5 != 0) continue;
        CAPTURE(twin.pattern);
        const jit::CompiledTextures compiled = jit::compile_texture_file(file_of(twin));
        INFO(compiled.rendered());
        CHECK_FALSE(compiled.diagnostics.has_errors());
        if (!compiled.program) continue;
        Errors sum;
        for (const Pattern& pattern :
             {Pattern(compiled.program, 50e-6, 5e-3), Pattern(compiled.program, 170e-6, 13.7e-3)}) {
            const Errors errors = errors_of(twin, pattern, 250, sum.compared + 1);
            sum.height = std::max(sum.height, errors.height);
            sum.gradient = std::max(sum.gradient, errors.gradient);
            sum.compared += errors.compared, sum.smooth += errors.smooth;
        }
        CHECK(sum.smooth >= 0.99 * sum.compared); // kinks are on lines, and a step is 1e-6
        largest.height = std::max(largest.height, sum.height);
        largest.gradient = std::max(largest.gradient, sum.gradient);
    }
    std::cout << "ports: largest error of a height " << largest.height << " of the depth, of a gradient "
              << largest.gradient << " of the steepest\n";
}

// What the twins say is right fails no check; a hash that shows late digits of its argument is told as that.
TEST_CASE("ports: rounding that a pattern amplifies is no fault, and is told of hashes alone")
{
    int index = 0, sines = 0;
    for (const Twin& twin : all_twins()) {
        if (test::is_sanitized && index++ % 5 != 0) continue;
        CAPTURE(twin.pattern);
        const jit::CompiledTextures compiled = jit::compile_texture_file(file_of(twin));
        REQUIRE(compiled.program);
        const Pattern pattern(compiled.program, 50e-6, 5e-3);
        const jit::GradientCheck check = jit::check_gradient(compiled.program, pattern.binding, {}, 60);
        for (const std::string& failure : check.failures) {
            INFO(failure);
            CHECK(failure.find("113-bit") == failure.npos);
        }
        if (!check.amplified) continue;
        const std::string blamed(compiled.program->sources().text(check.amplified->span));
        CAPTURE(blamed);
        const bool is_of_wave = blamed.find("sin(") != blamed.npos || blamed.find("cos(") != blamed.npos;
        CHECK(blamed.starts_with("fract("));
        CHECK(check.amplified->is_hash_of_sine == is_of_wave);
        sines += is_of_wave;
    }
    CHECK((test::is_sanitized || sines > 10)); // of the 20 hashes of sines among them
}

TEST_CASE("ports: patterns that jump are told so, and no others")
{
    int index = 0;
    std::vector<lang::SourceFile> library;
    for (const stdlib::LibraryFile& file : stdlib::library())
        library.push_back({std::string(file.name), std::string(file.text)});
    for (const Twin& twin : all_twins()) {
        if (test::is_sanitized && index++ % 5 != 0) continue;
        CAPTURE(twin.pattern, twin.borders_why);
        const bool does_jump = twin.borders == Borders::jump;
        CHECK((greatest_jump(twin) > 1e-3) == does_jump); // the table is true

        const jit::CompiledTextures compiled = jit::compile_texture_file(file_of(twin), jit::servo_options());
        REQUIRE(compiled.program);
        const Pattern pattern(compiled.program, 50e-6, 5e-3);
        const lang::CompileResult result =
            lang::compile({twin.pattern, text_of(twin)}, {.library = library, .load_import = {}, .only_texture = {}});
        REQUIRE(result.program);
        const ir::Texture& texture = result.program->module.textures.at(0);
        std::vector<double> values;
        for (const ir::Parameter& parameter : texture.parameters) values.push_back(parameter.value);
        lang::Diagnostics said;
        const auto seek_jump = [&pattern]() -> std::optional<lang::SeenJump> {
            jit::CheckBox box;
            std::fill_n(box.minimum_m, 3, -reach_m);
            std::fill_n(box.maximum_m, 3, reach_m);
            const std::optional<jit::Jump> jump = jit::find_jump(pattern.binding, box);
            if (!jump) return std::nullopt;
            return lang::SeenJump{jump->height_m, {jump->p_m[0], jump->p_m[1], jump->p_m[2]}, jump->time_s};
        };
        lang::analyse(*result.program, texture, values, {}, {.normal_turn_max_per_m = 1 / reach_m, .evaluations = 16},
                      said, seek_jump);
        INFO(lang::render(said.all(), result.sources));
        bool is_told = false;
        for (const lang::Diagnostic& finding : said.all()) is_told |= finding.code == "jump";
        CHECK(is_told == does_jump);
    }
}
