// The files that the forces of a scene depend on, known by their content, so that a recording can tell whether what it
// was felt on is still the same.
#pragma once

#include "runtime/files/scene_file.h"
#include "runtime/servo/trace_origin.h"
#include "tools/replay/felt_difference.h"

#include <filesystem>
#include <vector>

namespace haptel::tools {

// The scene, its meshes, its textures with what they import, and their pictures, as they are on disk now. Paths are
// those that TracedFile asks for.
std::vector<runtime::TracedFile> traced_files(const std::filesystem::path& recording,
                                              const std::filesystem::path& scene, const runtime::LoadedScene& loaded);

// What of them is other now than it was, or gone.
std::vector<ChangedFile> changed_files(const runtime::TraceOrigin& origin, const std::filesystem::path& scene);

} // namespace haptel::tools
