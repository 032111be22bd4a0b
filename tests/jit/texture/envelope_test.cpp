// The range of heights that a hand is given, where the proof says too little.
#include "jit/texture/envelope.h"
#include "jit/texture/texture.h"
#include "tests/jit/codegen/samples.h"
#include "tests/jit/texture/idioms.h"

#include <algorithm>
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
    haptel_sample sample{0, {0, 0, 0}, 1, 1, 0};
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
        CHECK(range.height_max_m <= truth.maximum_m + 0.31 * true_m);
        CHECK(range.height_min_m >= truth.minimum_m - 0.31 * true_m);
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

TEST_CASE("a pole does not take away what is beside it")
{
    // Half of all places are within 80 um, and the pole is higher than anybody reaches.
    const auto program = compiled("texture pole() { return 1um / (p.x / 1m); }");
    const auto felt = jit::make_binding(program, "pole", request_over(0.05)).binding;
    REQUIRE(felt);
    CHECK((felt->facts.height_max_m > 80e-6 && felt->facts.height_max_m < 5e-3));
    CHECK((felt->facts.height_min_m < -80e-6 && felt->facts.height_min_m > -5e-3));
}

TEST_CASE("rare peaks that nobody found are not taken away while they are proven")
{
    const auto program =
        compiled("texture rivet() { return 100um * smoothstep(0.99999, 1.0, 1.0 - length(p - vec3(7mm, "
                 "3mm, 2mm)) / 1m); }");
    const auto felt = jit::make_binding(program, "rivet", request_over(0.05)).binding;
    REQUIRE(felt);
    CHECK(felt->facts.height_max_m >= 100e-6);
    CHECK(felt->shoulder_m[1] == 0);
}

TEST_CASE("a search is the same each time, and finds at least what even places show")
{
    const auto program = compiled(idioms);
    const TextureRequest request = request_over(0.05);
    const auto binding = jit::make_binding(program, "simplex", request, jit::For::figures).binding;
    REQUIRE(binding);
    const jit::FoundHeights once = jit::find_heights(*binding, request), again = jit::find_heights(*binding, request);
    CHECK((once.minimum_m == again.minimum_m && once.maximum_m == again.maximum_m));
    const Truth truth = dense(*binding, 0.05);
    CHECK(once.maximum_m >= truth.maximum_m - 0.1 * (truth.maximum_m - truth.minimum_m));
    CHECK(once.minimum_m <= truth.minimum_m + 0.1 * (truth.maximum_m - truth.minimum_m));
}
