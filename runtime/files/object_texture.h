// The texture of an object in a scene file: its two keys, and what is asked of whoever makes textures.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/files/table_reader.h"
#include "runtime/scene/scene.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace haptel::runtime {

struct TextureText {
    std::string reference; // empty: none
    std::vector<std::pair<std::string, std::string>> parameters;
    toml::source_region at;
};

// What bounds the detail that hands can feel.
struct HandLimits {
    double speed_max_m_per_s; // in the scene
    double rate_hz;           // of the servo
};

TextureText read_texture(TableReader& object, FileMessages& messages);

// Gives the object, which has its surface and motion, its texture; or says why it has none. Without a reference or a
// resolver it stays smooth.
void load_texture(SceneObject& object, const TextureText& text, const HandLimits& hands,
                  const std::filesystem::path& folder, const TextureResolver& textures, FileMessages& messages);

} // namespace haptel::runtime
