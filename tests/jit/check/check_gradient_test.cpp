// The check that finds wrong gradients: it must pass what is right and fail what is wrong by little.
#include "jit/check/check_gradient.h"
#include "lang/abi/outputs.h"
#include "tests/jit/codegen/samples.h"

#include <cmath>
#include <cstring>

using namespace haptel;
using test::compiled;
using test::contains;
using test::request_over;

namespace {

const char* const waves = "texture waves(float size = 3mm) {"
                          " return 50um * sin(6.2831853 * p.x / size) * cos(4.0 * p.y / size) + 0.01 * p.z; }";

// A texture that forwards to another one and then spoils the sample. One at a time: C functions have no closures.
struct Spoiled {
    using Spoil = void (*)(const haptel_point&, haptel_sample&);
    Spoiled(const TextureBinding& from, Spoil spoil) : texture(*from.texture), binding(from)
    {
        original = from.texture->height_gradient;
        how = spoil;
        texture.height_gradient = [](const haptel_point* point, const void* block, haptel_sample* sample) {
            original(point, block, sample);
            how(*point, *sample);
        };
        binding.texture = &texture;
    }
    haptel_texture texture;
    TextureBinding binding;
    static inline haptel_entry* original = nullptr;
    static inline Spoil how = nullptr;
};

jit::GradientCheck check(const char* text, uint32_t points = 100)
{
    const auto program = compiled(text);
    const auto bound = jit::make_binding(program, "", request_over(0.05), jit::For::figures);
    INFO(bound.diagnostics);
    REQUIRE(bound.binding);
    return jit::check_gradient(program, *bound.binding, {}, points);
}

std::string all(const std::vector<std::string>& lines)
{
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

} // namespace

TEST_CASE("right gradients pass, with errors near rounding")
{
    for (const char* text :
         {waves, "texture rock() { return 60um * fbm(p / 4mm, 4); }", "texture flat() { return 1mm; }",
          "texture mesh() { return 50um * sin(9.0 * uv.x + 4.0 * uv.y) * n.x + 10um * n.y * n.z; }",
          "texture kinks() { return 50um * abs(sin(p.x / 1mm)) + min(0.1 * p.y, 0.2 * p.z); }"}) {
        const jit::GradientCheck result = check(text);
        INFO(text << "\n" << all(result.failures));
        CHECK(result.passed());
        CHECK(result.points == 100);
        CHECK(*result.gradient_error_oracle <= 1e-12);
        CHECK(*result.gradient_error_difference <= 1e-12);
        CHECK(*result.height_error_oracle <= 1e-12);
        CHECK(result.not_finite == 0);
        CHECK(result.bounds_exceeded == 0);
    }
}

TEST_CASE("a gradient wrong by one part in 10^9 fails, and so does a height")
{
    const auto program = compiled(waves);
    const auto bound = jit::make_binding(program, "", request_over(0.05));
    REQUIRE(bound.binding);
    const auto result_of = [&](Spoiled::Spoil spoil) {
        const Spoiled spoiled(*bound.binding, spoil);
        return jit::check_gradient(program, spoiled.binding, {}, 50);
    };
    CHECK(result_of([](const haptel_point&, haptel_sample&) {}).passed());
    const auto gradient = result_of([](const haptel_point&, haptel_sample& s) { s.gradient[1] *= 1 + 1e-9; });
    CHECK(contains(all(gradient.failures), "gradient differs from the 113-bit oracle"));
    CHECK(contains(all(gradient.failures), "gradient differs from central differences"));
    const auto height = result_of([](const haptel_point&, haptel_sample& s) { s.height_m *= 1 + 1e-9; });
    CHECK(contains(all(height.failures), "height differs from the 113-bit oracle"));
    const auto rare = result_of([](const haptel_point& p, haptel_sample& s) {
        if (p.p[0] > 1e17) s.gradient[2] = NAN;
    });
    CHECK(contains(all(rare.failures), "not finite"));
    CHECK(rare.not_finite > 0);
    const auto high = result_of([](const haptel_point&, haptel_sample& s) { s.height_m += 1; });
    CHECK(high.bounds_exceeded == 50);
    const auto turned = result_of([](const haptel_point& p, haptel_sample& s) { s.gradient[0] += 10 * p.p[1]; });
    CHECK(turned.loop_integral_m > 1e-6); // not a gradient of anything
}

TEST_CASE("the class is measured, and facts that promise too much fail")
{
    CHECK(check("texture a() { return 50um * sin(p.x / 1mm); }").continuity_measured == HAPTEL_CONTINUITY_C1);
    CHECK(check("texture b() { return 50um * abs(sin(p.x / 1mm)); }").continuity_measured == HAPTEL_CONTINUITY_C0);
    CHECK(check("texture c() { return 50um * floor(p.x / 3mm); }").continuity_measured == HAPTEL_CONTINUITY_JUMP);
    CHECK(check("texture d() { return 50um * noise(p / 3mm); }").continuity_measured == HAPTEL_CONTINUITY_C1);
    CHECK(check("texture e() { return 50um * dnoise(p / 3mm).x; }").continuity_measured == HAPTEL_CONTINUITY_C0);

    const auto failures_of = [](const std::string& facts, const std::string& body) {
        const std::string text = "/// @facts " + facts + "\nfloat f(float x) { return " + body + "; }\n" +
                                 "texture t() { return 50um * f(p.x / 1mm); }";
        return all(check(text.c_str()).failures);
    };
    CHECK(failures_of("value -1 .. 1, slope 1, curvature 1, class C1", "sin(x)") == "");
    // Values that the body is seen to leave are a warning of the compiler, and nothing rests on them.
    CHECK(failures_of("value -0.9 .. 0.9, slope 1, curvature 1, class C1", "sin(x)") == "");
    CHECK(contains(failures_of("value -1 .. 1, slope 0.9, curvature 1, class C1", "sin(x)"), "the slope leaves"));
    CHECK(contains(failures_of("value -1 .. 1, slope 1, curvature 0.8, class C1", "sin(x)"), "the gradient changes"));
    CHECK(contains(failures_of("value 0 .. 1, slope 1, curvature 1, class C1", "abs(sin(x))"), "measured is C0"));
    CHECK(contains(failures_of("value 0 .. 1, slope 9, class C0", "fract(x)"), "measured is jump"));
}

TEST_CASE("the same seed gives the same figures, whatever the threads")
{
    const char* text = "texture rock() { return 60um * fbm(p / 4mm, 3); }";
    const jit::GradientCheck a = check(text, 64), b = check(text, 64);
    CHECK(*a.gradient_error_oracle == *b.gradient_error_oracle);
    CHECK(*a.conditioning == *b.conditioning);
    CHECK(*a.gradient_error_difference == *b.gradient_error_difference);
    CHECK(a.loop_integral_m == b.loop_integral_m);
}

TEST_CASE("points on kinks are counted, and too many fail")
{
    // The clamp's edge runs through every point: both sides are equal everywhere.
    const jit::GradientCheck result = check("texture edge() { return 1mm * fract(p.x / 1e-16m); }", 40);
    CHECK(result.points_at_kinks > 0);
    CHECK_FALSE(result.passed());
}
