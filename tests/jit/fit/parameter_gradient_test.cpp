// How heights move with parameters, against differences of the heights themselves.
#include "jit/fit/parameter_gradient.h"
#include "jit/fit/unknowns.h"
#include "tests/jit/fit/hidden.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>

using namespace haptel;
using namespace haptel::jit;

namespace {

constexpr const char* five = R"(
texture five(float depth = 0.2mm in 0.01mm .. 1mm, float pitch = 2mm in 0.5mm .. 10mm, float turn = 0.3 in 0.0 .. 1.5,
             vec2 shift = vec2(0.1, 0.2), int octaves = 3 in 1 .. 6, bool deep = true)
{
    vec2 q = vec2(cos(turn) * p.x + sin(turn) * p.y, cos(turn) * p.y - sin(turn) * p.x) / pitch + shift;
    float h = fbm(vec3(q, 0.5), octaves);
    return depth * (deep ? h : 0.5 * h);
}
)";

std::vector<haptel_point> scattered(std::size_t count)
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-0.01, 0.01);
    std::vector<haptel_point> points(count);
    for (haptel_point& point : points) {
        point.p[0] = place(random);
        point.p[1] = place(random);
        point.n[2] = 1;
    }
    return points;
}

} // namespace

TEST_CASE("heights move with each parameter as differences of them do")
{
    TextureOptions options;
    options.entries = Entries::both_and_batches;
    options.precision = Precision::f64;
    const CompiledTextures compiled = compile_texture(five, options);
    INFO(compiled.rendered());
    REQUIRE(compiled.program);
    const TextureResult bound = make_binding(compiled.program, "five", {}, For::figures);
    REQUIRE(bound.binding);
    Unknowns unknowns(*bound.binding, {});
    REQUIRE(unknowns.reals.size() == 5);
    REQUIRE(unknowns.wholes.size() == 2);
    const ParameterGradient texture(compiled.program, "five", unknowns.real_parameters());
    REQUIRE(texture.error() == "");

    const std::vector<haptel_point> scatter = scattered(200);
    const PointArrays points(scatter);
    const std::size_t rows = points.size();
    std::vector<double> heights(rows), alone(rows), by(rows * 5), above(rows), below(rows);
    const Guess at = unknowns.start();
    texture.gradient(points, unknowns.block(at), heights, by);
    texture.heights(points, unknowns.block(at), alone);
    CHECK(heights == alone);
    for (std::size_t j = 0; j < 5; ++j) {
        const RealUnknown& real = unknowns.reals[j];
        const double step = 1e-6;
        Guess up = at, down = at;
        up.coordinates[j] += step;
        down.coordinates[j] -= step;
        texture.heights(points, unknowns.block(up), above);
        texture.heights(points, unknowns.block(down), below);
        double worst = 0, largest = 0;
        for (std::size_t i = 0; i < rows; ++i) {
            const double exact = by[j * rows + i] * real.slope(at.coordinates[j]);
            worst = std::max(worst, std::abs((above[i] - below[i]) / (2 * step) - exact));
            largest = std::max(largest, std::abs(exact));
        }
        INFO(texture.texture().parameters[real.parameter].name);
        CHECK(largest > 1e-5); // metres over the range
        CHECK(worst < 1e-7 * largest);
    }
}

TEST_CASE("what is looked for: all but what is given, pictures and whole numbers of many values")
{
    TextureOptions options;
    options.entries = Entries::both_and_batches;
    const CompiledTextures compiled = compile_texture(five, options);
    REQUIRE(compiled.program);
    TextureRequest request;
    request.parameters = {{"shift", "0.5, 0.25"}, {"octaves", "2"}};
    const TextureResult bound = make_binding(compiled.program, "five", request, For::figures);
    INFO(bound.diagnostics);
    REQUIRE(bound.binding);
    const Unknowns unknowns(*bound.binding, {"shift", "octaves"});
    CHECK(unknowns.reals.size() == 3);
    CHECK(unknowns.wholes.size() == 1);
    CHECK(unknowns.reals[0].is_by_logarithm);
    CHECK(unknowns.reals[0].value(0.5) == Approx(1e-4));
    CHECK(unknowns.reals[0].coordinate(1e-4) == Approx(0.5));
    CHECK(!unknowns.reals[2].is_by_logarithm);
    CHECK(unknowns.reals[2].value(0.5) == Approx(0.75));
}
