// The region that a tree is asked for the triangles that a shaft may meet: it loses none.
#include "runtime/surface/swept_region.h"
#include "runtime/contact/stylus_contact.h"
#include "runtime/servo/allocation_count.h"

#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

TEST_CASE("all triangles that a moving shaft can meet are visited, each once")
{
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const Mesh& mesh : {make_star(3), make_box(), make_torus(), make_plane(9)}) {
        const auto s = surface_of(mesh);
        int met = 0, spared = 0;
        for (int i = 0; i < tries(1000); ++i) {
            const double length = 2 * std::pow(10.0, -3 * uniform(random)) * Lattice::extent;
            const auto anywhere = [&](double size) {
                return size * dvec3(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
            };
            const dvec3 tip = anywhere(2 * Lattice::extent), tail = i % 9 ? tip + anywhere(2 * length) : tip,
                        tip_after = tip + anywhere(length), tail_after = tail + anywhere(length);
            std::vector<uint32_t> visited;
            const SweptRegion region(tip, tail, tip_after, tail_after, 0);
            CHECK(s->tree->for_each(region, [&](uint32_t face) {
                visited.push_back(face);
                return true;
            }));
            CHECK(region.is_empty(*s->tree) == visited.empty());
            std::sort(visited.begin(), visited.end());
            CHECK(std::adjacent_find(visited.begin(), visited.end()) == visited.end());
            spared += visited.size() < s->faces.size();

            // A triangle is met if the shaft crosses it at some time on its way.
            for (int step = 0; step <= 10; ++step) {
                const dvec3 from = glm::round(glm::mix(tip, tip_after, step / 10.0)),
                            to = glm::round(glm::mix(tail, tail_after, step / 10.0));
                for (uint32_t f = 0; f < s->faces.size(); ++f) {
                    const auto& corners = s->faces[f].vertex;
                    Crossing crossing;
                    crossing.face = f;
                    if (!crosses(from, to, s->vertices[corners[0]], s->vertices[corners[1]], s->vertices[corners[2]],
                                 crossing))
                        continue;
                    ++met;
                    CHECK(std::binary_search(visited.begin(), visited.end(), f));
                    CHECK(region.meets(*s, f));
                    // A part of the way meets nothing that the whole does not.
                    const SweptRegion part(glm::round(tip), glm::round(tail), from, to, 0);
                    CHECK(part.meets(*s, f));
                }
            }
        }
        CAPTURE(met, spared);
        CHECK(met > (is_sanitized ? 0 : 100));
        CHECK(spared > tries(600));
    }
}

TEST_CASE("a stylus makes no tree of its own")
{
    const auto s = surface_of(make_icosphere(4));
    const uint64_t before = allocations_of_this_thread();
    const StylusContact stylus(s);
    CHECK(allocations_of_this_thread() - before == 14); // its ends, and for each of them six lists of what is around it
}
