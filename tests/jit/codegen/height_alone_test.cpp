// The height alone has the bits of the height beside a gradient: in every precision and form, whatever else a texture
// computes.
#include "tests/fuzz/random_source.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/haptel_files.h"
#include "tests/support/tries.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

using namespace haptel;
using namespace haptel::test;

namespace {

struct Text {
    const char* about;
    const char* text;
};
constexpr Text texts[] = {
    {"a sum of products that the gradient forms in another order", R"(
        texture t(float w = 3mm)
        {
            float q = p.x / w;
            float k = 1.0 / w;
            float s = sin(q);
            float c = cos(q);
            float f = s * c;
            float g = s * (k * -s) + (k * c) * c;
            return 1mm * f + 1mm * 1mm * g;
        })"},
    {"a product in both arms that the gradient forms before them", R"(
        texture t(float w = 3mm)
        {
            float q = p.x / w;
            float k = 1.0 / w;
            float c = cos(q);
            float s = sin(q);
            float g = 0.1;
            if (p.y > 0mm) g = k * c * 1mm; else g = k * c * 1mm;
            return 1mm * s + 1mm * (g + c);
        })"},
    {"an output that needs f64 of what the height needs in f32", R"(
        texture t(float w = 3mm, out float friction_scale)
        {
            float x = 1000.0 * p.x / w + p.y / 1mm;
            friction_scale = 1.0 + fract(x);
            return 1um * x;
        })"},
    {"an output that needs a weight behind its loop", R"(
        texture t(float w = 3mm, float gain = 0.7, out float friction_scale)
        {
            float sum = 0.0;
            float weight = 1.0;
            for (int i = 0; i < 20; ++i) {
                sum += weight * sin(p.x / w * float(i + 1));
                weight *= gain;
            }
            friction_scale = 1.0 + weight;
            return 1um * sum;
        })"},
    {"a loop whose gradient is worth splitting, round one that is a sum", R"(
        texture t(float w = 3mm)
        {
            float x = p.x / w;
            float product = 1.0;
            for (int i = 0; i < 9; ++i) {
                float near = x * x + x * float(i) + 0.3 * x;
                float sum = 0.0;
                for (int j = 0; j < 11; ++j) sum += product * 0.1 * (x + float(j));
                product = 0.5 * (product + sin(sum) * near);
            }
            return 1um * product;
        })"},
};

constexpr jit::Precision precisions[] = {jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32};
constexpr jit::LaneForm forms[] = {jit::LaneForm::one, jit::LaneForm::iterations, jit::LaneForm::points};
using Kind = jit::EntryPoint::Kind;

std::string name_of(jit::Precision precision, jit::LaneForm form, Kind kind)
{
    return std::to_string(static_cast<int>(precision)) + std::to_string(static_cast<int>(form)) +
           std::to_string(static_cast<int>(kind));
}

haptel_point random_point(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> near(-0.02, 0.02), unit(-1, 1);
    haptel_point point{};
    for (double& coordinate : point.p) coordinate = near(random);
    for (double& component : point.n) component = unit(random);
    for (double& coordinate : point.uv) coordinate = unit(random);
    return point;
}

// Whether code has FMA: the host, and HAPTEL_ISA lets it.
bool fuses()
{
    const char* const wanted = std::getenv("HAPTEL_ISA");
    if (wanted && std::string_view(wanted) == "baseline") return false;
#if defined(__x86_64__)
    return __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

double batch_height(const jit::Code& code, const std::string& name, const haptel_point& point, const void* block)
{
    constexpr size_t count = sizeof(haptel_point) / sizeof(double);
    haptel_points points{};
    for (size_t i = 0; i < count; ++i)
        reinterpret_cast<const double**>(&points)[i] = reinterpret_cast<const double*>(&point) + i;
    double height = 0;
    haptel_samples samples{};
    samples.height_m = &height;
    code.batch_entry(name)(&points, 1, block, &samples);
    return height;
}

// Points at which they differ, of one texture in all precisions and forms. Nothing where the text is too large.
std::optional<int> differences(const jit::CompiledTextures& compiled, const std::string& name, jit::Effort effort)
{
    if (!compiled.program) return {};
    const haptel_texture* const texture = compiled.program->find(name);
    REQUIRE(texture);
    const ir::Texture& source = compiled.program->source_of(*texture);
    const TextureResult bound = jit::make_binding(compiled.program, name, request_over(0.04), jit::For::figures);
    INFO(bound.diagnostics);
    REQUIRE(bound.binding);
    std::vector<jit::EntryPoint> entries;
    for (const auto precision : precisions)
        for (const auto form : forms)
            for (const Kind kind : {Kind::height, Kind::height_gradient})
                entries.push_back({name_of(precision, form, kind), &source, kind, form, precision});
    const jit::CodeResult made = jit::compile_code(compiled.program->module(), entries, {effort});
    INFO(made.error);
    REQUIRE(made.code);
    int unequal = 0;
    for (const auto precision : precisions)
        for (const auto form : forms) {
            std::mt19937_64 random(5);
            const auto height = [&](Kind kind, const haptel_point& point) {
                const std::string entry = name_of(precision, form, kind);
                if (form == jit::LaneForm::points) return batch_height(*made.code, entry, point, bound.binding->block);
                haptel_sample sample{};
                made.code->entry(entry)(&point, bound.binding->block, &sample);
                return sample.height_m;
            };
            for (int i = 0; i < 50; ++i) {
                const haptel_point point = random_point(random);
                unequal += !same(height(Kind::height, point), height(Kind::height_gradient, point));
            }
        }
    return unequal;
}

jit::TextureOptions cheap()
{
    jit::TextureOptions options;
    options.entries = jit::Entries::height_gradient;
    options.effort = jit::Effort::draft;
    return options;
}

} // namespace

TEST_CASE("the height alone has the bits of the height beside its gradient, whatever the gradient or an output shares",
          "[code]")
{
    int number = 0;
    for (const Text& one : texts)
        for (const jit::Effort effort : {jit::Effort::draft, jit::Effort::quick, jit::Effort::full}) {
            if (test::is_sanitized && ++number % 4 != 0) continue; // of each effort some
            INFO(one.about << ", effort " << static_cast<int>(effort));
            CHECK(differences(jit::compile_texture(one.text, cheap()), "t", effort) == 0);
        }
}

TEST_CASE("the height alone has the bits of the height beside its gradient: the library's textures and the examples'",
          "[code]")
{
    for (const std::filesystem::path& file : test::texture_files()) {
        const jit::CompiledTextures compiled = jit::compile_texture_file(file, cheap());
        REQUIRE(compiled.program);
        for (const haptel_texture& texture : compiled.program->textures()) {
            INFO(file << " " << texture.name);
            CHECK(differences(compiled, texture.name, jit::Effort::draft) == 0);
        }
    }
}

TEST_CASE("the height alone has the bits of the height beside its gradient: random programs", "[code]")
{
    int compiled = 0;
    for (uint64_t seed = 0; seed < 60; ++seed) {
        const std::string text = fuzz::random_source(seed);
        INFO("seed " << seed << "\n" << text);
        const std::optional<int> unequal = differences(jit::compile_texture(text, cheap()), "t", jit::Effort::draft);
        CHECK(unequal.value_or(0) == 0);
        compiled += unequal.has_value();
    }
    CHECK(compiled > 40);
}

TEST_CASE("a product and a sum are rounded once in f32 where the processor can, and never in f64", "[code]")
{
    const jit::CompiledTextures compiled = jit::compile_texture("texture t() { return p.x * n.y + 1m * n.x; }");
    REQUIRE(compiled.program);
    const ir::Texture& source = compiled.program->source_of(*compiled.program->find("t"));
    const TextureResult bound = jit::make_binding(compiled.program, "t", request_over(2));
    REQUIRE(bound.binding);
    const jit::EntryPoint entries[] = {{"f64", &source, Kind::height, jit::LaneForm::one, jit::Precision::f64},
                                       {"f32", &source, Kind::height, jit::LaneForm::one, jit::Precision::f32}};
    const jit::CodeResult made = jit::compile_code(compiled.program->module(), entries, {jit::Effort::full});
    REQUIRE(made.code);
    std::mt19937_64 random(6);
    int once = 0;
    for (int i = 0; i < 200; ++i) {
        haptel_point point = random_point(random);
        point.p[0] *= 50;
        const auto height = [&](const char* entry) {
            haptel_sample sample{};
            made.code->entry(entry)(&point, bound.binding->block, &sample);
            return sample.height_m;
        };
        const double x = point.p[0], n = point.n[1], base = point.n[0];
        const volatile double product = x * n;
        CHECK(height("f64") == product + base);
        const auto x32 = static_cast<float>(x), n32 = static_cast<float>(n), base32 = static_cast<float>(base);
        const volatile float product32 = x32 * n32;
        const float twice = product32 + base32, fused = std::fmaf(x32, n32, base32);
        CHECK(height("f32") == static_cast<double>(fuses() ? fused : twice));
        once += fused != twice;
    }
    CHECK(once > 20); // there was something to see
}
