// From what is said of a scene to the scene: meshes are built, textures bound, neighbours joined, devices opened, and
// all is checked.
#pragma once

#include "runtime/files/scene_file.h"
#include "runtime/files/scene_text.h"
#include "runtime/files/table_reader.h"

#include <filesystem>

namespace haptel::runtime {

// Tells of faults where `text` says that they are written. Paths start from `folder`.
LoadedScene assemble_scene(SceneText text, const std::filesystem::path& folder, const TextureResolver& textures,
                           const DeviceFactory& devices, SurfaceCache* surfaces, const Loading& loading,
                           FileMessages& messages);

} // namespace haptel::runtime
