// A mesh read in a process of its own. The readers of foreign formats are large, and a file that was cut off while it
// was saved makes some of them crash, or never end: there that ends a process which does nothing else.
#pragma once

#include "runtime/files/mesh_file.h"

#include <functional>

namespace haptel::runtime {

struct MeshReading {
    MeshFileResult result; // what `read` returned, if it did, or why no process could be had
    std::string gave_up;   // why `read` did not return, such as "it crashed (Segmentation fault)"; empty: it did
};

// `read` runs in a copy of this process that has this thread alone and no open file, with its limits: it must not wait
// for another thread, or write anywhere. Memory: half of what the machine has. Never throws.
MeshReading read_in_own_process(const std::function<MeshFileResult()>& read, const MeshReadLimits& limits);

} // namespace haptel::runtime
