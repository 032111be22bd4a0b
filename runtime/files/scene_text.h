// What is said of a scene, by a file or a program, before anything else is opened.
#pragma once

#include "runtime/files/device_reader.h"
#include "runtime/files/motion_reader.h"
#include "runtime/files/object_texture.h"
#include "runtime/scene/scene.h"
#include "runtime/surface/mesh.h"
#include "runtime/surface/surface.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::runtime {

// Side of a built-in shape whose size nobody says, metres.
inline constexpr double default_shape_size_m = 0.1;

struct ObjectText {
    // One of them. A program's own mesh is as it is.
    std::string mesh, shape;
    std::shared_ptr<const Mesh> own_mesh = {};
    double size_m = 0;                     // 0: as it is
    std::optional<double> crease_deg = {}; // if it was written: then the mesh's smoothing groups do not count
    bool joined = true;                    // with what it meets
    std::string surface_key;
    SceneObject object;
    MotionText motion;
    TextureText texture;
    toml::source_region mesh_at, stiffness_at, reach_at;
};

struct SceneText {
    ProbeSettings probe;
    ServoSettings servo;
    std::vector<Region> regions;
    std::vector<DeviceText> devices; // at least one
    std::vector<ObjectText> objects;
};

} // namespace haptel::runtime
