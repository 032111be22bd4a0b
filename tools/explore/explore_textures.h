// The textures of a scene, compiled, and compiled again whenever their files change; and their parameters, which may be
// set meanwhile.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/scene/scene.h"
#include "tools/control/controlled.h"

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

    // Of an object of the scene that is watched, by its number from 1: what was set lasts until another scene is.
    // Nothing is compiled: the object's slot has the value as soon as the compile thread is free. Any thread.
    ControlAnswer set(uint32_t object, const std::string& parameter, const std::string& value);
    // All parameters of the texture, but pictures, as a texture of its file has them that has the same: a preset, or
    // itself.
    ControlAnswer choose_preset(uint32_t object, const std::string& name);
    // Those of the scene that is watched, with the values that were set last, and another number when that changes.
    std::vector<ControlledObject> controlled() const;
    uint64_t version() const { return version_.load(std::memory_order_acquire); }

    // What there is to say since the last call, ready to print; empty: nothing.
    std::string take_messages();

    uint64_t compiled() const { return compiled_.load(std::memory_order_relaxed); }

private:
    struct Watcher;

    void say(const std::string& message);
    Watcher* watcher_of(uint32_t object, std::string& refused) const; // under watchers_mutex_

    std::atomic<uint64_t> compiled_{0}, version_{1};
    std::mutex messages_mutex_;
    std::string messages_;
    mutable std::mutex watchers_mutex_; // not held while one is made or destroyed
    std::vector<std::unique_ptr<Watcher>> watchers_;
    std::vector<std::string> names_; // of all objects of the scene
};

} // namespace haptel::tools
