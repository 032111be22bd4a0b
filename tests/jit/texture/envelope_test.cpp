// The range of heights that a hand is given, where the proof says too little.
#include "jit/texture/envelope.h"
#include "jit/texture/texture.h"
#include "tests/jit/codegen/samples.h"
#include "tests/jit/texture/idioms.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

using namespace haptel;
using test::compiled;
using test::contains;
using test::idioms;
using test::request_over;

namespace {

struct Truth {
    double minimum_m = INFINITY, maximum_m = -INFINITY;
};

haptel_point random_point(std::mt19937_64& random, double side_m)
{
    std::uniform_real_distribution<double> share(-0.5, 0.5);
    haptel_point point{};
    double length = 0;
    for (int k = 0; k < 3; ++k) {
        point.p[k] = side_m * share(random);
        point.n[k] = share(random);
        length += point.n[k] * point.n[k];
    }
    for (double& n : point.n) n /= std::sqrt(length);
    for (double& uv : point.uv) uv = share(random) + 0.5;
    return point;
}

double height_at(const TextureBinding& binding, const haptel_point& point)
{
    haptel_sample sample = blank_sample;
    binding.texture->height_gradient(&point, binding.block, &sample);
    return sample.height_m;
}

// By many more places than a search looks at.
Truth dense(const TextureBinding& binding, double side_m)
{
    std::mt19937_64 random(9);
    Truth truth;
    for (int i = 0; i < 300'000; ++i) {
        const double height_m = height_at(binding, random_point(random, side_m));
        truth.minimum_m = std::min(truth.minimum_m, height_m);
        truth.maximum_m = std::max(truth.maximum_m, height_m);
    }
    return truth;
}

} // namespace

TEST_CASE("what is proven too wide is felt within what was found, and all of it is felt")
{
    constexpr double side_m = 0.05;
    const auto program = compiled(idioms);
    for (const haptel_texture& texture : program->textures()) {
        const TextureResult felt = jit::make_binding(program, texture.name, request_over(side_m)),
                            proven = jit::make_binding(program, texture.name, request_over(side_m), jit::For::figures);
        REQUIRE((felt.binding && proven.binding));
        const haptel_facts &range = felt.binding->facts, &proof = proven.binding->facts;
        const Truth truth = dense(*proven.binding, side_m);
        const double true_m = truth.maximum_m - truth.minimum_m;
        CAPTURE(texture.name, truth.minimum_m, truth.maximum_m, range.height_min_m, range.height_max_m,
                proof.height_min_m, proof.height_max_m);
        CHECK(proof.height_max_m - proof.height_min_m > 3 * true_m);
        CHECK(contains(felt.diagnostics, "is bent to stay within"));
        // All that is there lies before the shoulders, and the surface is hardly lowered by more.
        const double* shoulder_m = felt.binding->shoulder_m;
        CHECK(truth.maximum_m <= range.height_max_m - shoulder_m[1] / 2);
        CHECK(truth.minimum_m >= range.height_min_m + shoulder_m[0] / 2);
        CHECK(range.height_max_m <= truth.maximum_m + 0.35 * true_m);
        CHECK(range.height_min_m >= truth.minimum_m - 0.35 * true_m);
    }
}

TEST_CASE("what is proven well is felt as it is proven")
{
    const auto program = compiled("texture a() { return 50um * sin(p.x / 1mm); }"
                                  "texture b() { return 60um * fbm(p / 3mm, 5); }"
                                  "texture c() { return 0um; }"
                                  "texture d() { return 100um * smoothstep(0.0, 1.0, noise(p / 2mm)); }");
    for (const haptel_texture& texture : program->textures()) {
        const auto felt = jit::make_binding(program, texture.name, request_over(0.05)).binding,
                   proven = jit::make_binding(program, texture.name, request_over(0.05), jit::For::figures).binding;
        REQUIRE((felt && proven));
        CAPTURE(texture.name);
        CHECK((felt->shoulder_m[0] == 0 && felt->shoulder_m[1] == 0));
        CHECK(felt->facts.height_max_m == proven->facts.height_max_m);
        CHECK(felt->facts.height_min_m == proven->facts.height_min_m);
    }
}

TEST_CASE("a pole does not take away what is beside it, and what grows without bound is felt")
{
    // Half of all places are within 80 um, and the pole is higher than anybody reaches.
    const auto program = compiled("texture pole() { return 1um / (p.x / 1m); }"
                                  "texture steep() { return 1um * exp(p.x / 0.05mm); }");
    for (const char* name : {"pole", "steep"}) {
        const auto felt = jit::make_binding(program, name, request_over(0.05)).binding;
        REQUIRE(felt);
        CAPTURE(name, felt->facts.height_max_m, felt->facts.height_min_m);
        CHECK(felt->facts.height_max_m < (std::string(name) == "pole" ? 5e-3 : 50e-3));
        CHECK(felt->facts.height_min_m > -5e-3);
    }
    const auto pole = jit::make_binding(program, "pole", request_over(0.05)).binding;
    CHECK((pole->facts.height_max_m > 80e-6 && pole->facts.height_min_m < -80e-6));
}

TEST_CASE("rare peaks are felt as they are proven, beside a background too")
{
    // Each is less than a millionth of the box; the first lies on nothing, the others on grain.
    const auto program = compiled(R"(
texture rivet() { return 100um * smoothstep(0.99999, 1.0, 1.0 - length(p - vec3(7mm, 3mm, 2mm)) / 1m); }
texture grain() { return 2um * noise(p / 1mm) + 200um * smoothstep(0.0, 0.2mm, 0.8mm - length(p.xy - vec2(7mm, 3mm))); }
texture high() { return 2um * noise(p / 1mm) + 2mm * smoothstep(0.0, 0.2mm, 0.8mm - length(p - vec3(7mm, 3mm, 2mm))); }
texture ridge() { return 3um * noise(p / 1mm) + 900um * smoothstep(0.0, 0.1mm, 0.1mm - abs(p.x - 13.3mm)); }
texture tip() { vec3 q = (p - vec3(7mm, 3mm, 2mm)) / 0.3mm; return 100um / (1.0 + dot(q, q)); }
texture late() { return 1um * noise(p / 1mm) + 90um * smoothstep(0.0, 1.0, time - 90.0s); }
)");
    for (const haptel_texture& texture : program->textures())
        for (const double side_m : {0.05, 0.2}) {
            const TextureResult made = jit::make_binding(program, texture.name, request_over(side_m));
            const auto proven =
                jit::make_binding(program, texture.name, request_over(side_m), jit::For::figures).binding;
            REQUIRE((made.binding && proven));
            CAPTURE(texture.name, side_m, made.binding->facts.height_max_m);
            CHECK(made.diagnostics.empty());
            CHECK(made.binding->facts.height_max_m == proven->facts.height_max_m);
            CHECK(made.binding->shoulder_m[1] == 0);
        }
}

TEST_CASE("a search is the same each time, and finds at least what even places show")
{
    const auto program = compiled(idioms);
    jit::FoundHeights once, again;
    const auto bound = [&](jit::FoundHeights* found) {
        return jit::make_binding(program, "simplex", request_over(0.05), jit::For::hand, found).binding;
    };
    const auto binding = bound(&once);
    bound(&again);
    REQUIRE(binding);
    CHECK((once.minimum_m == again.minimum_m && once.maximum_m == again.maximum_m));
    const Truth truth = dense(*binding, 0.05);
    CHECK(once.maximum_m >= truth.maximum_m - 0.1 * (truth.maximum_m - truth.minimum_m));
    CHECK(once.minimum_m <= truth.minimum_m + 0.1 * (truth.maximum_m - truth.minimum_m));
}

TEST_CASE("a search that ends early gives the range of one that goes to the end")
{
    const auto program = compiled(std::string(idioms) + R"(
texture sines() { return 50um * sin(p.x / 1mm) * sin(p.y / 3mm); }
texture octaves() { return 400um * fbm(p / 3mm, 5); }
texture flat() { return 30um; }
texture wide() { return 3mm * perlin(p / 2mm) * perlin(p / 3mm) * perlin(p / 5mm); }
texture shallow() { return 30um * noise(p / 1mm) * noise(p / 2mm) * noise(p / 3mm); }
texture rivet() { return 2um * noise(p / 1mm) + 2mm * smoothstep(0.0, 0.2mm, 0.8mm - length(p - vec3(7mm, 3mm, 2mm))); }
texture pole() { return 1um / (p.x / 1m); }
texture steep() { return 1um * exp(p.x / 0.05mm); }
texture high() { return 1mm * exp(p.x / 10mm); }
)");
    for (const haptel_texture& texture : program->textures())
        for (const double side_m : {0.05, 0.2}) {
            jit::FoundHeights found;
            const TextureRequest request = request_over(side_m);
            const auto early = jit::make_binding(program, texture.name, request),
                       late = jit::make_binding(program, texture.name, request, jit::For::hand, &found);
            REQUIRE((early.binding && late.binding));
            CAPTURE(texture.name, side_m, late.binding->facts.height_min_m, late.binding->facts.height_max_m);
            CHECK(early.binding->facts.height_min_m == late.binding->facts.height_min_m);
            CHECK(early.binding->facts.height_max_m == late.binding->facts.height_max_m);
            CHECK(std::ranges::equal(early.binding->shoulder_m, late.binding->shoulder_m));
            CHECK(early.diagnostics == late.diagnostics);
        }
}

TEST_CASE("a knob is turned at once: a range that was found is stretched, one that was proven stays proven")
{
    constexpr double side_m = 0.05;
    const auto program = compiled(std::string(idioms) + R"(
texture found(float depth = 50um, float size = 3mm) { return depth * simplex_plane(p.xy / size); }
texture proven(float depth = 50um, float size = 3mm)
{ return 2um * noise(p / size) + depth * smoothstep(0.0, 0.2mm, 0.8mm - length(p - vec3(7mm, 3mm, 2mm))); }
texture sparse(float depth = 50um, float size = 3mm)
{
    float w = 0.5 + 0.5 * noise(p / size);
    return depth * w * w * w * w * w * w;
}
texture long_sum(float depth = 50um)
{
    float u = p.x / 10mm;
    float sum = 0.0;
    for (int i = 0; i < 150; ++i) sum += exp(4.0 * u + 0.001 * float(i)) * exp(-3.9 * u);
    return depth * sum / 150.0;
}
)");
    const auto turned = [&](const char* name, const char* parameter, const char* value) {
        TextureRequest request = request_over(side_m);
        const auto before = jit::make_binding(program, name, request).binding;
        REQUIRE(before);
        request.parameters = {{parameter, value}};
        const auto after = jit::make_binding_at_once(program, name, request, *before).binding;
        REQUIRE(after);
        const haptel_facts& range = after->facts;
        CHECK(after->shoulder_m[0] + after->shoulder_m[1] <= 2 * (range.height_max_m - range.height_min_m));
        // Nothing of it is felt bent.
        const Truth truth = dense(*after, side_m);
        CAPTURE(name, parameter, value, truth.minimum_m, truth.maximum_m, range.height_min_m, range.height_max_m);
        CHECK(truth.maximum_m <= range.height_max_m - after->shoulder_m[1] / 2 + 1e-12);
        CHECK(truth.minimum_m >= range.height_min_m + after->shoulder_m[0] / 2 - 1e-12);
        return std::pair(*before, *after);
    };
    for (const char* depth : {"80um", "20um", "1mm"}) {
        const auto [before, after] = turned("found", "depth", depth);
        const double share = std::strtod(depth, nullptr) * (std::string(depth) == "1mm" ? 1e-3 : 1e-6) / 50e-6;
        CHECK(std::fabs(after.facts.height_max_m / before.facts.height_max_m - share) < 1e-9 * share);
        CHECK(std::fabs(after.facts.height_min_m / before.facts.height_min_m - share) < 1e-9 * share);
        CHECK(std::fabs(after.shoulder_m[1] / before.shoulder_m[1] - share) < 1e-9 * share);
    }
    for (const char* size : {"2mm", "9mm"}) { // the same heights at other places
        const auto [before, after] = turned("found", "size", size);
        CHECK(std::fabs(after.facts.height_max_m / before.facts.height_max_m - 1) < 0.1);
        CHECK(std::fabs(after.facts.height_min_m / before.facts.height_min_m - 1) < 0.1);
    }
    // A rivet that no place of a few lies on is not cut off.
    for (const char* depth : {"140um", "20um"}) {
        const auto [before, after] = turned("proven", "depth", depth);
        CHECK((after.shoulder_m[0] == 0 && after.shoulder_m[1] == 0));
        CHECK(after.facts.height_max_m >= std::strtod(depth, nullptr) * 1e-6);
    }
    // Nor is what a few places hardly show, and much greater than before.
    for (const char* depth : {"400um", "4mm"}) {
        const auto [before, after] = turned("sparse", "depth", depth);
        CHECK((after.shoulder_m[0] == 0 && after.shoulder_m[1] == 0));
    }
    // Nothing can be said at once where nobody has seen a height that is so much greater, where a short proof is far
    // too wide although a longer one is not, and of heights that are all one.
    const auto says_nothing = [&](const char* name, const char* depth) {
        TextureRequest request = request_over(side_m);
        const auto before = jit::make_binding(program, name, request).binding;
        request.parameters = {{"depth", depth}};
        const TextureResult at_once = jit::make_binding_at_once(program, name, request, before.value());
        CAPTURE(name, before->facts.height_max_m, before->shoulder_m[1]);
        CHECK((!at_once.binding && at_once.diagnostics.empty()));
        return before->shoulder_m[0] == 0 && before->shoulder_m[1] == 0;
    };
    CHECK(says_nothing("proven", "3mm"));
    CHECK(says_nothing("long_sum", "60um"));
    TextureRequest request = request_over(side_m);
    const auto before = jit::make_binding(program, "found", request).binding;
    request.parameters = {{"depth", "0um"}};
    const TextureResult flat = jit::make_binding_at_once(program, "found", request, before.value());
    CHECK((!flat.binding && flat.diagnostics.empty()));
    request.parameters = {{"depth", "5kg"}};
    CHECK(!jit::make_binding_at_once(program, "found", request, before.value()).diagnostics.empty());
}

TEST_CASE("a texture that is slow is searched by few calls, and one that is too slow by none")
{
    const auto program =
        compiled("texture slow(int n = 20000 in 1 .. 20000) { float s = 0.0; for (int i = 0; i < n; ++i) "
                 "s += sin(p.x / 1mm + s); return 1um / (1.1 + sin(s)); }");
    TextureRequest request = request_over(0.05);
    request.servo_period_s = 1e-3;
    const auto start = std::chrono::steady_clock::now();
    CHECK(contains(jit::make_binding(program, "slow", request).diagnostics, "per call"));
    request.servo_period_s = 0;
    CHECK(jit::make_binding(program, "slow", request).binding);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20)); // hangs are not felt otherwise
}
