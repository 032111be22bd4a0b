// How one hand reaches into the scene: with what, where, and with which motors. Several hands share one scene.
#pragma once

#include "runtime/geometry/placement.h"
#include "runtime/hand/haptic_device.h"
#include "runtime/hand/probe.h"

#include <glm/glm.hpp>

#include <optional>

namespace haptel::runtime {

// Where the space of the device lies in that of the scene, larger or smaller.
//
// Lengths in a scene are the scene's, but what is felt is stated for the hand: newtons on the hand, newtons per metre
// of the hand's way, newton seconds per metre of it. So a stiffness k is k / scale in the scene, and forces come back
// turned and as large as they were. The hand feels minus the gradient of the scene's energy over the scale: what is
// conservative stays so, and the limits of a device hold for the stiffness as it is written.
struct Workspace {
    double scale = 1;    // > 0: metres of the scene in one of the hand
    Placement placement; // of the device's origin and axes in the scene

    bool moves() const;
    glm::dvec3 to_scene(const glm::dvec3& hand_m) const { return placement.to_world(scale * hand_m); }
    glm::dvec3 to_hand(const glm::dvec3& scene_m) const { return placement.to_object(scene_m) / scale; }
    DevicePose to_scene(const DevicePose& pose) const;
    glm::dvec3 direction_to_hand(const glm::dvec3& v) const { return placement.direction_to_object(v); }
    // Of forces as they are on the hand, with levers of the scene.
    glm::dvec3 torque_to_hand(const glm::dvec3& torque_n_m) const { return direction_to_hand(torque_n_m) / scale; }
};

struct HandSettings {
    double force_max_n = 0; // what the motors can do; 0: unknown, the scene's limit alone holds
    Workspace workspace = {};
    std::optional<ProbeSettings> probe = {}; // none: the scene's, whichever is felt
    bool slopes_only = false;                // DeviceInfo::slopes_only
};

inline bool Workspace::moves() const
{
    return scale != 1 || placement.rotation != glm::dmat3(1) || placement.position_m != glm::dvec3(0);
}

inline DevicePose Workspace::to_scene(const DevicePose& pose) const
{
    DevicePose there = pose;
    there.tip_m = to_scene(pose.tip_m);
    there.tail_m = to_scene(pose.tail_m);
    return there;
}

} // namespace haptel::runtime
