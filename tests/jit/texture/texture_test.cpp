// Text to textures: what the C interface says, bindings, the resolver, and code that goes when its program goes.
#include "jit/check/oracle.h"
#include "jit/texture/resolver.h"
#include "lang/abi/evaluate.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/folder.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <thread>

using namespace haptel;
using test::compiled;
using test::contains;
using test::request_over;
using test::sample_at;

namespace {

const char* const grooves = R"(/// Grooves.
texture grooves(
    /// Distance of two grooves.
    float pitch = 0.8mm in 0.2mm .. 5mm,
    float depth = 60um in 0um .. 200um,
    int count = 3 in 1 .. 8,
    uint seed = 7 in 0 .. 100,
    bool flip = false)
{
    float h = 0.0;
    for (int i = 0; i < count; ++i) h += sin(6.283185307179586 * p.x / pitch);
    return depth * (flip ? -h : h) / 8.0 + (seed == 7u ? 0mm : 1mm);
}
)";

} // namespace

TEST_CASE("a texture's parameters, inputs and entries stand in the C interface")
{
    const auto program = compiled(grooves);
    REQUIRE(program->textures().size() == 1);
    const haptel_texture& texture = program->textures()[0];
    CHECK(texture.abi == HAPTEL_ABI_VERSION);
    CHECK(texture.size == sizeof(haptel_texture));
    CHECK(std::string(texture.name) == "grooves");
    CHECK(texture.reads == HAPTEL_READS_POINT);
    CHECK(texture.writes == 0);
    CHECK((texture.height && texture.height_gradient));
    REQUIRE(texture.parameter_count == 5);
    const haptel_parameter& pitch = texture.parameters[0];
    CHECK(std::string(pitch.name) == "pitch");
    CHECK(std::string(pitch.unit) == "m");
    CHECK(std::string(pitch.doc) == "Distance of two grooves.");
    CHECK(pitch.type == HAPTEL_FLOAT);
    CHECK((pitch.value == 0.0008 && pitch.minimum == 0.0002 && pitch.maximum == 0.005));
    const uint32_t types[] = {HAPTEL_FLOAT, HAPTEL_FLOAT, HAPTEL_INT, HAPTEL_UINT, HAPTEL_BOOL};
    for (size_t i = 0; i < 5; ++i) {
        CHECK(texture.parameters[i].type == types[i]);
        CHECK(texture.parameters[i].offset >= sizeof(haptel_block_head));
        CHECK(texture.parameters[i].offset < texture.block_size);
    }
    CHECK(program->find("grooves") == &texture);
    CHECK(program->find("groves") == nullptr);
}

TEST_CASE("a texture without a name is the only one, or the one that is called like its file")
{
    jit::TextureOptions options;
    options.name = "some/where/oak.haptel";
    const auto found = [&](const char* text) -> std::string {
        const jit::CompiledTextures made = jit::compile_texture(text, options);
        REQUIRE(made.program);
        const haptel_texture* texture = made.program->find("");
        return texture ? texture->name : "none";
    };
    CHECK(found("texture rings() { return 1mm; }") == "rings");
    CHECK(found("texture rings() { return 1mm; } texture oak() { return 2mm; } texture old = oak();") == "oak");
    CHECK(found("texture rings() { return 1mm; } texture bark() { return 2mm; }") == "none");
}

TEST_CASE("height and gradient are the closed form's, and parameters come from the block")
{
    const auto program = compiled(grooves);
    auto request = request_over(0.05);
    const auto value = [&](const TextureBinding& binding, double x) { return sample_at(binding, {x, 0.01, -0.02}); };
    constexpr double tau = 2 * std::numbers::pi;
    const auto check = [&](double pitch, double depth, int count, double sign, double shift) {
        const TextureResult bound = jit::make_binding(program, "grooves", request);
        INFO(bound.diagnostics);
        REQUIRE(bound.binding);
        for (double x : {0.0, 1e-4, 0.0123, -0.02}) {
            const haptel_sample sample = value(*bound.binding, x);
            const double scale = depth * count / 8;
            CHECK(std::fabs(sample.height_m - (sign * scale * std::sin(tau * x / pitch) + shift)) <= 1e-12 * scale);
            const double slope = sign * scale * tau / pitch * std::cos(tau * x / pitch);
            CHECK(std::fabs(sample.gradient[0] - slope) <= 1e-12 * scale * tau / pitch);
            CHECK((sample.gradient[1] == 0 && sample.gradient[2] == 0 && sample.faults == 0));
            CHECK((sample.stiffness_scale == 1 && sample.friction_scale == 1));
        }
    };
    check(0.0008, 60e-6, 3, 1, 0);
    request.parameters = {{"pitch", "2mm"}, {"depth", "100 um"}, {"count", "8"}, {"flip", "true"}, {"seed", "8"}};
    check(0.002, 100e-6, 8, -1, 0.001);
    request.parameters = {{"pitch", "0.001"}, {"depth", "1e-5"}, {"count", " 1 "}, {"flip", "false"}, {"seed", "7u"}};
    check(0.001, 1e-5, 1, 1, 0);
}

TEST_CASE("vectors and choices: by name, as the C interface lists them, and as a closed form")
{
    const auto program =
        compiled("texture wall(float a = 2.0, vec2 size = vec2(21cm, 7cm) in 1cm .. 50cm, int bond = stack "
                 "in {running, english, stack}, vec3 q = vec3(1.0, 2.0, 3.0) in vec3(0.0) .. vec3(1.0, "
                 "5.0, 9.0)) { return 1m * (a * p.x / size.x + p.y / size.y + dot(q, vec3(1.0, 10.0, "
                 "100.0)) + (bond == english ? 1000.0 : bond == stack ? 2000.0 : 0.0)); }");
    const haptel_texture& texture = program->textures()[0];
    std::string listed;
    for (uint32_t i = 0; i < texture.parameter_count; ++i) {
        listed += std::string(texture.parameters[i].name) + " " + std::to_string(texture.parameters[i].type) + ", ";
        CHECK((texture.choices[i] != nullptr) == (std::string(texture.parameters[i].name) == "bond"));
    }
    CHECK(listed == "a 0, size.x 0, size.y 0, bond 1, q.x 0, q.y 0, q.z 0, ");
    CHECK(std::string(texture.choices[3][0]) == "running");
    CHECK(std::string(texture.choices[3][1]) == "english");
    CHECK(std::string(texture.choices[3][2]) == "stack");
    CHECK(
        (texture.parameters[3].value == 2 && texture.parameters[3].minimum == 0 && texture.parameters[3].maximum == 2));
    CHECK((texture.parameters[6].minimum == 0 && texture.parameters[6].maximum == 9));

    TextureRequest request = request_over(0.05);
    const auto check = [&](double sx, double sy, double bond, double q) {
        const TextureResult bound = jit::make_binding(program, "wall", request);
        INFO(bound.diagnostics);
        REQUIRE(bound.binding);
        const haptel_sample sample = sample_at(*bound.binding, {0.01, 0.02, 0});
        CHECK(std::fabs(sample.height_m - (2 * 0.01 / sx + 0.02 / sy + q + 1000 * bond)) <= 1e-12 * (q + 1000 * bond));
        CHECK(std::fabs(sample.gradient[0] - 2 / sx) <= 1e-14 * 2 / sx);
        CHECK(std::fabs(sample.gradient[1] - 1 / sy) <= 1e-14 * 1 / sy);
    };
    check(0.21, 0.07, 2, 321);
    request.parameters = {{"size", "10cm, 5cm"}, {"bond", "english"}, {"q.y", "4"}};
    check(0.1, 0.05, 1, 341);
    request.parameters = {{"size.x", "10cm"}, {"bond", "running"}, {"q", "0.5, 0, 0"}};
    check(0.1, 0.07, 0, 0.5);
    request.parameters = {
        {"size.x", "10cm"}, {"size", "20cm, 20cm"}, {"size.y", "10cm"}, {"bond", "1"}}; // in their order
    check(0.2, 0.1, 1, 321);

    const auto refusal = [&](const std::string& name, const std::string& text) {
        request.parameters = {{name, text}};
        return jit::make_binding(program, "wall", request).diagnostics;
    };
    CHECK(refusal("bond", "englsh") == "error: parameter 'bond' of texture 'wall': expected running, english or stack, "
                                       "found 'englsh'\n  hint: did you mean 'english'?\n");
    CHECK(refusal("size", "1cm") ==
          "error: parameter 'size' of texture 'wall': expected 2 numbers, found '1cm'\n  hint: "
          "write them with commas between: 0.21, 0.07\n");
    CHECK(refusal("sise", "1cm, 1cm") ==
          "error: texture 'wall' has no parameter 'sise'\n  hint: did you mean 'size'?\n");
    CHECK(refusal("weight", "1") == "error: texture 'wall' has no parameter 'weight'\n  hint: it has the parameters a, "
                                    "size, size.x, size.y, bond, q, q.x, q.y, q.z\n");
}

TEST_CASE("vectors and choices: bounds over their ranges are those of a closed form")
{
    jit::TextureOptions options;
    options.facts_over_ranges = true;
    const auto made =
        jit::compile_texture("texture t(vec2 size = vec2(2mm) in vec2(1mm, 2mm) .. vec2(3mm, 5mm), int bond = "
                             "b in {a, b, c}) { return size.x - size.y + 1m * bond; }",
                             options);
    REQUIRE(made.program);
    const haptel_facts& facts = made.program->textures()[0].facts;
    CHECK(std::fabs(facts.height_min_m - (0.001 - 0.005)) <= 1e-12);
    CHECK(std::fabs(facts.height_max_m - (2 + 0.003 - 0.002)) <= 1e-12);
}

TEST_CASE("material outputs: code, interpreter and closed form agree; the height is that of the texture without them")
{
    const std::string body = "friction_scale = 1.0 + 0.5 * sin(p.x / 1mm); if (p.y > 0.0) stiffness_scale = 1.0 / p.z; "
                             "return 1mm * friction_scale; }\n";
    const auto program = compiled("texture with(out float stiffness_scale, out float friction_scale) { " + body +
                                  "texture without() { float friction_scale = 1.0, stiffness_scale = 1.0; " + body);
    CHECK(program->find("with")->writes == (HAPTEL_WRITES_STIFFNESS_SCALE | HAPTEL_WRITES_FRICTION_SCALE));
    CHECK(program->find("without")->writes == 0);
    const TextureResult with = jit::make_binding(program, "with", request_over(0.05)),
                        without = jit::make_binding(program, "without", request_over(0.05));
    REQUIRE(with.binding);
    REQUIRE(without.binding);
    for (const std::array<double, 3>& p :
         std::vector<std::array<double, 3>>{{0.0012, 0.1, 0.5}, {-0.003, -0.1, 0.5}, {0.002, 0.1, 0}}) {
        const haptel_sample sample = sample_at(*with.binding, p), plain = sample_at(*without.binding, p);
        const bool divides_by_zero = p[1] > 0 && p[2] == 0;
        CHECK(sample.stiffness_scale == (p[1] > 0 && !divides_by_zero ? 1 / p[2] : 1));
        CHECK(std::fabs(sample.friction_scale - (1 + 0.5 * std::sin(p[0] / 0.001))) <= 1e-15);
        CHECK(sample.faults == (divides_by_zero ? uint32_t{HAPTEL_FAULT_OUTPUT_NOT_FINITE} : 0u));
        CHECK((test::same(sample.height_m, plain.height_m) && test::same(sample.gradient[0], plain.gradient[0])));
        CHECK((plain.stiffness_scale == 1 && plain.friction_scale == 1));
        haptel_sample height_alone{};
        haptel_point point{};
        std::copy(p.begin(), p.end(), point.p);
        with.binding->texture->height(&point, with.binding->block, &height_alone);
        CHECK(test::same(height_alone.height_m, sample.height_m));
        CHECK(height_alone.faults == 0); // of the height only
        const haptel_sample slow = jit::interpret_sample(*program, *with.binding, point);
        CHECK((test::same(slow.stiffness_scale, sample.stiffness_scale) &&
               test::same(slow.friction_scale, sample.friction_scale)));
        CHECK(slow.faults == sample.faults);
        const jit::OracleSample truth = jit::Oracle(program, *with.binding).sample(point);
        CHECK(std::fabs(std::stod(truth.output_digits[1]) - sample.friction_scale) <= 1e-15);
        CHECK(std::stod(truth.output_digits[0]) == sample.stiffness_scale);
    }
}

TEST_CASE("values that do not fit are refused with the mending")
{
    const auto program = compiled(grooves);
    const std::vector<std::array<const char*, 3>> table = {
        {"count", "9", "outside its range: expected a whole number in 1 .. 8"},
        {"count", "0", "outside its range"},
        {"count", "2.5", "expected a whole number"},
        {"count", "99999999999", "outside its range"},
        {"seed", "-1", "outside its range"},
        {"pitch", "3deg", "expected a length such as 0.5mm"},
        {"pitch", "3furlong", "unknown unit"},
        {"pitch", "wide", "expected a number"},
        {"pitch", "", "expected a number"},
        {"pitch", "1e999", "too large"},
        {"pitch", "\xff\xfe", "expected a number"},
        {"flip", "1", "expected true or false, found '1'"},
        {"pich", "1mm", "did you mean 'pitch'?"},
        {"q", "1mm", "pitch, depth, count, seed, flip"},
    };
    for (const auto& [name, value, message] : table) {
        auto request = request_over(0.05);
        request.parameters = {{name, value}};
        const TextureResult bound = jit::make_binding(program, "grooves", request);
        INFO(name << " = " << value << "\n" << bound.diagnostics);
        CHECK_FALSE(bound.binding);
        CHECK(contains(bound.diagnostics, message));
    }
    CHECK(contains(jit::make_binding(program, "groovs", request_over(0.05)).diagnostics, "did you mean 'grooves'?"));
    auto request = request_over(0.05);
    request.parameters = {{"pitch", "60m"}}; // a real number may leave its range, but not in silence
    const TextureResult wide = jit::make_binding(program, "grooves", request);
    CHECK(wide.binding);
    CHECK(contains(wide.diagnostics, "warning: parameter 'pitch' of texture 'grooves': 60m is outside of its range "));
    request.parameters = {{"pitch", "1mm"}};
    CHECK(jit::make_binding(program, "grooves", request).diagnostics.empty());
    request = request_over(0.05);
    request.box_maximum_m[1] = NAN;
    CHECK(contains(jit::make_binding(program, "", request).diagnostics, "not a box"));
}

TEST_CASE("facts over the parameters' ranges are looked for where they are asked for")
{
    const std::string text = "texture waves(float depth = 20um in 0um .. 50um) { return depth * sinturn(p.x / 2mm); }";
    for (bool asked : {false, true}) {
        jit::TextureOptions options;
        options.facts_over_ranges = asked;
        const jit::CompiledTextures made = jit::compile_texture(text, options);
        REQUIRE(made.program);
        const haptel_facts& facts = made.program->textures()[0].facts;
        CHECK(std::isinf(facts.height_max_m) == !asked);
        if (asked) CHECK(std::fabs(facts.height_max_m - 50e-6) <= 1e-12);
        CHECK((facts.continuity == uint32_t{HAPTEL_CONTINUITY_C1}) == asked);
        CHECK(facts.operations_max > 0);
    }
}

TEST_CASE("facts hold over the object; a hand is given the heights alone, and a finite range of them")
{
    const auto program = compiled("texture tilt() { return 0.1 * p.x; }"
                                  "texture pole() { return 1um / (p.x / 1m); }");
    const TextureResult tilt = jit::make_binding(program, "tilt", request_over(0.05), jit::For::figures);
    REQUIRE(tilt.binding);
    CHECK(std::fabs(tilt.binding->facts.height_max_m - 0.0025) <= 1e-9);
    CHECK(std::fabs(tilt.binding->facts.height_min_m + 0.0025) <= 1e-9);
    CHECK(tilt.binding->facts.height_max_m >= 0.0025);
    CHECK(std::fabs(tilt.binding->facts.slope_max - 0.1) <= 1e-12);
    CHECK(tilt.binding->facts.curvature_max_per_m == 0);
    CHECK(tilt.binding->facts.continuity == uint32_t{HAPTEL_CONTINUITY_C1});
    CHECK(tilt.binding->facts.operations_max > 0);
    CHECK(std::isinf(program->find("tilt")->facts.height_max_m)); // nobody asked
    CHECK(program->find("tilt")->facts.operations_max == tilt.binding->facts.operations_max);

    const TextureResult felt = jit::make_binding(program, "tilt", request_over(0.05));
    REQUIRE(felt.binding);
    CHECK(felt.diagnostics.empty());
    CHECK(felt.binding->facts.height_max_m == tilt.binding->facts.height_max_m);
    CHECK((felt.binding->shoulder_m[0] == 0 && felt.binding->shoulder_m[1] == 0));
    CHECK(std::isinf(felt.binding->facts.slope_max)); // which it need not wait for

    const TextureResult pole = jit::make_binding(program, "pole", request_over(0.05));
    REQUIRE(pole.binding);
    CHECK(contains(pole.diagnostics, "not proven to be bounded"));
    CHECK(std::isfinite(pole.binding->facts.height_max_m));
    CHECK(pole.binding->shoulder_m[1] > 0);
    const TextureResult drawn = jit::make_binding(program, "pole", request_over(0.05), jit::For::figures);
    REQUIRE(drawn.binding);
    CHECK(std::isinf(drawn.binding->facts.height_max_m));
}

TEST_CASE("no entry returns what is not finite: it is 0 and a fault")
{
    const auto program = compiled("texture root() { return 1mm * clamp(sqrt(p.x / 1m), 0.0, 1.0); }"
                                  "texture pole() { return clamp(1um / (p.x / 1m), -1mm, 1mm); }");
    const auto bound = jit::make_binding(program, "root", request_over(0.05), jit::For::figures);
    REQUIRE(bound.binding);
    const haptel_sample outside = sample_at(*bound.binding, {-0.01, 0, 0});
    CHECK((outside.height_m == 0 && outside.gradient[0] == 0));
    CHECK((outside.faults & HAPTEL_FAULT_HEIGHT_NOT_FINITE));
    CHECK(sample_at(*bound.binding, {0.01, 0, 0}).faults == 0);
}

TEST_CASE("the height beside a gradient is the height alone, bit for bit, and the interpreter's")
{
    const auto program = compiled(R"(
        texture rock(float size = 4mm in 1mm .. 20mm, int octaves = 5 in 1 .. 8) {
            return 60um * fbm(p / size, octaves) + 10um * abs(sin(uv.x * 7.0)) * n.z;
        }
        texture weave(float size = 4mm in 1mm .. 20mm) { return 60um * fourier(p.xy / size, 7); }
        texture cells() { vec3 q = floor(p / 1mm); return 20um * fract(length(q) + noise(p / 3mm)); })");
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-0.025, 0.025);
    for (const haptel_texture& texture : program->textures()) {
        const auto bound = jit::make_binding(program, texture.name, request_over(0.05), jit::For::figures);
        REQUIRE(bound.binding);
        int different = 0;
        for (int i = 0; i < 500; ++i) {
            haptel_point point{};
            double* numbers = point.p;
            for (size_t j = 0; j < sizeof point / sizeof(double); ++j) numbers[j] = place(random);
            point.n[2] = 0.9;
            haptel_sample alone{}, beside{};
            texture.height(&point, bound.binding->block, &alone);
            texture.height_gradient(&point, bound.binding->block, &beside);
            const haptel_sample plain = jit::interpret_sample(*program, *bound.binding, point);
            different += !test::same(alone.height_m, beside.height_m) || !test::same(plain.height_m, beside.height_m);
            for (size_t axis = 0; axis < 3; ++axis)
                different += !test::same(plain.gradient[axis], beside.gradient[axis]);
        }
        INFO(texture.name);
        CHECK(different == 0);
    }
}

TEST_CASE("what is wrong with a text is data, and rendered")
{
    const jit::CompiledTextures broken = jit::compile_texture("texture t() { return dept; }", {.name = "t.haptel"});
    CHECK_FALSE(broken.program);
    REQUIRE(broken.diagnostics.has_errors());
    CHECK(contains(broken.rendered(), "t.haptel:1:22"));
    const jit::CompiledTextures missing = jit::compile_texture_file("/nowhere/rock.haptel");
    CHECK_FALSE(missing.program);
    CHECK(contains(missing.rendered(), "/nowhere/rock.haptel:1:1: error: cannot read this file: it does not exist"));
}

TEST_CASE("dropping a program frees its code; bindings keep it")
{
    REQUIRE(test::programs_fall_to(0)); // those of the tests before
    std::optional<TextureBinding> binding;
    {
        const auto program = compiled(grooves);
        CHECK(jit::programs_alive() == 1);
        binding = jit::make_binding(program, "grooves", request_over(0.05)).binding;
    }
    CHECK(jit::programs_alive() == 1);
    CHECK(sample_at(*binding, {1e-4, 0, 0}).height_m > 0);
    binding.reset();
    CHECK(test::programs_fall_to(0));
}

TEST_CASE("many programs, from several threads, each its own")
{
    REQUIRE(test::programs_fall_to(0)); // those of the tests before
    std::atomic<int> wrong{0};
    const auto work = [&](int first) {
        for (int i = first; i < first + 20; ++i) {
            const std::string text = "texture t() { return " + std::to_string(i) + ".0um; }";
            const auto compiled_one = jit::compile_texture(text, {.standard_library = false});
            haptel_sample sample{};
            const auto bound = jit::make_binding(compiled_one.program, "t", request_over(0.05));
            if (bound.binding) sample = sample_at(*bound.binding, {0, 0, 0});
            wrong += std::fabs(sample.height_m - i * 1e-6) > 1e-18;
        }
    };
    std::thread threads[] = {std::thread(work, 0), std::thread(work, 100), std::thread(work, 200)};
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == 0);
    CHECK(test::programs_fall_to(0));
}

TEST_CASE("a binding says whether its footprint takes detail away")
{
    const auto program = compiled("texture rock() { return 60um * fbm(p / 1mm, 5); } texture flat() { return 1mm; }");
    const auto is_band_limited = [&](const char* name, double footprint_m) {
        TextureRequest request = request_over(0.05);
        request.footprint_m = footprint_m;
        return jit::make_binding(program, name, request).binding.value().band_limited;
    };
    CHECK(is_band_limited("rock", 1e-3));
    CHECK_FALSE(is_band_limited("rock", 1e-9));
    CHECK_FALSE(is_band_limited("rock", 0));
    CHECK_FALSE(is_band_limited("flat", 1e-3));
}

TEST_CASE("many points at once have the bits of one after the other, whichever inputs a texture reads")
{
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    options.precision = jit::Precision::f64;
    std::mt19937_64 random(7);
    std::vector<haptel_point> points(300); // more than one group of them
    for (haptel_point& point : points) {
        double numbers[sizeof(haptel_point) / sizeof(double)];
        for (double& number : numbers) number = std::uniform_real_distribution<double>(-1, 1)(random);
        std::memcpy(&point, numbers, sizeof point);
    }
    for (const char* height : {"sin(p.x) * p.y + p.z", "n.x * n.y + n.z * n.z", "uv.x * uv.y", "sin(time)",
                               "sin(p.z + time) * n.y + uv.x * n.z"}) {
        CAPTURE(height);
        const auto made = jit::compile_texture(std::string("texture t() { return ") + height + "; }", options);
        REQUIRE(made.program);
        const auto bound = jit::make_binding(made.program, "t", request_over(2), jit::For::figures);
        REQUIRE(bound.binding);
        std::vector<haptel_sample> samples(points.size());
        evaluate(*bound.binding, points, samples);
        for (size_t i = 0; i < points.size(); ++i) {
            haptel_sample one{};
            bound.binding->texture->height_gradient(&points[i], bound.binding->block, &one);
            CHECK(samples[i].height_m == one.height_m);
            for (size_t k = 0; k < 3; ++k) CHECK(samples[i].gradient[k] == one.gradient[k]);
        }
    }
}
