// What stands behind scenes and their objects.
#pragma once

#include "api/texture_source.h"
#include "runtime/files/scene_text.h"
#include "runtime/scene/scene.h"

#include <haptel/scene.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace haptel {

struct Object::State {
    runtime::ObjectText text; // until the scene is built
    // Afterwards.
    std::mutex mutex;
    TextureSource textures;
    std::shared_ptr<runtime::TextureSlot> slot;
    std::optional<TextureRequest> request; // with the parameters of now
    std::unique_ptr<FollowedTexture> followed;
};

struct Scene::State {
    std::shared_ptr<const runtime::Scene> scene; // null: refused
    std::string messages;
    std::vector<std::shared_ptr<Object::State>> objects; // whose textures follow their files for as long
};

} // namespace haptel
