// Matrices, their derivatives and those that are derivatives; GLM computes the same.
#include "tests/lang/lower/evaluation.h"
#include "tests/support/catch.h"

#include <cmath>
#include <glm/glm.hpp>

using namespace haptel::lang::test;

TEST_CASE("lower: matrices are GLSL's, as GLM computes them")
{
    const glm::dvec3 q(0.5, -0.25, 3.0), r(2.0, 1.5, -1.0);
    Inputs at;
    at.p = {q.x, q.y, q.z};
    const std::string functions = R"(
        vec3 r() { return vec3(2.0, 1.5, -1.0); }
        mat3 a() { return mat3(p, p.yzx, 1.0, 2.0, p.x); }
        mat3 b() { return mat3(2.0) + outerProduct(r(), p); }
        mat2 c() { return mat2(p.x, 2.0, p.yz); }
        mat4 d() { return mat4(vec4(p, 1.0), vec4(1.0, r()), 5.0, p.zxy, vec4(0.25, -2.0, p.xz)); }
        mat3 stored(int i)
        {
            mat3 m = a();
            m[1] = r();
            m[i][2] = 7.0;
            m[2].yx += p.xy;
            m *= b();
            return m;
        })";
    const glm::dmat3 a(q, glm::dvec3(q.y, q.z, q.x), glm::dvec3(1, 2, q.x)),
        b = glm::dmat3(2.0) + glm::outerProduct(r, q);
    const glm::dmat2 c(q.x, 2.0, q.y, q.z);
    const glm::dmat4 d(glm::dvec4(q, 1), glm::dvec4(1, r), glm::dvec4(5, q.z, q.x, q.y),
                       glm::dvec4(0.25, -2, q.x, q.z));
    glm::dmat3 stored = a;
    stored[1] = r;
    stored[0][2] = 7;
    stored[2] += glm::dvec3(q.y, q.x, 0);
    stored *= b;

    const auto check = [&](const std::string& expression, const auto& expected) {
        for (int column = 0; column < expected.length(); ++column)
            for (int row = 0; row < expected.length(); ++row) {
                const std::string part =
                    "(" + expression + ")[" + std::to_string(column) + "][" + std::to_string(row) + "]";
                INFO(part);
                CHECK(std::fabs(value_of(part, functions, at) - expected[column][row]) <=
                      1e-14 * std::fmax(1.0, std::fabs(expected[column][row])));
            }
    };
    const auto check_vector = [&](const std::string& expression, const glm::dvec3& expected) {
        for (int row = 0; row < 3; ++row)
            CHECK(std::fabs(value_of("(" + expression + ")[" + std::to_string(row) + "]", functions, at) -
                            expected[row]) <= 1e-14);
    };
    check("a()", a);
    check("a() * b()", a * b);
    check("a() + b() - 2.0 * a() / 4.0", a + b - 2.0 * a / 4.0);
    check("a() / b()", glm::dmat3(a[0] / b[0], a[1] / b[1], a[2] / b[2]));
    check("-a()", -a);
    check("1.0 - a()", 1.0 - a);
    check("transpose(a())", glm::transpose(a));
    check("matrixCompMult(a(), b())", glm::matrixCompMult(a, b));
    check("outerProduct(p, r())", glm::outerProduct(q, r));
    check("inverse(c())", glm::inverse(c));
    check("inverse(a())", glm::inverse(a));
    check("inverse(d())", glm::inverse(d));
    check("mat3(d())", glm::dmat3(d));
    check("mat4(a())", glm::dmat4(a));
    check("mat2(3.0)", glm::dmat2(3.0));
    check("stored(0)", stored);
    check_vector("a() * r()", a * r);
    check_vector("r() * a()", r * a);
    check_values_near({{"determinant(c())", glm::determinant(c)},
                       {"determinant(a())", glm::determinant(a)},
                       {"a() == a() && a() != b() ? 1.0 : 0.0", 1.0},
                       {"a()[int(p.z) - 2][int(p.z) - 3]", a[1][0]},
                       {"a()[int(p.z)].y", a[2].y}}, // clamped to the last column
                      functions, at);
    CHECK(std::fabs(value_of("determinant(d())", functions, at) - glm::determinant(d)) <=
          1e-14 * std::fabs(glm::determinant(d)));
}

TEST_CASE("lower: derivatives of matrices, and matrices of derivatives")
{
    Inputs at;
    at.p = {0.5, -0.25, 3.0};
    const double x = 0.5, y = -0.25, z = 3.0;
    const std::string functions = R"(
        vec3 f(vec3 q) { return vec3(q.x * q.y, sin(q.z) * q.x, q.y); }
        float g(vec3 q) { return q.x * q.x * q.y + exp(q.z * q.x); }
        vec2 h(vec2 q) { return vec2(q.x * q.x, q.x * q.y); }
        float entry(float basis(vec3), vec3 q, int i, int j) { return grad(grad(basis))(q)[i][j]; }
        mat2 turn(float a) { return mat2(cos(a), sin(a), -sin(a), cos(a)); }
    )";
    // column j is the derivative by component j
    check_values_near({{"grad(f)(p)[0][0]", y},
                       {"grad(f)(p)[0][1]", std::sin(z)},
                       {"grad(f)(p)[0][2]", 0.0},
                       {"grad(f)(p)[1][0]", x},
                       {"grad(f)(p)[1][2]", 1.0},
                       {"grad(f)(p)[2][1]", x * std::cos(z)},
                       {"grad(h)(p.xy)[0].x", 2 * x},
                       {"grad(h)(p.xy)[0].y", y},
                       {"grad(h)(p.xy)[1].x", 0.0},
                       {"grad(h)(p.xy)[1].y", x},
                       {"(grad(h)(p.xy) * vec2(1.0, 0.0)).y", y},
                       {"grad(turn)(p.x)[0][1]", std::cos(x)},
                       {"grad(grad(turn))(p.x)[1][0]", std::sin(x)}},
                      functions, at);
    const double e = std::exp(z * x);
    const double hessian[3][3] = {
        {2 * y + z * z * e, 2 * x, e + x * z * e}, {2 * x, 0, 0}, {e + x * z * e, 0, x * x * e}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const std::string index = std::to_string(i) + ", " + std::to_string(j);
            INFO(index);
            CHECK(std::fabs(value_of("entry(g, p, " + index + ")", functions, at) - hessian[i][j]) <= 1e-14);
        }
    // d(inverse) = -inverse dm inverse: the derivative of the inverse by the matrix, checked through the gradient
    const Sample sample = evaluate("texture t() { mat3 m = mat3(2.0) + outerProduct(p, vec3(1.0, 2.0, 3.0)); "
                                   "return inverse(m)[1][0]; }",
                                   at);
    const glm::dvec3 u(1, 2, 3);
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(2.0) + glm::outerProduct(glm::dvec3(x, y, z), u));
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 along(0);
        along[axis] = 1;
        const glm::dmat3 derivative = -inverse * glm::outerProduct(along, u) * inverse;
        CHECK(std::fabs(sample.gradient[static_cast<size_t>(axis)] - derivative[1][0]) <= 1e-15);
    }
}
