// What the language offers, through machine code: second derivatives, matrices, arrays and left loops agree with the
// oracle, and with closed forms where there are some.
#include "jit/check/oracle.h"
#include "jit/texture/resolver.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/folder.h"

#include <cmath>
#include <random>

using namespace haptel;
using namespace haptel::test;

namespace {

const char* const textures = R"(
float laplacian(float basis(vec3), vec3 q)
{
    mat3 hessian = grad(grad(basis))(q);
    return hessian[0][0] + hessian[1][1] + hessian[2][2];
}
float sines(vec3 q) { return sin(q.x) * sin(2.0 * q.y) * cos(q.z); }
vec3 swirl(vec3 q) { return vec3(q.y * sin(q.z), q.z * q.x, exp(-dot(q, q))); }
mat3 tilt(vec3 q) { return mat3(2.0) + outerProduct(q, sin(q)); }

texture sines_laplacian() { return 1um * laplacian(sines, p / 1mm); }
texture perlin_laplacian() { return 1um * laplacian(perlin, p / 1mm); }
texture perlin_mixed() { return 1um * grad(grad(perlin))(p / 1mm)[0][2]; }
texture dperlin_slope() { vec3 g = dperlin(p / 1mm); return 1um * dot(g, g); }
texture jacobian() { return 1um * determinant(grad(swirl)(p / 1mm)); }
texture solved() { vec3 q = p / 1mm; return 1um * dot(inverse(tilt(q)) * q, vec3(1.0, 2.0, 3.0)); }
texture window(int size = 3 in 1 .. 5)
{
    float ring[5];
    float sum = 0.0;
    for (int i = 0; i < 5; ++i) ring[i] = 0.0;
    for (int i = 0; i < 12; ++i) {
        ring[i % size] = sin(p.x / 1mm * (i + 1));
        if (ring[(i + 1) % size] > 0.9) break;
        sum += ring[i * i % size] * ring[0];
    }
    return 1um * sum;
}
)";

std::array<double, 3> random_point(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> in_box(-0.004, 0.004); // metres
    return {in_box(random), in_box(random), in_box(random)};
}

// The worst of a texture over points in a cube of 8 mm, relative to the largest that is right.
struct Worst {
    double height = 0, gradient = 0; // error against the oracle
    bool same_bits = true;           // as the interpreter's
};

Worst worst_of(const std::string& name, const std::vector<std::pair<std::string, std::string>>& parameters = {})
{
    const auto program = compiled(textures);
    TextureRequest request = request_over(0.008);
    request.parameters = parameters;
    const TextureResult bound = jit::make_binding(program, name, request, jit::For::figures);
    INFO(bound.diagnostics);
    REQUIRE(bound.binding);
    jit::Oracle oracle(program, *bound.binding);
    std::mt19937_64 random(7);
    Worst worst;
    double height_max = 0, gradient_max = 0;
    for (int i = 0; i < 200; ++i) {
        const auto p_m = random_point(random);
        const haptel_sample code = sample_at(*bound.binding, p_m);
        haptel_point point{};
        std::copy(p_m.begin(), p_m.end(), point.p);
        point.n[2] = 1;
        const haptel_sample slow = jit::interpret_sample(*program, *bound.binding, point);
        const jit::OracleSample truth = oracle.sample(point);
        CHECK(code.faults == 0);
        worst.same_bits = worst.same_bits && same(code.height_m, slow.height_m);
        worst.height = std::fmax(worst.height, std::fabs(code.height_m - truth.height_m));
        height_max = std::fmax(height_max, std::fabs(truth.height_m));
        for (size_t axis = 0; axis < 3; ++axis) {
            worst.same_bits = worst.same_bits && same(code.gradient[axis], slow.gradient[axis]);
            worst.gradient = std::fmax(worst.gradient, std::fabs(code.gradient[axis] - truth.gradient[axis]));
            gradient_max = std::fmax(gradient_max, std::fabs(truth.gradient[axis]));
        }
    }
    REQUIRE((height_max > 0 && gradient_max > 0));
    worst.height /= height_max;
    worst.gradient /= gradient_max;
    return worst;
}

} // namespace

TEST_CASE("textures made of second derivatives, matrices and arrays agree with the oracle", "[code]")
{
    for (const std::string name :
         {"sines_laplacian", "perlin_laplacian", "perlin_mixed", "dperlin_slope", "jacobian", "solved", "window"}) {
        CAPTURE(name);
        const Worst worst = worst_of(name);
        CHECK(worst.same_bits);
        CHECK(worst.height <= 1e-10);
        CHECK(worst.gradient <= 1e-10); // third derivatives, where the height holds second ones
    }
    for (const std::string size : {"1", "2", "5"}) CHECK(worst_of("window", {{"size", size}}).height <= 1e-10);
}

TEST_CASE("a Laplacian and its gradient are those of the closed form")
{
    const auto program = compiled(textures);
    const TextureResult bound = jit::make_binding(program, "sines_laplacian", request_over(0.008));
    REQUIRE(bound.binding);
    std::mt19937_64 random(3);
    for (int i = 0; i < 100; ++i) {
        const auto p_m = random_point(random);
        const double x = p_m[0] / 1e-3, y = p_m[1] / 1e-3, z = p_m[2] / 1e-3;
        const haptel_sample code = sample_at(*bound.binding, p_m);
        CHECK(std::fabs(code.height_m - -6e-6 * std::sin(x) * std::sin(2 * y) * std::cos(z)) <= 2e-20);
        const double gradient[3] = {-6e-3 * std::cos(x) * std::sin(2 * y) * std::cos(z),
                                    -12e-3 * std::sin(x) * std::cos(2 * y) * std::cos(z),
                                    6e-3 * std::sin(x) * std::sin(2 * y) * std::sin(z)};
        for (size_t axis = 0; axis < 3; ++axis) CHECK(std::fabs(code.gradient[axis] - gradient[axis]) <= 1e-15);
    }
}

TEST_CASE("files that import each other in a circle are refused with the circle, others share what they import")
{
    const Folder folder;
    folder.write("a.haptel", "import \"b.haptel\";\ntexture a() { return b(p.x); }\n");
    folder.write("b.haptel", "import \"c.haptel\";\nfloat b(float x) { return c(x); }\n");
    folder.write("c.haptel", "import \"b.haptel\";\nfloat c(float x) { return b(x); }\n");
    const std::string circle = jit::compile_texture_file(folder.file("a.haptel")).rendered();
    CHECK(contains(circle, "[import-cycle]"));
    CHECK(contains(circle, "b.haptel -> "));
    CHECK(contains(circle, "c.haptel -> "));

    folder.write("c.haptel", "float c(float x) { return 2.0 * x; }\n");
    folder.write("a.haptel", "import \"b.haptel\";\nimport \"c.haptel\";\ntexture a() { return b(p.x) + c(p.y); }\n");
    const jit::CompiledTextures both = jit::compile_texture_file(folder.file("a.haptel"));
    INFO(both.rendered());
    REQUIRE(both.program);
    const TextureResult bound = jit::make_binding(both.program, "a", request_over(0.008));
    REQUIRE(bound.binding);
    CHECK(sample_at(*bound.binding, {0.5, 0.25, 0}).height_m == 1.5);
}
