// Magnets of objects that are joined with what the hand presses on.
#include "tests/runtime/render/stroke.h"

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

TEST_CASE("a magnet beside what the hand presses on pulls without a step, and a closed path gives nothing")
{
    constexpr double stiffness = 1000;
    constexpr Magnet magnet{1, 5e-3};
    for (const double degrees : {60.0, 90.0, 120.0, 180.0})
        for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere})
            for (const bool back : {false, true}) {
                const Wedge wedge{degrees};
                std::vector<SceneObject> objects = {wedge.floor(stiffness), wedge.wall(stiffness)};
                objects[1].effects.magnet = magnet;
                Stroke stroke(with_probe(joined(std::move(objects)), kind), dvec3(0));
                const dvec3 up = {-std::cos(wedge.radians()), 0, std::sin(wedge.radians())};
                std::vector<dvec3> corners = {{-12e-3, 0, 8e-3},
                                              {-12e-3, 0, -2e-3},
                                              -2.5e-3 * wedge.between(),
                                              12e-3 * up - 1e-3 * wedge.wall_normal(),
                                              12e-3 * up + 8e-3 * wedge.wall_normal(),
                                              {-12e-3, 0, 8e-3}};
                if (back) std::reverse(corners.begin(), corners.end());
                for (const dvec3& corner : corners) stroke.to(corner);
                CAPTURE(degrees, static_cast<int>(kind), back, stroke.given_j(), stroke.largest_n());
                CHECK(stroke.largest_n() < 1.001 * stiffness * step_m); // the springs' alone
                // By the tick that the aim is behind; a spring whose force waits for the next tick gives 20 times that.
                CHECK(std::abs(stroke.given_j()) < 2e-3 * 2 / 3 * magnet.force_n * magnet.reach_m);
                CHECK(stroke.touching() > 500);
            }
}

TEST_CASE("a magnet under an edge, or in a groove, of what the hand presses on gives nothing on closed paths")
{
    constexpr double stiffness = 1000, tick_m = 5e-6; // what the tick gives that the aim is behind falls with it
    constexpr Magnet magnet{1, 5e-3};
    for (const double degrees : {60.0, 90.0, 250.0, 290.0}) // grooves and ridges
        for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere}) {
            const Wedge wedge{degrees};
            const bool is_groove = degrees < 180;
            std::vector<SceneObject> objects = {wedge.floor(stiffness), wedge.wall(stiffness)};
            if (is_groove) { // its edge looks out of the bottom
                objects.push_back(
                    object(make_box({2e-3, 0.1, 2e-3}), {glm::dmat3(1), -2e-4 * wedge.between()}, stiffness));
            } else { // it cuts the ridge off below
                objects.push_back(behind(-3e-3 * wedge.between(), -wedge.between(), glm::dvec3(0, 1, 0), stiffness));
            }
            objects[2].effects.magnet = magnet;
            const Scene scene = with_probe(joined(std::move(objects)), kind);
            std::mt19937_64 random(11);
            std::uniform_real_distribution<double> uniform(-1, 1);
            double worst_j = 0;
            int touching = 0;
            for (int path = 0; path < test::tries(10); ++path) {
                Stroke stroke(scene, dvec3(0), tick_m);
                stroke.to(12e-3 * wedge.between());
                for (int i = 0; i < 6; ++i)
                    stroke.to({5e-3 * uniform(random), 2e-3 * uniform(random), 5e-3 * uniform(random)});
                stroke.to(12e-3 * wedge.between());
                worst_j = std::max(worst_j, stroke.given_j());
                touching += stroke.touching();
            }
            CAPTURE(degrees, static_cast<int>(kind), worst_j, touching);
            CHECK(touching > test::tries(20'000));
            CHECK(worst_j < 2e-3 * magnet.force_n * magnet.reach_m);
        }
}

TEST_CASE("a magnet between a hard object and a soft one pulls without a step")
{
    constexpr Magnet magnet{1, 5e-3};
    for (const double softness : {1.0, 3.0})
        for (const double degrees : {60.0, 90.0, 120.0, 180.0})
            for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere}) {
                constexpr double stiffness = 1000;
                const Wedge wedge{degrees};
                std::vector<SceneObject> objects = {wedge.floor(stiffness), wedge.wall(stiffness / softness)};
                objects[1].effects.magnet = magnet;
                Stroke stroke(with_probe(joined(std::move(objects)), kind), dvec3(0));
                const dvec3 up = {-std::cos(wedge.radians()), 0, std::sin(wedge.radians())};
                for (const dvec3& corner :
                     {dvec3(-12e-3, 0, 8e-3), dvec3(-12e-3, 0, -2e-3), -2.5e-3 * wedge.between(),
                      12e-3 * up - 1e-3 * wedge.wall_normal(), 12e-3 * up + 8e-3 * wedge.wall_normal()})
                    stroke.to(corner);
                CAPTURE(softness, degrees, static_cast<int>(kind), stroke.largest_n(), stroke.given_j());
                CHECK(stroke.largest_n() < 1.1 * stiffness * step_m);
                CHECK(stroke.touching() > 500);
            }
}
