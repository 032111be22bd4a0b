#include "runtime/render/renderer.h"
#include "api/conversions.h"
#include "api/scene_state.h"

#include <haptel/renderer.h>

#include <optional>
#include <utility>

namespace haptel {

struct Renderer::State {
    std::shared_ptr<const Scene::State> scene; // whose textures go on following their files
    std::optional<runtime::Renderer> renderer;
    std::string messages;
};

Renderer::Renderer(const Scene& scene) : state_(std::make_unique<State>())
{
    if (!scene) {
        state_->messages = scene.messages();
        return;
    }
    state_->scene = scene.share();
    state_->renderer.emplace(scene.state().scene);
    state_->messages = state_->renderer->refused();
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Renderer::operator bool() const
{
    return state_->renderer && state_->messages.empty();
}

const std::string& Renderer::messages() const
{
    return state_->messages;
}

Force Renderer::tick(const Pose& pose, uint64_t periods) noexcept
{
    if (!state_->renderer) return {};
    runtime::DevicePose there;
    there.tip_m = to_glm(pose.tip_m);
    there.tail_m = to_glm(pose.tail_m);
    there.periods = periods;
    const runtime::TickResult result = state_->renderer->tick(there);
    Force force;
    force.force_n = from_glm(result.force_n);
    force.torque_n_m = from_glm(result.torque_n_m);
    force.grip_force_n = result.grip_force_n;
    force.contacts = result.contacts;
    force.depth_m = result.depth_m;
    force.height_m = result.height_m;
    force.faults = result.faults;
    return force;
}

void Renderer::between_ticks() noexcept
{
    if (state_->renderer) state_->renderer->between_ticks();
}

} // namespace haptel
