#include "tools/commands/explore_textures.h"

#include "jit/live/live_texture.h"
#include "jit/texture/resolver.h"

#include <utility>

namespace haptel::tools {

struct ExploreTextures::Watcher {
    Watcher(TextureRequest request, jit::LiveCallbacks callbacks) : texture(std::move(request), std::move(callbacks)) {}
    jit::LiveTexture texture;
};

ExploreTextures::ExploreTextures() = default;
ExploreTextures::~ExploreTextures() = default;

TextureResolver ExploreTextures::resolver()
{
    return [this, compile = jit::make_resolver()](const TextureRequest& request) {
        TextureResult result = compile(request);
        if (result.binding) compiled_.fetch_add(1, std::memory_order_relaxed);
        return result;
    };
}

void ExploreTextures::watch(const runtime::Scene& scene)
{
    watchers_.clear();
    for (const runtime::SceneObject& object : scene.objects) {
        if (!object.request) continue;
        jit::LiveCallbacks callbacks;
        callbacks.publish = [this, name = object.request->reference, slot = object.texture](TextureBinding binding) {
            compiled_.fetch_add(1, std::memory_order_relaxed);
            const std::string fault = slot->publish(std::move(binding));
            say(fault.empty() ? name + ": reloaded\n" : name + ": not used: " + fault + "\n");
        };
        callbacks.report = [this](std::string_view diagnostics) { say(std::string(diagnostics)); };
        watchers_.push_back(std::make_unique<Watcher>(*object.request, std::move(callbacks)));
    }
}

std::string ExploreTextures::take_messages()
{
    const std::lock_guard lock(messages_mutex_);
    return std::exchange(messages_, {});
}

void ExploreTextures::say(const std::string& message)
{
    const std::lock_guard lock(messages_mutex_);
    messages_ += message;
}

} // namespace haptel::tools
