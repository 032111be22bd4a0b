#include "runtime/texture/shading.h"

#include "runtime/contact/walk_contact.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

double degrees_between(const dvec3& a, const dvec3& b)
{
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

dvec3 point_at(const Surface& s, uint32_t face, const dvec3& w)
{
    return w.x * s.vertex_m(face, 0) + w.y * s.vertex_m(face, 1) + w.z * s.vertex_m(face, 2);
}

} // namespace

TEST_CASE("the shading normal of an icosphere is the sphere's")
{
    Mesh mesh = make_icosphere(4);
    for (dvec3& p : mesh.positions_m) p *= 2.0;
    const auto s = surface_of(mesh);
    REQUIRE(s->faces.size() == 5120);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    double worst = 0, worst_facet = 0;
    for (int i = 0; i < 20000; ++i) {
        const uint32_t face = uint32_t(random() % s->faces.size());
        dvec3 w(uniform(random), uniform(random), uniform(random));
        w /= w.x + w.y + w.z;
        const dvec3 truth = glm::normalize(point_at(*s, face, w));
        worst = std::max(worst, degrees_between(shading_normal(*s, face, 0, w), truth));
        worst_facet = std::max(worst_facet, degrees_between(s->facet_normal(face), truth));
        CHECK(shading_normal(*s, face, 1, w) == -shading_normal(*s, face, 0, w));
    }
    CHECK(worst < 1e-6);      // by weights that are right on any ball
    CHECK(worst_facet > 1.0); // what shading is for
}

TEST_CASE("the shading normal is continuous over edges and changes little along a stroke")
{
    const auto s = surface_of(make_bumpy_sphere(3));
    for (uint32_t f = 0; f < s->faces.size(); ++f)
        for (uint32_t e = 0; e < 3; ++e) {
            const SideEdge link = s->faces[f].link[e][0];
            dvec3 here(0), there(0);
            here[int(e)] = 0.3, here[int((e + 1) % 3)] = 0.7;
            const bool same_way = s->faces[link.face()].vertex[link.edge()] == s->faces[f].vertex[e];
            there[int(link.edge())] = same_way ? 0.3 : 0.7, there[int((link.edge() + 1) % 3)] = same_way ? 0.7 : 0.3;
            CHECK(glm::length(shading_normal(*s, f, 0, here) - shading_normal(*s, link.face(), link.side(), there)) <
                  1e-14);
        }

    Mesh sphere = make_icosphere(4);
    for (dvec3& p : sphere.positions_m) p *= 2.0; // radius 1 m
    const auto smooth = surface_of(sphere);
    WalkContact contact(smooth);
    dvec3 before(0);
    double worst_change = 0, worst = 0;
    for (int i = 0; i < 20000; ++i) { // 0.1 m/s at 1 kHz, 3 mm deep
        const double angle = 1e-4 * i;
        const dvec3 d = glm::normalize(dvec3(std::cos(angle), std::sin(angle), 0.3 * std::sin(0.7 * angle) + 0.1));
        if (i == 0) contact.update(1.1 * d);
        const Contact& touch = contact.update(0.997 * d);
        REQUIRE(touch.touching);
        const dvec3 normal = shading_normal(*smooth, touch.face, touch.side, touch.barycentric);
        worst = std::max(worst, degrees_between(normal, d));
        if (i > 0) worst_change = std::max(worst_change, degrees_between(normal, before));
        before = normal;
    }
    CHECK(worst < 1.0);
    CHECK(worst_change < 0.1);
}

TEST_CASE("derivatives of normal and uv along the facet agree with differences of their values")
{
    const auto s = surface_of(make_torus(0.4, 24, 12));
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0.2, 1);
    for (int i = 0; i < 500; ++i) {
        const uint32_t face = uint32_t(random() % s->faces.size());
        dvec3 w(uniform(random), uniform(random), uniform(random));
        w /= w.x + w.y + w.z;
        const uint32_t side = i % 2;
        const Shading shading = shade(*s, face, side, w);
        CHECK(shading.normal == shading_normal(*s, face, side, w));

        // A step within the facet moves the weights by known amounts.
        const dvec3 change = dvec3(1, -0.4, -0.6) * 1e-6;
        const dvec3 step = point_at(*s, face, w + change) - point_at(*s, face, w - change);
        const Shading ahead = shade(*s, face, side, w + change), behind = shade(*s, face, side, w - change);
        const double length = glm::length(step);
        CHECK(glm::length(shading.normal_dp * step - (ahead.normal - behind.normal)) < 1e-7 * length + 1e-15);
        CHECK(glm::length(shading.uv_dp * step - (ahead.uv - behind.uv)) < 1e-7 * length + 1e-15);
        // Across the facet nothing changes.
        CHECK(glm::length(shading.normal_dp * s->facet_normal(face)) < 1e-9);
        CHECK(glm::length(shading.uv_dp * s->facet_normal(face)) < 1e-9);
    }
}

TEST_CASE("where vertex normals cancel the facet's normal is felt")
{
    // A single triangle folded flat onto a copy that shares one edge: the fans at the free corners are single faces.
    Mesh mesh;
    mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.9, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    const auto s = surface_of(mesh);
    for (uint32_t face = 0; face < 2; ++face)
        for (uint32_t side = 0; side < 2; ++side)
            for (const dvec3& w : {dvec3(0.5, 0.5, 0), dvec3(0.3, 0.3, 0.4), dvec3(1, 0, 0)}) {
                const Shading shading = shade(*s, face, side, w);
                CHECK(std::abs(glm::length(shading.normal) - 1) < 1e-12);
                CHECK(std::isfinite(glm::length(shading.normal_dp[0]) + glm::length(shading.normal_dp[1])));
            }
}

// A mean of three equal numbers is that number; computed from rounded weights it is a little less or more.
TEST_CASE("the range of coordinates of a mesh holds what is computed from them, and hardly more")
{
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const glm::dvec2 everywhere : {glm::dvec2(0.1, -0.1), glm::dvec2(1.0 / 3, 7.7e5), glm::dvec2(-3e-9, 0)}) {
        Mesh mesh = make_plane(2);
        for (auto& uv : mesh.uv) uv = everywhere;
        const auto s = surface_of(mesh);
        const haptel::UvFigures range = uv_figures(*s);
        int below = 0, above = 0;
        for (int i = 0; i < 5000; ++i) {
            dvec3 w(uniform(random), uniform(random), uniform(random));
            w /= w.x + w.y + w.z;
            const glm::dvec2 uv = shade(*s, uint32_t(random() % s->faces.size()), 0, w).uv;
            for (int k = 0; k < 2; ++k) {
                CHECK((uv[k] >= range.minimum[k] && uv[k] <= range.maximum[k]));
                below += uv[k]<everywhere[k], above += uv[k]> everywhere[k];
            }
        }
        CHECK((below > 100 && above > 100)); // or nothing was rounded
        for (int k = 0; k < 2; ++k) CHECK(range.maximum[k] - range.minimum[k] <= 1e-11 * std::abs(everywhere[k]));
    }
}
