// A mesh read in a process of its own. The readers of foreign formats are large, and a file that was cut off while it
// was saved makes some of them crash, or never end: there that ends a process which does nothing else.
#pragma once

#include "runtime/files/mesh_file.h"

#include <string>

namespace haptel::runtime {

struct MeshReading {
    MeshFileResult result; // what `read` returned, if it did, or why no process could be had
    std::string gave_up;   // why `read` did not return, such as "it crashed (Segmentation fault)"; empty: it did
};

// In a process without this program's files, threads and later memory (see ForkedMain): all it knows is its argument. A
// path is best absolute.
using MeshReader = MeshFileResult (*)(const std::string& argument);

// Never throws but for want of memory.
MeshReading read_in_own_process(MeshReader read, const std::string& argument, const MeshReadLimits& limits,
                                const Loading* loading = nullptr);

} // namespace haptel::runtime
