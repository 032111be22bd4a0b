// Points on a ball and a cylinder: where they are, and that their derivatives are those along the surface.
#include "tests/support/catch.h"
#include "tools/plot/plot_body.h"

#include <cmath>

using namespace haptel;
using namespace haptel::tools::plot;

namespace {

const glm::dvec3 center_m(0.01, -0.02, 0.03);
constexpr double radius_m = 0.02;

// What `values` change by between two points of a body, against what the Jacobian at the middle says.
template <int rows>
double mismatch(const double (&low)[rows], const double (&high)[rows], const double (&by_p)[rows][3],
                const glm::dvec3& step)
{
    double worst = 0;
    for (int i = 0; i < rows; ++i) {
        double expected = 0;
        for (int k = 0; k < 3; ++k) expected += by_p[i][k] * step[k];
        worst = std::max(worst, std::abs(high[i] - low[i] - expected));
    }
    return worst;
}

void check_derivatives(Body& body, const glm::dvec2& at)
{
    CAPTURE(at.x, at.y);
    const auto middle = body(center_m, radius_m, at);
    REQUIRE(middle);
    for (int axis = 0; axis < 2; ++axis) {
        constexpr double h = 1e-5;
        glm::dvec2 a = at, b = at;
        a[axis] -= h, b[axis] += h;
        const auto low = body(center_m, radius_m, a), high = body(center_m, radius_m, b);
        REQUIRE((low && high));
        const glm::dvec3 step(high->p[0] - low->p[0], high->p[1] - low->p[1], high->p[2] - low->p[2]);
        // Central differences are right to third order: h^3 by derivatives of some hundreds.
        CHECK(mismatch(low->uv, high->uv, middle->uv_dp, step) < 1e-11);
        CHECK(mismatch(low->n, high->n, middle->n_dp, step) < 1e-11);
    }
}

} // namespace

TEST_CASE("a ball and a cylinder have their points, normals and derivatives")
{
    for (const glm::dvec2& at : {glm::dvec2(0.3, 0.4), glm::dvec2(-0.5, 0.2), glm::dvec2(0.1, -0.7)}) {
        check_derivatives(on_ball, at);
        check_derivatives(on_cylinder, at);
        const auto ball = on_ball(center_m, radius_m, at), cylinder = on_cylinder(center_m, radius_m, at);
        const glm::dvec3 on_it(ball->p[0], ball->p[1], ball->p[2]);
        CHECK(std::abs(glm::distance(on_it, center_m) - radius_m) < 1e-16);
        CHECK(std::abs(ball->p[0] - center_m.x - radius_m * at.x) < 1e-16); // as seen from +z
        CHECK(std::abs(ball->p[1] - center_m.y - radius_m * at.y) < 1e-16);
        CHECK(ball->p[2] > center_m.z);
        const double x = cylinder->p[0] - center_m.x, y = cylinder->p[1] - center_m.y;
        CHECK(std::abs(std::hypot(x, y) - radius_m) < 1e-16);
        CHECK(std::abs(x - radius_m * at.x) < 1e-16); // as seen from -y, z up
        CHECK(y < 0);
        CHECK(std::abs(cylinder->p[2] - center_m.z - radius_m * at.y) < 1e-16);
        CHECK(std::abs(cylinder->uv[1] - (at.y + 1) / 2) < 1e-15);
        CHECK(std::abs(cylinder->n[0] * radius_m - x) < 1e-16);
        CHECK(cylinder->n[2] == 0);
    }
    CHECK(!on_ball(center_m, radius_m, {0.8, 0.7}));
    CHECK(on_cylinder(center_m, radius_m, {0.8, 0.7}));
    CHECK(!on_cylinder(center_m, radius_m, {0.8, 1.01}));
    CHECK(!on_cylinder(center_m, radius_m, {-1.01, 0.7}));
}
