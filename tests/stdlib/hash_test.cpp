// hash against pcg4d as its authors publish it, and against what random numbers are: evenly spread, and unrelated to
// their neighbours.
#include "lang/ir/run/interpret.h"
#include "tests/stdlib/field.h"
#include "tests/stdlib/pcg4d.h"
#include "tests/support/catch.h"

#include <cmath>

using namespace haptel;
using namespace haptel::test;

namespace {

double expected_number(size_t which, double i, double j = 0, double k = 0, double l = 0)
{
    const auto whole = [](double x) { return static_cast<int32_t>(x); };
    return unit_of(pcg4d(whole(i), whole(j), whole(k), whole(l))[which]);
}

// Of the cells 0 .. side - 1 along both axes, row after row.
std::vector<double> hashed(const std::string& expression, int side)
{
    const Field field(expression);
    std::vector<double> all;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) all.push_back(field({i + 0.5, j + 0.5, 0}).value);
    return all;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b)
{
    REQUIRE(a.size() == b.size());
    double sum = 0; // of numbers with mean 1/2 and variance 1/12
    for (size_t i = 0; i < a.size(); ++i) sum += 12 * (a[i] - 0.5) * (b[i] - 0.5);
    return sum / static_cast<double>(a.size());
}

} // namespace

TEST_CASE("hash, hash2 and hash3 of whole numbers are pcg4d, over all of their range")
{
    const std::string arguments[] = {"int(q.x)", "int(q.x), int(q.y)", "int(q.x), int(q.y), int(q.z)",
                                     "int(q.x), int(q.y), int(q.z), int(q.x) ^ int(q.y)"};
    std::vector<Vec3> places = points_within(2147483647, 200);
    for (const double x : {-2147483648.0, -1.0, 0.0, 255.0, 256.0, 2147483647.0}) places.push_back({x, -x / 2, 3});
    for (size_t count = 1; count <= 4; ++count) {
        const std::string& given = arguments[count - 1];
        const Field one("hash(" + given + ")"), two("hash2(" + given + ").y"), three("hash3(" + given + ").z");
        for (const Vec3& q : places) {
            const double i = std::trunc(q[0]), j = count > 1 ? std::trunc(q[1]) : 0,
                         k = count > 2 ? std::trunc(q[2]) : 0,
                         l = count > 3 ? static_cast<int32_t>(i) ^ static_cast<int32_t>(j) : 0;
            const FieldSample found = one(q);
            CHECK(found.value == expected_number(0, i, j, k, l));
            CHECK(found.gradient == Vec3{});
            CHECK(two(q).value == expected_number(1, i, j, k, l));
            CHECK(three(q).value == expected_number(2, i, j, k, l));
        }
    }
}

TEST_CASE("hash of a place is that of its cell and of the seed behind it")
{
    const Field plane("hash(q.xy)"), plane_seed("hash2(q.xy, -5).y"), space("hash3(q).z"), space_seed("hash(q, 7)");
    for (const double size : {3.0, 1e5, 2e9})
        for (const Vec3& q : points_within(size, 100)) {
            const double i = std::floor(q[0]), j = std::floor(q[1]), k = std::floor(q[2]);
            CHECK(plane(q).value == expected_number(0, i, j));
            CHECK(plane_seed(q).value == expected_number(1, i, j, -5));
            CHECK(space(q).value == expected_number(2, i, j, k));
            CHECK(space_seed(q).value == expected_number(0, i, j, k, 7));
        }
}

TEST_CASE("hash of a cell by its whole numbers is that of the numbers, over all of their range")
{
    const std::string cell = "ivec3(q)";
    const Field plane("hash(" + cell + ".xy)"), plane_seed("hash2(" + cell + ".xy, -5).y"),
        of_three("hash3(" + cell + ".xy, 2).z"), space("hash3(" + cell + ").z"), space_seed("hash(" + cell + ", 7)"),
        of_two("hash2(" + cell + ", 1).x");
    for (const Vec3& q : points_within(2147483647, 200)) {
        const double i = std::trunc(q[0]), j = std::trunc(q[1]), k = std::trunc(q[2]);
        CHECK(plane(q).value == expected_number(0, i, j));
        CHECK(plane_seed(q).value == expected_number(1, i, j, -5));
        CHECK(of_three(q).value == expected_number(2, i, j, 2));
        CHECK(space(q).value == expected_number(2, i, j, k));
        CHECK(space_seed(q).value == expected_number(0, i, j, k, 7));
        CHECK(of_two(q).value == expected_number(0, i, j, k, 1));
    }
}

TEST_CASE("hash has the same bits in f32, in mixed precision and in the interpreter")
{
    const std::string source =
        "texture t() { vec3 q = p / 1m; return 1m * hash(int(q.x) * 104729, int(q.y) * 7919, int(q.z)); }";
    for (const auto precision : {jit::Precision::f32, jit::Precision::mixed, jit::Precision::f64}) {
        jit::TextureOptions options;
        options.precision = precision;
        const jit::CompiledTextures compiled = jit::compile_texture(source, options);
        REQUIRE(compiled.program);
        const haptel_texture& texture = compiled.program->textures()[0];
        const std::vector<double> block(texture.block_size / sizeof(double) + 1);
        ir::Interpreter<double> machine(compiled.program->module());
        for (const Vec3& place : points_within(1000, 200)) {
            haptel_point point{};
            haptel_sample sample{};
            ir::EntryInputs<double> inputs;
            for (size_t a = 0; a < 3; ++a)
                inputs.input[static_cast<size_t>(ir::Input::p_x) + a] = point.p[a] = std::round(place[a]);
            texture.height_gradient(&point, block.data(), &sample);
            const auto times = [](double x, uint32_t factor) {
                return static_cast<double>(
                    static_cast<int32_t>(static_cast<uint32_t>(static_cast<int32_t>(x)) * factor));
            };
            const double truth = expected_number(0, times(point.p[0], 104729), times(point.p[1], 7919), point.p[2]);
            CHECK(sample.height_m == truth);
            CHECK(machine.run(compiled.program->source_of(texture).body, {}, &inputs)[0].real == truth);
        }
    }
}

TEST_CASE("hash: all of 256 bins equally often, by chi-square")
{
    for (const std::string expression : {"hash(q.xy)", "hash2(q.xy).y", "hash3(q.xy).z", "hash(q.xy, 1)", "hash(q)",
                                         "hash(q + vec3(0.0, 0.0, -9.0), 3)", "hash(int(q.x) + 256 * int(q.y))",
                                         "fract(256.0 * hash(q.xy))", "hash(q.xy - 128.0)"}) {
        const std::vector<double> all = hashed(expression, 256);
        std::vector<int> bins(256);
        for (const double number : all) ++bins[static_cast<size_t>(256 * number)];
        double square = 0;
        for (const int count : bins) square += (count - 256.0) * (count - 256.0) / 256;
        CAPTURE(expression);
        CHECK(std::fabs(square - 255) < 5 * std::sqrt(2 * 255.0)); // five standard deviations
    }
}

TEST_CASE("hash: neighbours, seeds, components and what is 256 away are unrelated")
{
    const int side = 200;
    const std::vector<double> here = hashed("hash(q.xy)", side);
    for (const std::string other :
         {"hash(q.xy + vec2(1.0, 0.0))", "hash(q.xy + vec2(0.0, 1.0))", "hash(q.xy + vec2(1.0, 1.0))", "hash(q.yx)",
          "hash(q.xy + vec2(256.0, 0.0))", "hash(q.xy + vec2(0.0, 65536.0))", "hash(q.xy, 1)", "hash(q.xy, 2)",
          "hash(q.xy, -1)", "hash(q.xy, 65536)", "hash2(q.xy).y", "hash3(q.xy).z"}) {
        CAPTURE(other);
        CHECK(std::fabs(correlation(here, hashed(other, side))) < 5.0 / side);
    }
    CHECK(std::fabs(correlation(hashed("hash3(q.xy).y", side), hashed("hash3(q.xy).z", side))) < 5.0 / side);
    CHECK(correlation(here, hashed("hash3(q.xy, 0).x", side)) > 0.9); // the measure does tell
}

TEST_CASE("hash: each of the bits flips for half of all neighbours")
{
    const int side = 128;
    const std::vector<double> here = hashed("hash(q.xy)", side);
    for (const std::string other : {"hash(q.xy + vec2(1.0, 0.0))", "hash(q.xy + vec2(0.0, 1.0))", "hash(q.xy, 1)"}) {
        const std::vector<double> there = hashed(other, side);
        for (int bit = 0; bit < 24; ++bit) {
            int flipped = 0;
            for (size_t i = 0; i < here.size(); ++i) {
                const auto whole = [&](double x) { return static_cast<uint32_t>(std::ldexp(x, 24)) >> bit & 1; };
                flipped += whole(here[i]) != whole(there[i]);
            }
            CAPTURE(other, bit, flipped);
            CHECK(std::fabs(flipped - side * side / 2.0) < 5 * side / 2.0); // five standard deviations
        }
    }
}
