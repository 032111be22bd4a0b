// The first crossing of a segment: the runtime's predicates and tree against another engine with its own
// (exact_mesh.h).
#include "runtime/surface/collision.h"

#include "tests/runtime/contact/long_run.h"
#include "tests/runtime/surface/exact_mesh.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <iostream>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// Segments of all lengths. Some through vertices, edges and faces or ending on them, along edges and axes, from vertex
// to vertex, in the planes of faces; these need integers of any size. The others at random, near the surface.
class Segments {
public:
    Segments(const Surface& surface, uint64_t seed, double degenerate_share)
        : surface_(surface), random_(seed), degenerate_share_(degenerate_share)
    {
    }

    dvec3 from{0}, to{0};

    void next()
    {
        const double length = std::pow(10.0, 1 - 12 * uniform()) * Lattice::extent; // 10 to 1e-11 half extents
        const double share = uniform();
        const dvec3 a = corner();
        if (uniform() >= degenerate_share_) {
            const dvec3 aim = glm::mix(a, middle_, uniform()) + 0.3 * uniform() * length * direction();
            const dvec3 along = length * direction();
            from = lattice_point(aim - share * along);
            to = lattice_point(aim + (1 - share) * along);
            return;
        }
        const dvec3 edge = next_ - a;
        const dvec3 places[] = {a, a + uniform() * edge, middle_, 1.1 * Lattice::extent * direction()};
        const dvec3 aim = places[random_() % 4], b = corner();
        dvec3 along = direction();
        switch (random_() % 8) {
        case 0: along = dvec3(random_() % 3 == 0, random_() % 3 == 1, 1e-30); break;
        case 1: along = edge; break;
        case 2: along = b - aim; break;
        case 3: along = glm::cross(normal_, along); break;
        default: break;
        }
        if (glm::length(along) < 1e-20) along = direction();
        along = length * glm::normalize(along);
        const double part = random_() % 5 == 0 ? 0.0 : random_() % 4 == 0 ? 1.0 : share;
        from = lattice_point(aim - part * along);
        to = random_() % 16 == 0 ? lattice_point(b) : lattice_point(aim + (1 - part) * along);
    }

private:
    static dvec3 lattice_point(const dvec3& p)
    {
        return glm::clamp(glm::round(p), -Lattice::workspace, Lattice::workspace);
    }
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    dvec3 direction()
    {
        std::normal_distribution<double> normal;
        return glm::normalize(dvec3(normal(random_), normal(random_), normal(random_)));
    }
    // A vertex; its face is remembered.
    dvec3 corner()
    {
        const Face& face = surface_.faces[random_() % surface_.faces.size()];
        const uint32_t i = uint32_t(random_() % 3);
        const auto at = [&](uint32_t k) { return surface_.vertices[face.vertex[k % 3]]; };
        next_ = at(i + 1);
        middle_ = (at(0) + at(1) + at(2)) / 3.0;
        normal_ = face.normal;
        return at(i);
    }

    const Surface& surface_;
    std::mt19937_64 random_;
    double degenerate_share_;
    dvec3 next_{0}, middle_{0}, normal_{0};
};

struct Agreement {
    uint64_t segments = 0, hits = 0, different = 0;
};

Agreement compare(const Surface& surface, uint64_t count, uint64_t seed, double degenerate_share)
{
    const ExactMesh exact(surface);
    Segments segments(surface, seed, degenerate_share);
    Agreement agreement;
    for (uint64_t i = 0; i < count; ++i) {
        segments.next();
        if (segments.from == segments.to) continue;
        Crossing crossing;
        CollisionCount work;
        const bool hit = first_crossing(surface, segments.from, segments.to, StartsOn::nothing(), crossing, work);
        const std::optional<ExactMesh::Hit> truth = exact.first_crossing(segments.from, segments.to);
        ++agreement.segments;
        agreement.hits += truth.has_value();
        agreement.different +=
            hit != truth.has_value() || (hit && *truth != ExactMesh::Hit{crossing.face, crossing.side});
    }
    return agreement;
}

} // namespace

TEST_CASE("two engines find the same first crossings, on any mesh")
{
    std::vector<NamedMesh> meshes = make_hard_meshes();
    meshes.push_back({"star", make_star(2)});
    meshes.push_back({"stairs", make_stairs()});
    meshes.push_back({"plate 2e-10", make_box({1, 1, 2e-10})});
    for (const auto& [name, mesh] : meshes) {
        const Agreement agreement = compare(*surface_of(mesh), tries(1500), 23, 0.5);
        CAPTURE(name);
        CHECK(agreement.different == 0);
        CHECK(agreement.hits > tries(50u));
    }
}

// One in 64 is degenerate. HAPTEL_TEST_MESHES: files to be tried too, with ':' between; HAPTEL_TEST_SEGMENTS: for each
// mesh; HAPTEL_TEST_SEED.
TEST_CASE("two engines find the same first crossings: long run", "[.long]")
{
    std::vector<NamedMesh> meshes = make_hard_meshes();
    for (NamedMesh& read : meshes_of_environment()) meshes.push_back(std::move(read));
    const uint64_t count = number_of_environment("HAPTEL_TEST_SEGMENTS", 100000),
                   seed = number_of_environment("HAPTEL_TEST_SEED", 1);
    Agreement sum;
    for (const auto& [name, mesh] : meshes) {
        const Agreement agreement = compare(*surface_of(mesh), count, seed, 1.0 / 64);
        std::cerr << name << ": " << agreement.segments << " segments, " << agreement.hits << " hits, "
                  << agreement.different << " different" << std::endl;
        sum.segments += agreement.segments, sum.hits += agreement.hits, sum.different += agreement.different;
    }
    WARN("in all " << sum.segments << " segments, " << sum.hits << " hits, " << sum.different << " different");
    CHECK(sum.different == 0);
}
