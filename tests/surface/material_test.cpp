// Material outputs of compiled textures reach the hand.
#include "tests/surface/textured.h"

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
