// Forces of a program's own loop, against closed forms.
#include "tests/api/scenes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <limits>

using namespace haptel;
using namespace haptel::test;

TEST_CASE("renderer: a table is a spring, and nothing in the air")
{
    Renderer renderer{table()};
    REQUIRE(renderer);
    CHECK(renderer.tick({.tip_m = {0, 0, 1e-3}}).force_n.z == 0);
    const Force force = renderer.tick({.tip_m = {0, 0, -2e-3}});
    CHECK(std::fabs(force.force_n.z - 500 * 2e-3) < 1e-9); // K d
    CHECK(std::fabs(force.depth_m - 2e-3) < 1e-12);
    CHECK(force.contacts == 1);
    renderer.between_ticks();
    CHECK(std::fabs(renderer.tick({.tip_m = {0, 0, -0.05}}).force_n.z - 7) < 1e-12); // the scene's limit
}

TEST_CASE("renderer: friction holds up to its share of the force, and a placed ball lies where it was put")
{
    SceneBuilder build;
    build.add(icosphere(0.1), frictionless).place({.position_m = {0.3, 0, 0}, .rotation_deg = {0, 0, 90}});
    build
        .add(box({0.1, 0.1, 0.1}),
             {.stiffness_n_per_m = 500, .damping_n_s_per_m = 0, .static_friction = 0.5, .dynamic_friction = 0.5})
        .place({.rotation_deg = {0, 45, 0}});
    const Scene scene = build.finish({.force_rise_s = 0});
    REQUIRE(scene);
    Renderer renderer{scene};
    renderer.tick({.tip_m = {0.3, 0, 0.06}});
    const Force up = renderer.tick({.tip_m = {0.3, 0, 0.0485}});
    CHECK(std::fabs(up.force_n.z - 500 * 1.5e-3) < 5e-3); // the facets stand for a ball of 50 mm
    CHECK(std::fabs(up.force_n.x) < 5e-3);

    // A face of the turned box, 50 mm from the middle along (1, 0, 1).
    const double s = std::sqrt(0.5);
    const auto beside = [&](double out_m, double along_m) {
        return Pose{.tip_m = {s * (0.05 + out_m + along_m), 0, s * (0.05 + out_m - along_m)}};
    };
    Renderer on_box{scene};
    on_box.tick(beside(1e-3, 0));
    on_box.tick(beside(-2e-3, 0));
    const Force pulled = on_box.tick(beside(-2e-3, 20e-3));
    const double normal_n = s * (pulled.force_n.x + pulled.force_n.z),
                 along_n = s * (pulled.force_n.x - pulled.force_n.z);
    CHECK(std::fabs(normal_n - 1) < 1e-6);
    CHECK(std::fabs(along_n + 0.5) < 1e-6);
}

TEST_CASE("renderer: a pose that is not finite has no force, and one of a refused scene says why")
{
    Renderer renderer{table()};
    renderer.tick({.tip_m = {0, 0, -1e-3}});
    const Force none = renderer.tick({.tip_m = {0, std::numeric_limits<double>::quiet_NaN(), 0}});
    CHECK(none.force_n.z == 0);
    CHECK(none.faults != 0);

    SceneBuilder build;
    Renderer refused{build.finish()};
    CHECK(!refused);
    CHECK(contains(refused.messages(), "a scene needs something to touch"));
    CHECK(refused.tick({.tip_m = {0, 0, -1e-3}}).force_n.z == 0);
}
