// Joins those objects of a scene that are at rest and meet: joined_surfaces.h.
#pragma once

#include "runtime/files/surface_cache.h"
#include "runtime/files/table_reader.h"
#include "runtime/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haptel::runtime {

struct ObjectAtRest {
    uint32_t number;         // in Scene::objects
    std::string surface_key; // SurfaceCache::key of its surface
    toml::source_region at;
    bool joined; // with what it meets
};

// Warns of those that are there twice: they have no seam, and would be felt twice.
void warn_of_doubles(const Scene& scene, const std::vector<ObjectAtRest>& at_rest, FileMessages& messages);

// Fills scene.joined. What cannot be joined is told and stays apart.
void join_objects(Scene& scene, std::vector<ObjectAtRest> at_rest, SurfaceCache* surfaces, FileMessages& messages,
                  const Loading* loading);

} // namespace haptel::runtime
