#include "runtime/surface/in_parallel.h"
#include "runtime/surface/loading.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/runtime/surface/same_surface.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>

using namespace haptel::runtime;
using namespace haptel::test;

TEST_CASE("each part is done once, on any number of threads, and what one throws reaches who waits for them")
{
    for (const unsigned threads : {0u, 1u, 2u, 7u}) {
        CAPTURE(threads);
        std::vector<std::atomic<int>> done(1000);
        in_parallel(done.size(), threads, [&](std::size_t part) { ++done[part]; });
        for (const auto& times : done) REQUIRE(times == 1);
        std::vector<int> seen(3 * items_per_piece + 5);
        in_pieces(seen.size(), threads, [&](std::size_t begin, std::size_t end, std::size_t piece) {
            for (std::size_t i = begin; i < end; ++i) seen[i] += 1 + int(piece);
        });
        CHECK(std::accumulate(seen.begin(), seen.end(), 0) == int(items_per_piece) * (1 + 2 + 3) + 5 * 4);
        CHECK_THROWS_AS(in_parallel(50, threads,
                                    [](std::size_t part) {
                                        if (part == 20) throw std::runtime_error("part 20");
                                    }),
                        std::runtime_error);
        in_parallel(0, threads, [](std::size_t) { FAIL(); });
    }
}

// Of several pieces each: with creases, borders, T-junctions, edges of many faces, sheets that meet in vertices, parts
// that cut each other.
TEST_CASE("a surface is the same to the last bit on any number of threads")
{
    std::vector<NamedMesh> meshes = make_hard_meshes();
    const uint32_t fine = haptel::test::is_sanitized ? 5 : 6;
    meshes.push_back({"bumpy sphere", make_bumpy_sphere(fine)});
    meshes.push_back({"star", make_star(fine)});
    meshes.push_back({"plane", make_plane(150)});
    meshes.push_back({"torus", make_torus(0.4, haptel::test::tries(400), 100)});
    meshes.push_back({"touching cubes", make_touching_cubes(Touching::corners)});
    for (const auto& [name, mesh] : meshes) {
        CAPTURE(name);
        Loading loading;
        loading.threads = 1;
        const SurfaceResult alone = build_surface(mesh, 40, &loading);
        for (const unsigned threads : {2u, 7u}) {
            loading.threads = threads;
            const SurfaceResult built = build_surface(mesh, 40, &loading);
            REQUIRE(!built.surface == !alone.surface);
            CHECK(built.error == alone.error);
            if (!alone.surface) continue;
            CHECK(first_difference(*built.surface, *alone.surface) == "");
            CHECK((same_bits(built.report, alone.report)));
        }
    }
}

TEST_CASE("what a surface is built for is told by the thread that loads alone")
{
    const auto loads = std::this_thread::get_id();
    std::atomic<int> told = 0, elsewhere = 0;
    Loading loading{[&](std::string_view) { ++(std::this_thread::get_id() == loads ? told : elsewhere); }};
    loading.threads = 7;
    REQUIRE(build_surface(make_bumpy_sphere(haptel::test::is_sanitized ? 6 : 7), 40, &loading).surface);
    CHECK(told >= 7);
    CHECK(elsewhere == 0);
}
