// The line probe: what a point or a ball cannot feel.
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <cmath>

using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

TEST_CASE("anchors row 9: a line probe that lies on an edge feels force and torque, a point and a ball neither")
{
    constexpr double stiffness_n_per_m = 1000, length_m = 0.15, share = 1.0 / 3, depth_m = 1e-4;
    for (const ProbeKind kind : {ProbeKind::stylus, ProbeKind::point, ProbeKind::sphere}) {
        Mesh box = make_box();
        scale_to_size(box, 0.1);
        Scene scene = bare_scene(box);
        scene.probe = {kind, length_m, kind == ProbeKind::sphere ? 0.005 : 0.0};
        Renderer renderer(shared(std::move(scene)));
        // Its shaft, and not its tip, is below the edge at (0.05, y, 0.05).
        const dvec3 normal = glm::normalize(dvec3(1, 0, 1)), along = glm::normalize(dvec3(1, 0, -1));
        TickResult felt;
        for (int i = 100; i >= 0; --i) {
            const dvec3 at = dvec3(0.05, 0, 0.05) + (5e-4 * i - depth_m) * normal;
            felt = renderer.tick({at - share * length_m * along, at + (1 - share) * length_m * along});
        }
        if (kind != ProbeKind::stylus) {
            CHECK(felt.force_n == dvec3(0));
            CHECK(felt.torque_n_m == dvec3(0));
            continue;
        }
        const dvec3 force_n = stiffness_n_per_m * depth_m / (share * share + (1 - share) * (1 - share)) * normal;
        CHECK(glm::distance(felt.force_n, force_n) < 2e-3 * glm::length(force_n));     // it turns by 2e-4 rad
        const dvec3 torque_n_m = glm::cross(-(1 - share) * length_m * along, force_n); // about its tail
        CHECK(glm::distance(felt.torque_n_m, torque_n_m) < 2e-3 * glm::length(torque_n_m));
    }
}
