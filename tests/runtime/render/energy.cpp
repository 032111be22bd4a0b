// Energy of frictionless contact without texture and shading. Where the free space is convex - inside a hollow body, in
// its edges and corners - the proxy is the projection onto a convex set, and the force the gradient of half its squared
// distance times stiffness (Moreau 1965): a closed path gives nothing. Outside of a body the proxy holds on to a facet
// until it is past its edge: that may only take.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>
#include <limits>
#include <numbers>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double size_m = 0.1, press_m = 2e-3;

Scene flat_facets(Mesh mesh, const ProbeSettings& probe = {})
{
    scale_to_size(mesh, size_m);
    Scene scene = bare_scene(mesh);
    scene.objects[0].surface = build_surface(mesh, 0).surface; // every edge is a crease: no shading
    scene.probe = probe;
    return scene;
}

struct Loop {
    double work_j = 0, largest_n = 0;
    int touching = 0;

    double largest_j() const { return 0.5 * largest_n * largest_n / spring_n_per_m; }
};

// Twice around a closed curve that crosses facets, edges and corners, `out_m` from the middle on average and now and
// then out of touch; the work of the second round, by the trapezoidal rule. From `start`, which is free.
Loop around(const Scene& scene, const dvec3& start, double out_m, int steps)
{
    Renderer renderer(shared(scene));
    for (int i = 0; i < 100; ++i) renderer.tick({start, start});
    Loop loop;
    dvec3 before_m(0), before_n(0);
    for (int i = 0; i <= 2 * steps; ++i) {
        const double angle = 2 * std::numbers::pi * i / steps;
        const dvec3 direction = glm::normalize(
            dvec3(std::cos(angle), std::sin(angle) + 0.2 * std::sin(3 * angle), 0.7 * std::sin(2 * angle + 0.4)));
        const dvec3 hand_m = direction * (out_m + 1.5 * press_m * std::sin(5 * angle));
        const TickResult felt = renderer.tick({hand_m, hand_m});
        if (i > steps) {
            loop.work_j += 0.5 * glm::dot(felt.force_n + before_n, hand_m - before_m);
            loop.largest_n = std::max(loop.largest_n, glm::length(felt.force_n));
            loop.touching += felt.contacts > 0;
        }
        before_m = hand_m;
        before_n = felt.force_n;
    }
    return loop;
}

} // namespace

TEST_CASE("without friction a closed path inside a hollow body gives and takes nothing")
{
    for (const ProbeSettings& probe : {ProbeSettings{}, ProbeSettings{ProbeKind::sphere, 0.1, 0.003}})
        for (const bool is_box : {true, false}) {
            const Scene scene = flat_facets(is_box ? make_box() : make_icosphere(2), probe);
            const double out_m = (is_box ? 0.06 : 0.05) - probe.radius_m;
            const Loop coarse = around(scene, dvec3(0), out_m, 2000), fine = around(scene, dvec3(0), out_m, 32000);
            CAPTURE(int(probe.kind), is_box, coarse.work_j, fine.work_j);
            CHECK(fine.touching > 8000);
            CHECK(fine.touching < 32000);
            CHECK(fine.largest_n > spring_n_per_m * press_m);
            CHECK(std::abs(coarse.work_j) < 1e-2 * coarse.largest_j());
            CHECK(std::abs(fine.work_j) < 1e-5 * fine.largest_j());
        }
}

TEST_CASE("where sheets of one mesh pierce each other each pushes by its own depth, and a closed path gives nothing")
{
    // The planes x = 0, y = 0 and z = 0 as one mesh without common edges, vertices or symmetry.
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        const Mesh plane = plane_mesh(size_m, 3);
        const auto first = uint32_t(mesh.positions_m.size());
        for (const dvec3& p : plane.positions_m)
            mesh.positions_m.push_back(axis == 0   ? dvec3(p.z, p.x, p.y)
                                       : axis == 1 ? dvec3(p.y, p.z, p.x)
                                                   : p + dvec3(0.003, 0.004, 0));
        for (const auto& t : plane.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::stylus}) {
        Scene scene = bare_scene(mesh);
        scene.probe = {kind, 0.1};
        const auto touched = shared(std::move(scene));
        for (const dvec3& across : {dvec3(1, -1, 0), dvec3(1, 0, -1), dvec3(1, 1, -2), dvec3(2, -1, -1)}) {
            Renderer renderer(touched);
            const dvec3 tail(0.02);
            renderer.tick({dvec3(2e-3), dvec3(2e-3) + tail});
            const dvec3 one = glm::normalize(across), other = glm::normalize(glm::cross(one, dvec3(1)));
            double work_j = 0, worst_n = 0;
            int touching[4] = {};
            dvec3 before_m(0), before_n(0);
            for (int i = 0; i <= 40000; ++i) {
                const double angle = 2 * std::numbers::pi * i / 20000;
                const dvec3 hand = -2e-4 * dvec3(1) + 2e-3 * (std::cos(angle) * one + std::sin(angle) * other);
                const TickResult felt = renderer.tick({hand, hand + tail});
                const dvec3 expected = spring_n_per_m * glm::max(dvec3(0), -hand);
                worst_n = std::max(worst_n, glm::length(felt.force_n - expected));
                if (i > 20000) work_j += 0.5 * glm::dot(felt.force_n + before_n, hand - before_m);
                ++touching[(hand.x < 0) + (hand.y < 0) + (hand.z < 0)];
                before_m = hand, before_n = felt.force_n;
            }
            CAPTURE(int(kind), across.x, across.y, across.z, work_j);
            CHECK(touching[2] > 5000);
            CHECK(worst_n < 1e-6);
            CHECK(std::abs(work_j) < 1e-9);
        }
    }
}

TEST_CASE("without friction a closed path outside of a faceted body gives nothing, whatever it takes")
{
    double taken_before_j = std::numeric_limits<double>::infinity();
    for (const uint32_t subdivisions : {2u, 3u, 4u, 5u}) {
        const Scene scene = flat_facets(make_icosphere(subdivisions));
        const Loop loop = around(scene, dvec3(0.07, 0.001, 0.002), 0.048, 16000);
        CAPTURE(subdivisions, loop.work_j);
        CHECK(loop.touching > 4000);
        CHECK(loop.work_j < 1e-4 * loop.largest_j());
        CHECK(-loop.work_j < taken_before_j); // the finer the facets, the less
        taken_before_j = -loop.work_j;
    }
}
