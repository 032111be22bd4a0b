// Material outputs of compiled textures reach the hand.
#include "tests/surface/textured.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using tests::at;

TEST_CASE("material outputs of a texture scale friction and stiffness where the hand is")
{
    // Tape where x > 0.
    const auto program = compiled(R"(
texture taped(float grip = 2.5 in 1 .. 4, out float friction_scale, out float stiffness_scale)
{
    float tape = smoothstep(-1mm, 1mm, p.x);
    friction_scale = mix(1.0, grip, tape);
    stiffness_scale = mix(1.0, 0.6, tape);
    return 0um * p.x / 1m;
})");
    Scene scene = tests::bare_scene(tests::plane_mesh());
    SceneObject& object = scene.objects[0];
    object.material = {1000, 0, 0.4, 0.2};
    object.texture = std::make_shared<TextureSlot>(bound_for(program, "taped", *object.surface, {{"grip", "3"}}));
    Renderer renderer(tests::shared(std::move(scene)));
    for (const double start : {-0.02, 0.01}) {
        const bool on_tape = start > 0;
        renderer.tick(at(start, 0, 1e-3));
        glm::dvec3 force(0);
        for (int i = 0; i < 1000; ++i) force = renderer.tick(at(start + i * 5e-6, 0, -1e-3)).force_n;
        CHECK(std::abs(force.z - (on_tape ? 0.6 : 1.0)) < 1e-8);
        CHECK(std::abs(force.x + 0.2 * (on_tape ? 3 : 1) * force.z) < 1e-8);
        renderer.tick(at(start, 0, 2e-3));
    }
}

TEST_CASE("a texture brushes a plate: friction along its grain, across it and aslant is that of the ellipse")
{
    const auto program = compiled(R"(
texture metal(out vec3 friction_direction, out float friction_along_scale)
{
    friction_direction = vec3(2.0, 0.0, 0.0);
    friction_along_scale = 0.4;
    return 0um * p.x / 1m;
}
texture plate(float rough = 1.5 in 1 .. 4, out vec3 friction_direction, out float friction_along_scale, out float friction_scale)
{
    friction_scale = rough;
    return metal(friction_direction = friction_direction, friction_along_scale = friction_along_scale);
})");
    constexpr double depth_m = 1e-3, mu = 0.2 * 1.5;
    for (const double angle : {0.0, 0.25 * glm::pi<double>(), 0.5 * glm::pi<double>(), 2.0}) {
        Scene scene = tests::bare_scene(tests::plane_mesh());
        SceneObject& object = scene.objects[0];
        object.material = {1000, 0, 0.4, 0.2};
        object.texture = std::make_shared<TextureSlot>(bound_for(program, "plate", *object.surface));
        Renderer renderer(tests::shared(std::move(scene)));
        const glm::dvec3 v(std::cos(angle), std::sin(angle), 0);
        glm::dvec3 force(0);
        for (int i = -20; i < 2000; ++i)
            force = renderer.tick(at(i * 5e-6 * v.x, i * 5e-6 * v.y, i < 0 ? 1e-3 : -depth_m)).force_n;
        const double length = std::hypot(0.4 * v.x, v.y);
        CHECK(std::abs(force.z - 1) < 1e-8);
        CHECK(std::abs(force.x + mu * 0.16 * v.x / length) < 1e-6);
        CHECK(std::abs(force.y + mu * v.y / length) < 1e-6);
    }
}

TEST_CASE("walls that hold a ball together damp it once and are textured once, at any angle")
{
    // Two walls that rise by `slope` on both sides of x = 0. A texture that lies by `below_m` under its bound moves
    // both in by that, and their line of meeting down by below_m / cos(angle).
    constexpr double radius_m = 5e-3, below_m = 200e-6, speed_m_per_s = 0.05, damping_n_s_per_m = 2;
    const auto program = compiled("texture low() { return 200um * smoothstep(30mm, 32mm, p.x); }");
    for (const double slope : {0.02, 0.05, 1.0}) {
        constexpr double side = 0.04;
        Mesh groove;
        groove.positions_m = {{0, -side, 0},
                              {0, side, 0},
                              {side, side, slope * side},
                              {side, -side, slope * side},
                              {-side, side, slope * side},
                              {-side, -side, slope * side}};
        groove.triangles = {{0, 3, 2}, {0, 2, 1}, {0, 1, 4}, {0, 4, 5}};
        const double cosine = 1 / std::hypot(1, slope);
        const auto felt_n = [&](bool damped, bool textured, double x) {
            Scene scene = tests::bare_scene(groove);
            scene.probe = {ProbeKind::sphere, 0, radius_m};
            SceneObject& object = scene.objects[0];
            if (damped) object.material.damping_n_s_per_m = damping_n_s_per_m;
            if (textured) object.texture = std::make_shared<TextureSlot>(bound_for(program, "low", *object.surface));
            Renderer renderer(tests::shared(std::move(scene)));
            glm::dvec3 force(0);
            for (int i = 0; i <= 200; ++i) // at last 3 mm below where its centre rests
                force = renderer.tick(at(x, 1e-3, radius_m / cosine - 3e-3 + (200 - i) * 1e-3 * speed_m_per_s)).force_n;
            return force;
        };
        CAPTURE(slope);
        const glm::dvec3 bare = felt_n(false, false, 0);
        CHECK(std::abs(bare.z - 3) < 0.03);
        CHECK(std::abs((felt_n(true, false, 0) - bare).z / (damping_n_s_per_m * speed_m_per_s) - 1) < 0.01);
        CHECK(std::abs((bare - felt_n(false, true, 0)).z / (1000 * below_m / cosine) - 1) < 0.01);
        // The other wall takes over without a step.
        for (int i = -40; i < 40; ++i) {
            const double x = i * slope * 1e-4;
            CHECK(glm::distance(felt_n(true, true, x), felt_n(true, true, x + slope * 1e-4)) < 0.02 + slope * 0.3);
        }
    }
}
