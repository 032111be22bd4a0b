// The scene database: what there is to touch. Immutable once made and shared by all threads; only the textures in the
// objects' slots change, each by its own atomic pointer.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/geometry/placement.h"
#include "runtime/hand/haptic_device.h"
#include "runtime/hand/probe.h"
#include "runtime/scene/force_rule.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_effects.h"
#include "runtime/scene/region.h"
#include "runtime/surface/surface.h"
#include "runtime/texture/texture_slot.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::runtime {

struct Material {
    double stiffness_n_per_m = 800; // > 0
    double damping_n_s_per_m = 1.0; // >= 0; along the normal, full below full_damping_depth_m
    double static_friction = 0.3;   // >= dynamic_friction: largest tangential over normal force that sticks
    double dynamic_friction = 0.2;  // >= 0: the same while sliding
};

struct SceneObject {
    std::string name; // for messages: the mesh file or the shape
    std::shared_ptr<const Surface> surface;
    Placement placement;                  // at the start
    std::shared_ptr<const Motion> motion; // null: it stays there
    Material material;
    ObjectEffects effects;
    std::shared_ptr<TextureSlot> texture = std::make_shared<TextureSlot>();
    std::optional<TextureRequest> request; // what the texture was resolved from, for live reload
};

// Objects at rest whose surfaces meet, as one to the probe: it slides from one to the other as if they were one mesh.
struct JoinedObjects {
    std::shared_ptr<const Surface> surface; // the scene's space; its origins tell parts by their place in `objects`
    std::vector<uint32_t> objects;          // numbers in Scene::objects, each in one join at most
};

// What a tick leaves out because it cannot change the force (docs/realtime.md). Off only to measure what it saves and
// to prove that nobody feels it.
struct Skips {
    bool free_space = true; // collision, while nothing can be within the hand's reach
    bool objects = true;    // objects out of the hand's reach
    bool texture = true;    // where nothing is touched, or not so deep as to feel it
    bool mapping = true;    // mesh coordinates and the turning of normals that nobody reads
};

struct ServoSettings {
    double rate_hz = 1000;
    ForceRule force;
    double force_limit_n = 7;   // > 0; the device's own limit applies too
    double v_max_m_per_s = 0.3; // hand speed that textures are band-limited for
    double force_rise_s = 0.1;  // forces grow linearly from 0 over this time after start or interruption
    // > 0: after start or interruption no force is sent before the force computed is at most this; then it rises. 0:
    // off
    double wait_for_small_force_n = 0;
    Skips skips;
};

struct Scene {
    std::vector<SceneObject> objects;  // the first is the one that a simulated hand explores
    std::vector<JoinedObjects> joined; // every other object is touched by itself
    std::vector<Region> regions;
    ProbeSettings probe;
    ServoSettings servo;
};

} // namespace haptel::runtime
