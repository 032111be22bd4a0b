// The ideal shaft of a stylus against all triangles, in exact arithmetic.
#include "runtime/contact/stylus_contact.h"

#include "tests/runtime/render/wild_hand.h"
#include "tests/runtime/surface/exact_mesh.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

TEST_CASE("the ideal stylus crosses no triangle, however wildly the hand moves")
{
    struct Named {
        const char* name;
        Mesh mesh;
    };
    const Named meshes[] = {
        {"icosphere", make_icosphere(2)}, {"box", make_box({1, 0.6, 0.3})},     {"torus", make_torus(0.4, 24, 12)},
        {"plate", make_plane(3)},         {"bumpy ball", make_bumpy_sphere(3)}, {"star", make_star(2)},
        {"stairs", make_stairs()}};
    for (const Named& named : meshes) {
        const auto surface = surface_of(named.mesh);
        const ExactMesh exact(*surface);
        StylusContact stylus(surface), twin(surface);
        WildHand tip(*surface, 11), tail(*surface, 12);
        std::mt19937_64 random(13);
        uint64_t tracked = 0, sides = 0, crossed = 0;
        dvec3 lean(0, 0, 1);
        const int ticks = is_sanitized ? 800 : 4000;
        for (int i = 0; i < ticks; ++i) {
            const dvec3 hand_tip = tip.next();
            dvec3 hand_tail;
            if (i / 500 % 2) {
                std::normal_distribution<double> d;
                lean = glm::normalize(lean + 0.05 * dvec3(d(random), d(random), d(random)));
                hand_tail = hand_tip + 1.5 * tip.size() * lean;
            } else {
                hand_tail = tail.next();
            }
            stylus.update(hand_tip, hand_tail);
            for (const Contact& contact : stylus.contacts()) {
                sides += contact.by_shaft;
                if (!(contact.depth_m >= 0 &&
                      std::isfinite(contact.depth_m + glm::dot(contact.normal, contact.proxy_m))))
                    FAIL("not finite");
            }
            twin.update(hand_tip, hand_tail);
            REQUIRE(twin.contacts().size() == stylus.contacts().size());
            for (size_t k = 0; k < twin.contacts().size(); ++k)
                REQUIRE((twin.contacts()[k].depth_m == stylus.contacts()[k].depth_m &&
                         twin.contacts()[k].normal == stylus.contacts()[k].normal));
            const auto ideal = stylus.ideal();
            if (!ideal) continue;
            ++tracked;
            crossed += exact.first_crossing(ideal->tip, ideal->tail).has_value();
        }
        CAPTURE(named.name);
        CHECK(crossed == 0);
        CHECK(tracked > ticks * 9 / 10);
        CHECK(sides > (is_sanitized ? 20u : 100u));
    }
}
