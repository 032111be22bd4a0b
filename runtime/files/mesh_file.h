// Meshes from files, by assimp. What is read is a soup that nobody has checked yet: build_surface() does.
#pragma once

#include "runtime/surface/loading.h"
#include "runtime/surface/mesh.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

namespace haptel::runtime {

struct MeshFileResult {
    Mesh mesh;                    // triangles of all parts of the file, in the file's units, as if metres
    std::string error;            // why there is none, in words; empty: read
    std::string warning = {};     // what was lost by reading it, in words; empty: nothing
    std::string other_files = {}; // that were asked for, there or not: seen from its folder, each ends with a zero
};

struct MeshReadLimits {
    double processor_s, wall_s;
    std::uintmax_t memory_bytes = std::numeric_limits<std::uintmax_t>::max(); // and half of what the machine has
};

// Some ten million triangles as text.
inline constexpr std::uintmax_t mesh_bytes_max = 1 << 30;

// Of one file. Beyond it a surface takes more than some GiB.
inline constexpr std::size_t mesh_triangles_max = 4'000'000;

// Polygons are cut into triangles; points and lines are left out. Formats: OBJ, PLY, STL, OFF, 3DS, DAE, glTF.
// Smoothing groups are those of an OBJ file with lines `s N` and `s off`; faces before the first of them are of none.
//
// The file is read in a process of its own: one that is damaged is an error in words, whatever its reader does about
// it. The first time makes the process that forks for the others; load_scene() does that at once, and who does not call
// it does well to call start_fork_server() before a servo runs. Limits: unless given, more the larger the file is.
MeshFileResult load_mesh(const std::filesystem::path& file, std::optional<MeshReadLimits> limits = std::nullopt,
                         const Loading* loading = nullptr);

} // namespace haptel::runtime
