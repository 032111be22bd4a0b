// Scenes from TOML files. The keys are listed in the parts of scene_file.cpp, one function per table; numbers are SI,
// or text with a unit; paths are relative to the scene.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/files/surface_cache.h"
#include "runtime/hand/hand.h"
#include "runtime/hand/haptic_device.h"
#include "runtime/scene/scene.h"
#include "runtime/surface/loading.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::runtime {

struct LoadedHand {
    std::unique_ptr<HapticDevice> device;
    HandSettings settings;
};

struct LoadedScene {
    std::shared_ptr<const Scene> scene;        // null: see diagnostics
    std::vector<std::filesystem::path> meshes; // files that it is made of, as far as it could be read
    std::vector<LoadedHand> hands;     // one per device of the file; none without a scene or where no factory was given
    std::vector<ProbeSettings> probes; // of each device of the file, opened or not; none without a scene
    // Errors (then there is no scene), warnings and notes, ready to print: "FILE:LINE:COLUMN: error: ...", a line each,
    // several at once.
    std::string diagnostics;
};

// What is asked of a scene in the place of what its file says.
struct SceneChanges {
    std::optional<double> rate_hz; // of the servo, within the range of the file's key
};

// Reads, checks, loads the meshes, asks `textures` for every texture and `devices` for each device. Either may be
// empty: objects are then smooth, and no device is opened. `surfaces`: what it holds is not built again, what is built
// it keeps. `loading` hears what takes long, and may end it: then there is no scene. Never throws.
LoadedScene load_scene(const std::filesystem::path& file, const TextureResolver& textures, const DeviceFactory& devices,
                       SurfaceCache* surfaces = nullptr, const Loading& loading = {}, const SceneChanges& changes = {});

// Some hundred thousand objects. What the parser makes of a file takes some thirty times its size.
inline constexpr std::uintmax_t scene_bytes_max = 16 << 20;

} // namespace haptel::runtime
