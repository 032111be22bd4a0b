// From one object at rest to another that it meets: no step of the force that neither of them has by itself.
#include "tests/runtime/render/stroke.h"
#include "tests/support/tries.h"

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

TEST_CASE("in the corner of a floor and a wall each pushes with its own stiffness against its own depth")
{
    const Wedge wedge{90};
    for (const bool floor_first : {true, false}) {
        std::vector<SceneObject> objects = {wedge.floor(300), wedge.wall(1100)};
        if (!floor_first) std::swap(objects[0], objects[1]);
        Stroke stroke(joined(std::move(objects)), dvec3(0));
        stroke.to({-2e-3, 1e-3, 2e-3});
        for (const dvec3& place : {dvec3(1e-3, 2e-3, -2e-3), dvec3(2e-3, -3e-3, -1e-4), dvec3(1e-6, 0.01, -1e-3),
                                   dvec3(-1e-3, 0.01, -1e-3), dvec3(1e-3, 0, 1e-3), dvec3(3e-3, 0.02, -3e-3)}) {
            stroke.to(place);
            const double floor_m = std::max(0.0, -place.z), wall_m = std::max(0.0, place.x);
            CHECK(glm::distance(stroke.force_n(), dvec3(-1100 * wall_m, 0, 300 * floor_m)) < 1e-7);
            CHECK(stroke.felt().contacts == (floor_m > 0 ? 1u : 0u) + (wall_m > 0 ? 1u : 0u));
        }
    }
}

TEST_CASE("no force steps where a floor and a wall of other stiffness meet, whatever wanders there")
{
    for (const double degrees : {60.0, 90.0, 120.0, 150.0})
        for (const ProbeKind kind : every_probe)
            for (const bool floor_first : {true, false}) {
                if (haptel::test::is_sanitized && degrees != 90) continue;
                const Wedge wedge{degrees};
                std::vector<SceneObject> objects = {wedge.floor(200), wedge.wall(1500)};
                if (!floor_first) std::swap(objects[0], objects[1]);
                Stroke stroke(with_probe(joined(std::move(objects)), kind), rest_m(kind, wedge.between()));
                stroke.to(3e-3 * wedge.between());
                wander(stroke, 8e-3, 2.5e-3, 60, 7);
                CAPTURE(degrees, static_cast<int>(kind), floor_first, stroke.largest_at_m().x, stroke.largest_at_m().y,
                        stroke.largest_at_m().z);
                // What each holds changes by no more than the hand moves over the sine of the angle between them.
                const int ends = kind == ProbeKind::gripper ? 2 : 1;
                CHECK(stroke.largest_n() < 1.01 * ends * (200 + 1500) * step_m / std::sin(wedge.radians()));
                CHECK(stroke.touching() > 2000);
                CHECK(stroke.both() > 1000);
            }
}

TEST_CASE("no force steps where a floor and a wall of other texture or friction meet, nor more by friction than "
          "between the materials")
{
    constexpr double amplitude_m = 10e-6, wave_m = 4e-3, slope = 2 * std::numbers::pi * amplitude_m / wave_m,
                     bend_per_m = slope * 2 * std::numbers::pi / wave_m, depth_m = 3e-3;
    const struct {
        double floor_n_per_m, wall_n_per_m, floor_friction, wall_friction;
        bool textured;
    } materials[] = {{400, 900, 0, 0, true}, {900, 900, 0.15, 0.6, false}, {400, 900, 0.6, 0.15, false}};
    for (const double degrees : {60.0, 90.0, 120.0})
        for (const ProbeKind kind : every_probe)
            for (const auto& [floor_n_per_m, wall_n_per_m, floor_friction, wall_friction, textured] : materials) {
                if (haptel::test::is_sanitized && degrees != 90) continue;
                const Wedge wedge{degrees};
                const auto texture = [&] { return textured ? sine_texture(amplitude_m, wave_m) : TextureBinding(); };
                Stroke stroke(with_probe(joined({wedge.floor(floor_n_per_m, floor_friction, texture()),
                                                 wedge.wall(wall_n_per_m, wall_friction)}),
                                         kind),
                              rest_m(kind, wedge.between()));
                stroke.to(3e-3 * wedge.between());
                wander(stroke, 8e-3, depth_m, 60, 5);
                CAPTURE(degrees, static_cast<int>(kind), textured, floor_friction, wall_friction);
                CAPTURE(stroke.largest_at_m().x, stroke.largest_at_m().y, stroke.largest_at_m().z);
                const int ends = kind == ProbeKind::gripper ? 2 : 1;
                const double friction = std::max(floor_friction, wall_friction);
                double bound_n = (floor_n_per_m + wall_n_per_m) * step_m / std::sin(wedge.radians()) * (1 + friction);
                if (textured) bound_n *= 1 + 2 * slope + 2 * depth_m * bend_per_m;
                // Held by friction the proxy is borne by one of the two, until the other takes over at once: the step
                // is that between the materials, of stiffness or of friction.
                const double farthest_m = std::sqrt(2.0) * depth_m;
                if (friction > 0)
                    bound_n += std::abs(floor_n_per_m - wall_n_per_m) * farthest_m * (1 + friction) +
                               std::abs(floor_friction - wall_friction) * wall_n_per_m * farthest_m;
                CHECK(stroke.largest_n() < ends * bound_n);
                CHECK(stroke.both() > 1000);
            }
}

TEST_CASE("no force steps in a corner of three objects, and each pushes against its own depth")
{
    const dvec3 normals[] = {{0, 0, 1}, glm::normalize(dvec3(-1, 0.2, 0.3)), glm::normalize(dvec3(-0.3, -1, -0.2))};
    const double stiffness_n_per_m[] = {250, 1200, 600};
    const double volume = glm::dot(normals[0], glm::cross(normals[1], normals[2]));
    double bound_n = 0;
    dvec3 duals[3];
    std::vector<SceneObject> objects;
    for (int i = 0; i < 3; ++i) {
        duals[i] = glm::cross(normals[(i + 1) % 3], normals[(i + 2) % 3]) / volume;
        bound_n += stiffness_n_per_m[i] * glm::length(duals[i]) * step_m;
        const dvec3 along = glm::normalize(glm::cross(normals[i], glm::cross(duals[i], normals[i]) + dvec3(0.1)));
        objects.push_back(behind(dvec3(0), normals[i], along, stiffness_n_per_m[i]));
    }
    for (const ProbeKind kind : every_probe) {
        const dvec3 into_free = glm::normalize(duals[0] + duals[1] + duals[2]);
        const dvec3 rest = kind == ProbeKind::gripper ? 0.01 * into_free : 0.05 * into_free;
        Stroke stroke(with_probe(joined(objects), kind), rest);
        stroke.to(3e-3 * into_free);
        wander(stroke, 2.5e-3, 2.5e-3, 150, 3);
        CAPTURE(static_cast<int>(kind), stroke.largest_at_m().x, stroke.largest_at_m().y, stroke.largest_at_m().z);
        CHECK(stroke.largest_n() < 1.01 * bound_n);
        CHECK(stroke.touching() > 10000);

        stroke.to(3e-3 * into_free);
        if (kind != ProbeKind::point) continue;
        const dvec3 depths_m(1e-3, 5e-4, 2e-3);
        dvec3 hand_m(0), force_n(0);
        for (int i = 0; i < 3; ++i) {
            hand_m -= depths_m[i] * normals[i];
            force_n += stiffness_n_per_m[i] * depths_m[i] * normals[i];
        }
        stroke.to(hand_m);
        CHECK(stroke.felt().contacts == 3);
        CHECK(glm::distance(stroke.force_n(), force_n) < 1e-7);
    }
}

TEST_CASE("over a seam or a ridge between two objects the force changes as over one mesh, and by their materials")
{
    constexpr double depth_m = 1e-3;
    for (const double drop_deg : {0.0, 10.0, 40.0}) // of the second's top
        for (const auto& [k1, k2] : {std::pair{500.0, 500.0}, {300.0, 900.0}, {900.0, 300.0}})
            for (const ProbeKind kind : every_probe) {
                const double drop = glm::radians(drop_deg);
                const dvec3 along(std::cos(drop), 0, -std::sin(drop)), normal(std::sin(drop), 0, std::cos(drop));
                Stroke stroke(with_probe(joined({behind({-0.05, 0, 0}, {0, 0, 1}, {1, 0, 0}, k1),
                                                 behind(0.05 * along, normal, along, k2)}),
                                         kind),
                              rest_m(kind, {0, 0, 1}));
                const double radius_m = kind == ProbeKind::sphere ? 1e-3 : 0;
                const auto over = [&](double x_m, double deep_m) {
                    return x_m <= 0 ? dvec3(x_m, 1e-3, radius_m - deep_m)
                                    : x_m * along + dvec3(0, 1e-3, 0) + (radius_m - deep_m) * normal;
                };
                stroke.to(over(-5e-3, -1e-3));
                for (const double x_m : {-5e-3, 0.0, 5e-3, 0.0, -5e-3}) stroke.to(over(x_m, depth_m));
                CAPTURE(drop_deg, k1, k2, static_cast<int>(kind), stroke.largest_at_m().x, stroke.largest_at_m().y,
                        stroke.largest_at_m().z);
                const int ends = kind == ProbeKind::gripper ? 2 : 1;
                // A proxy that comes to a ridge slides on to the foot of the hand behind it.
                const double slides_n = std::max(k1, k2) * depth_m * std::tan(drop),
                             deepest_m = depth_m / std::cos(drop);
                CHECK(stroke.largest_n() <
                      ends * (std::abs(k1 - k2) * deepest_m + slides_n + 2 * std::max(k1, k2) * step_m));
                if (drop_deg == 0 && k1 == k2) CHECK(stroke.largest_n() < 1.01 * ends * k1 * depth_m / 10);
                CHECK(stroke.touching() > 500);
            }
}

TEST_CASE("a ball rolls over the eaves of a roof that lies on a box, whichever is written first, without a step")
{
    constexpr double radius_m = 2e-3, depth_m = 5e-4, hard = 2000;
    const dvec3 eaves(0.03, 0.007, 0), slope = glm::normalize(dvec3(-1, 0, 1));
    Mesh prism;
    for (const double y : {-0.05, 0.05})
        for (const dvec3& corner : {dvec3(-0.03, y, 0), dvec3(0.03, y, 0), dvec3(0, y, 0.03)})
            prism.positions_m.push_back(corner);
    prism.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
    for (const bool roof_first : {false, true}) {
        std::vector<SceneObject> objects = {object(make_box({0.06, 0.1, 0.04}), {glm::dmat3(1), {0, 0, -0.02}}, 1000),
                                            object(prism, {}, hard)};
        if (roof_first) std::reverse(objects.begin(), objects.end());
        Scene scene = joined(std::move(objects));
        scene.probe = {ProbeKind::sphere, 0.05, radius_m};
        Stroke stroke(scene, dvec3(0));
        const double off_m = radius_m - depth_m;
        stroke.to(eaves + dvec3(5e-3, 0, -6e-3));
        stroke.to(eaves + dvec3(off_m, 0, -6e-3));
        constexpr int turns = 100;
        for (int i = 0; i <= turns; ++i) {
            const double angle = glm::radians(45.0) * i / turns;
            stroke.to(eaves + off_m * dvec3(std::cos(angle), 0, std::sin(angle)));
        }
        stroke.to(eaves + off_m * glm::normalize(dvec3(1, 0, 1)) + 5e-3 * slope);
        CAPTURE(roof_first, stroke.largest_at_m().x, stroke.largest_at_m().z);
        CHECK(stroke.largest_n() < 3 * hard * step_m);
        CHECK(stroke.touching() > 400);
    }
}

TEST_CASE("each finger of a gripper, and each end of a stylus, has the friction of what it touches itself")
{
    constexpr double stiffness_n_per_m = 500, depth_m = 1e-3, apart_m = 0.05;
    for (const ProbeKind kind : {ProbeKind::gripper, ProbeKind::stylus}) {
        Stroke stroke(with_probe(joined({behind({-0.05, 0, 0}, {0, 0, 1}, {1, 0, 0}, stiffness_n_per_m, 0.1),
                                         behind({0.05, 0, 0}, {0, 0, 1}, {1, 0, 0}, stiffness_n_per_m, 0.8)}),
                                 kind),
                      {apart_m, 0, 0});
        stroke.to({-0.5 * apart_m, 0, 1e-3});
        stroke.to({-0.5 * apart_m, 0, -depth_m});
        stroke.to({-0.5 * apart_m, 5e-3, -depth_m});
        CHECK(stroke.felt().contacts == 2);
        const double each_n = stiffness_n_per_m * depth_m;
        CHECK(glm::distance(stroke.force_n(), dvec3(0, -(0.1 + 0.8) * each_n, 2 * each_n)) < 1e-6);
    }
}

TEST_CASE("in a shallow valley of two objects a texture reaches as deep, and damps as much, as in one mesh")
{
    constexpr double stiffness = 1000, damping = 5, below_m = 1e-4, deep_m = 3e-3;
    const TextureBinding lowered = lambda_texture(
        [](const haptel_point&, dvec3& gradient) { return gradient = dvec3(0), 0.0; }, -below_m, below_m);
    const Wedge wedge{174};
    const double half = std::cos(glm::radians(3.0)); // each normal along the way out
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus}) {
        CAPTURE(static_cast<int>(kind));
        std::vector<SceneObject> objects = {wedge.floor(stiffness, 0, lowered), wedge.wall(stiffness, 0, lowered)};
        for (SceneObject& one : objects) one.material.damping_n_s_per_m = damping;
        const Scene scene = with_probe(joined(std::move(objects)), kind);
        const dvec3 rests_m = scene.probe.radius_m / half * wedge.between();
        Stroke stroke(scene, rest_m(kind, wedge.between()));
        stroke.to(rests_m + deep_m * wedge.between());
        stroke.to(rests_m - deep_m * wedge.between());
        CHECK(stroke.felt().contacts == 2);
        const double speed_m_per_s = step_m * scene.servo.rate_hz;
        const dvec3 moving_n = (stiffness * (deep_m - below_m / half) + damping * speed_m_per_s) * wedge.between();
        CHECK(glm::distance(stroke.force_n(), moving_n) < 1e-6);
        // Little deeper than the texture, and no notch on the way there.
        const dvec3 valley_m = rests_m - 3 * below_m * wedge.between();
        stroke.to(valley_m + dvec3(-2e-3, 0, 0));
        const double before_n = stroke.largest_n();
        for (int i = 0; i < 100; ++i) stroke.to(valley_m); // until its speed is forgotten
        CHECK(stroke.largest_n() == before_n);
        const dvec3 resting_n = stiffness * (3 * below_m - below_m / half) * wedge.between();
        CHECK(glm::distance(stroke.force_n(), resting_n) < 1e-6);
    }
}
