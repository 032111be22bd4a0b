// The textures of a scene, compiled, and compiled again whenever their files change.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/scene/scene.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace haptel::tools {

class ExploreTextures {
public:
    ExploreTextures();
    ~ExploreTextures(); // stops watching

    // For load_scene: compiles, and counts.
    TextureResolver resolver();

    // From now on every edit of a texture's file reaches its object's slot, or leaves a message why not. Of several
    // scenes, one after the other, the last is watched; one thread may call this at a time.
    void watch(const runtime::Scene& scene);

    // What there is to say since the last call, ready to print; empty: nothing.
    std::string take_messages();

    uint64_t compiled() const { return compiled_.load(std::memory_order_relaxed); }

private:
    struct Watcher;

    void say(const std::string& message);

    std::atomic<uint64_t> compiled_{0};
    std::mutex messages_mutex_;
    std::string messages_;
    std::vector<std::unique_ptr<Watcher>> watchers_;
};

} // namespace haptel::tools
