// How often the renderer left out work that could not change the force.
#pragma once

#include <cstdint>

namespace haptel::runtime {

// Ticks in which something was left out because it could not change the force (Skips in scene.h).
struct SkippedStages {
    uint64_t free_space = 0; // no collision query was needed
    uint64_t objects = 0;    // summed over the ticks: objects out of the hand's reach, not looked at
    uint64_t texture = 0;    // no texture was evaluated: nothing was touched, or nothing that has one
    uint64_t octaves = 0;    // a texture was, without or with less of the detail that is finer than its footprint
    uint64_t mapping = 0;    // of what was touched coordinates of the mesh or the turning of its normals stayed unknown
};

} // namespace haptel::runtime
