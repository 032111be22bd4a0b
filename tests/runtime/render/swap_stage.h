// A hand in a scene that another one takes the place of.
#pragma once

#include "runtime/render/renderer.h"
#include "runtime/render/renderer_slot.h"
#include "tests/support/touch_scenes.h"

#include <memory>

namespace haptel::tests {

inline constexpr double rise_s = 0.1;

inline runtime::Scene plane_scene(double stiffness_n_per_m = 1000)
{
    runtime::Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material.stiffness_n_per_m = stiffness_n_per_m;
    scene.servo.force_rise_s = rise_s;
    return scene;
}

// The same objects, their surfaces included.
inline runtime::Scene same_as(const runtime::Scene& scene)
{
    runtime::Scene copy = scene;
    for (runtime::SceneObject& object : copy.objects) object.texture = std::make_shared<runtime::TextureSlot>();
    return copy;
}

// A servo's renderer and its slot, ticked by the test.
struct Stage {
    runtime::RendererSlot slot;
    std::unique_ptr<runtime::Renderer> renderer;

    explicit Stage(const std::shared_ptr<const runtime::Scene>& scene, const runtime::HandSettings& hand = {})
        : slot(scene, hand), renderer(std::make_unique<runtime::Renderer>(scene, hand))
    {
    }
    runtime::TickResult tick(const runtime::DevicePose& pose)
    {
        slot.take(renderer);
        return renderer->tick(pose);
    }
    runtime::TickResult press(double z, int ticks)
    {
        runtime::TickResult result;
        for (int i = 0; i < ticks; ++i) result = tick(at(0.01, 0.02, z));
        return result;
    }
};

} // namespace haptel::tests
