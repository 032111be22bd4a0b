// Meshes of which everything lies in one place. What a step looks at is counted, and may grow no faster than stands
// here; beyond a limit such a mesh is refused with the reason, and building ends when it is asked to.
#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/by_number.h"
#include "runtime/surface/build/edges.h"
#include "runtime/surface/loading.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <set>
#include <string>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// Triangles that share one vertex and nothing else, spread evenly over all directions (a spiral from pole to pole).
Mesh hedgehog(int spikes)
{
    Mesh mesh;
    mesh.positions_m.push_back(dvec3(0));
    for (int k = 0; k < spikes; ++k) {
        const double z = 1 - (2 * k + 1.0) / spikes, r = std::sqrt(1 - z * z), turn = 2.399963 * k;
        const dvec3 tip(r * std::cos(turn), r * std::sin(turn), z);
        const uint32_t first = uint32_t(mesh.positions_m.size());
        mesh.positions_m.push_back(tip);
        mesh.positions_m.push_back(tip + dvec3(1, 0, 1) * (0.3 / std::sqrt(spikes)));
        mesh.triangles.push_back({0, first, first + 1});
    }
    return mesh;
}

// A flat roof round one vertex.
Mesh wheel(uint32_t spokes)
{
    Mesh mesh;
    mesh.positions_m.push_back({0, 0, 0.3});
    for (uint32_t k = 0; k < spokes; ++k) {
        const double turn = 6.283185307179586 * k / spokes;
        mesh.positions_m.push_back({std::cos(turn), std::sin(turn), 0});
        mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % spokes});
    }
    return mesh;
}

// A closed cylinder, its caps flat wheels.
Mesh cylinder(uint32_t sides)
{
    Mesh mesh;
    mesh.positions_m = {{0, 0, 0}, {0, 0, 1}};
    for (uint32_t k = 0; k < sides; ++k) {
        const double turn = 6.283185307179586 * k / sides;
        for (const double z : {0.0, 1.0}) mesh.positions_m.push_back({std::cos(turn), std::sin(turn), z});
        const uint32_t low = 2 + 2 * k, high = low + 1, low_next = 2 + 2 * ((k + 1) % sides), high_next = low_next + 1;
        mesh.triangles.push_back({0, low_next, low});
        mesh.triangles.push_back({1, high, high_next});
        mesh.triangles.push_back({low, low_next, high_next});
        mesh.triangles.push_back({low, high_next, high});
    }
    return mesh;
}

// A flat band, one triangle wide.
Mesh strip(uint32_t triangles)
{
    Mesh mesh;
    for (uint32_t k = 0; k < triangles + 2; ++k) mesh.positions_m.push_back({double(k / 2), double(k % 2), 0});
    for (uint32_t k = 0; k < triangles; ++k) mesh.triangles.push_back({k, k + 1 + k % 2, k + 2 - k % 2});
    return mesh;
}

// Pages that share their back.
Mesh book(uint32_t pages)
{
    Mesh mesh;
    mesh.positions_m = {{0, 0, 0}, {0, 0, 1}};
    for (uint32_t k = 0; k < pages; ++k) {
        const double turn = 6.283185307179586 * k / pages;
        mesh.positions_m.push_back({std::cos(turn), std::sin(turn), 0.5});
        mesh.triangles.push_back({0, 1, 2 + k});
    }
    return mesh;
}

Mesh large_soup(int triangles, double height)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> side(-1, 1);
    Mesh mesh;
    for (int t = 0; t < triangles; ++t) {
        const uint32_t first = uint32_t(mesh.positions_m.size());
        for (int i = 0; i < 3; ++i) mesh.positions_m.push_back({side(random), side(random), height * side(random)});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

size_t looks_of_fans(const Mesh& mesh)
{
    Surface surface;
    MeshReport report;
    BuildWork work(100'000'000); // as of so large a mesh: it does not end
    REQUIRE(repair(mesh, surface, report));
    link_faces(surface, Edges(surface, 0), report, 0);
    make_fans(surface, corners_by_vertex(surface), default_crease_deg, work);
    CHECK(!work.over());
    return work.looks();
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("of sheets that meet in one vertex each is looked at from each other one, and no oftener")
{
    const size_t few = looks_of_fans(hedgehog(100)), many = looks_of_fans(hedgehog(400));
    CHECK(double(many) / double(few) < 1.1 * 4 * 4);
    const SurfaceResult built = build_surface(hedgehog(400));
    REQUIRE(built.surface);
    // All of them see each other round their borders: one circle of fans round the vertex.
    const std::vector<Fan>& fans = built.surface->fans;
    std::set<uint32_t> circle;
    for (uint32_t fan = built.surface->fan_of(0, 0, 0); circle.insert(fan).second;) fan = fans[fan].next;
    CHECK(circle.size() >= 400);
    CHECK(looks_of_fans(book(5000)) == 0); // one sheet with itself
}

TEST_CASE("of thousands of triangles round one vertex as many are taken as a tick can go round; more are refused, told "
          "where to look")
{
    CHECK(build_surface(wheel(2000)).surface);
    CHECK(build_surface(book(2000)).surface);
    if (haptel::test::is_sanitized) return; // to come to the limit takes long then: large_soup() does below
    const SurfaceResult wheel_of_many = build_surface(wheel(16'000));
    CHECK(!wheel_of_many.surface);
    CHECK(contains(wheel_of_many.error, "to find which of its triangles cut each other takes more than"));
    CHECK(contains(wheel_of_many.error, "vertices that thousands of triangles share"));
    CHECK(
        contains(build_surface(hedgehog(4000)).error, "to find which of its sheets meet in a vertex takes more than"));
}

TEST_CASE("a sound mesh is taken, however long and thin its triangles are, and though all of them are at a border")
{
    for (const Mesh& mesh : {strip(haptel::test::tries(100'000u)), cylinder(haptel::test::tries(8000u))}) {
        const SurfaceResult built = build_surface(mesh);
        CAPTURE(built.error);
        REQUIRE(built.surface);
        CHECK(built.surface->faces.size() == mesh.triangles.size());
        CHECK(built.report.cracks_closed == 0);
        CHECK(built.report.pierced == 0);
    }
}

TEST_CASE("large triangles at random, in space or nearly in a plane, are refused beyond the limit")
{
    CHECK(build_surface(large_soup(300, 1)).surface);
    CHECK(build_surface(large_soup(300, 0)).surface);
    for (const double height : {1.0, 1e-7, 0.0}) {
        if (haptel::test::is_sanitized && height != 1.0) continue;
        CAPTURE(height);
        const SurfaceResult built = build_surface(large_soup(20'000, height));
        CHECK(!built.surface);
        CAPTURE(built.error);
        CHECK(contains(built.error, " takes more than 150 million steps. Take out parts"));
    }
}

TEST_CASE("a step of building counts what it looks at for each triangle, alike for small and large meshes")
{
    for (int n : {20, 80}) {
        CAPTURE(n);
        const Mesh mesh = make_plane(n);
        Surface surface;
        MeshReport report;
        BuildWork work(mesh.triangles.size());
        REQUIRE(repair(mesh, surface, report));
        const Edges edges(surface, 0);
        link_faces(surface, edges, report, 0);
        close_cracks(surface, report, work);
        make_fans(surface, corners_by_vertex(surface), default_crease_deg, work);
        surface.tree = std::make_unique<const BoxTree>(surface.vertices, surface.faces,
                                                       box_tree_of(surface.vertices, surface.faces, work.threads()),
                                                       work.threads());
        find_piercing(surface, edges, report, work);
        CHECK(double(work.looks()) < 60 * double(mesh.triangles.size()));
    }
}

TEST_CASE("building tells each of its steps, and ends in whichever it is asked to")
{
    const Mesh mesh = make_star(3);
    std::vector<std::string> told;
    Loading loading{[&](std::string_view doing) { told.emplace_back(doing); }, nullptr};
    REQUIRE(build_surface(mesh, default_crease_deg, &loading).surface);
    CHECK(told.size() >= 7);
    CHECK(std::find(told.begin(), told.end(), "which of its triangles cut each other") != told.end());

    for (size_t step = 0; step < told.size(); ++step) {
        CAPTURE(step);
        std::atomic<bool> stop = false;
        size_t steps = 0;
        loading = {[&](std::string_view) { stop = steps++ == step; }, &stop};
        const SurfaceResult ended = build_surface(mesh, default_crease_deg, &loading);
        CHECK(!ended.surface);
        CHECK(ended.error == "loading was stopped");
        CHECK(steps == step + 1); // nothing was begun after it
    }
}
