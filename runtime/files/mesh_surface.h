// The surface of a mesh file. What took long to read and build is kept on disk by the file's content, so that the next
// start need not build it again (input/kept_files.h, in the folder `surfaces`).
#pragma once

#include "input/kept_files.h"
#include "runtime/surface/loading.h"
#include "runtime/surface/surface.h"

#include <filesystem>
#include <optional>
#include <string>

namespace haptel::runtime {

struct MeshSurface {
    std::shared_ptr<const Surface> surface; // null: see error
    MeshReport report;
    std::string error, warning;  // of reading or building, and of reading
    bool all_groups_off = false; // it has smoothing groups, and no face is in any: all are felt flat
};

// Some hold three surfaces of two million triangles.
inline constexpr uint64_t kept_surfaces_bytes_max = uint64_t{1} << 30;

// Those of this process.
input::KeptFiles& kept_surfaces();

// size_m: of its largest side; 0: as it is. No crease: the file's own, by its smoothing groups. What takes
// `keep_from_s` or longer is kept.
MeshSurface surface_of_mesh_file(const std::filesystem::path& file, double size_m, std::optional<double> crease_deg,
                                 const Loading& loading, input::KeptFiles& kept = kept_surfaces(),
                                 double keep_from_s = 0.2);

} // namespace haptel::runtime
