// What is touched as one, with one proxy: an object by itself, or several at rest that are joined (Scene::joined).
#pragma once

#include "runtime/contact/crease_rows.h"
#include "runtime/contact/probe_contact.h"
#include "runtime/geometry/placement.h"
#include "runtime/hand/hand_velocity.h"
#include "runtime/hand/haptic_device.h"
#include "runtime/render/sleep_queue.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace haptel::runtime {

// Which objects of a scene, that outlives it, a body is of.
struct BodyObjects {
    uint32_t first = 0;                    // number of the object; of joined ones the least
    const JoinedObjects* joined = nullptr; // null: an object by itself

    // A part is a place in here.
    std::span<const uint32_t> numbers() const noexcept
    {
        return joined ? std::span<const uint32_t>(joined->objects) : std::span<const uint32_t>(&first, 1);
    }
    const std::shared_ptr<const Surface>& surface(const Scene& scene) const
    {
        return joined ? joined->surface : scene.objects[first].surface;
    }
    // At the start; joined objects are in the scene's space, and at rest.
    Placement placement(const Scene& scene) const { return joined ? Placement() : scene.objects[first].placement; }
    const Motion* motion(const Scene& scene) const { return joined ? nullptr : scene.objects[first].motion.get(); }
};

// Each object in one of them, in the order of their first ones.
std::vector<BodyObjects> bodies_of(const Scene& scene);

// The friction at one end of the probe that touches several objects: the mean of their coefficients, weighted by the
// force of each, and of their grains, weighted by what friction holds there, so that it changes without a step when the
// probe slides through a crease from one to the other.
struct MeanFriction {
    Friction mean;
    double pushing_n = 0;

    void add(const Friction& friction, double push_n) noexcept;
};

// The state of a body from tick to tick.
struct Body {
    Body(const Scene& scene, const BodyObjects& objects, const ProbeSettings& probe);

    BodyObjects objects;
    const Motion* motion; // null: at rest
    // Moves, within bounds: may be asked where it was, and not at all for a while (sleep_queue.h). Its velocities are
    // known only from when it is touched to when the hand is out of its bounding sphere.
    std::optional<MotionBounds> bounded;
    BoundingSphere around; // in its own space, within which it is felt
    ProbeContact contact;  // in the body's space
    Placement placement;   // of this tick
    // Of tip and tail, in the space of a body that moves; else not kept.
    HandVelocity velocity, tail_velocity;
    // Too far from the hand to be touched (sleep_queue.h): its contact was last updated when it fell asleep, and so was
    // its placement if it is bounded.
    bool asleep = false;
    // Of the tick before, since the contact needs friction before textures are evaluated.
    MeanFriction tip_friction, tail_friction;
    glm::dvec3 aim_m{0}; // of the tick before: how far magnets aim the tip of joined objects' proxy off the hand

    ProbePose pose_of(const auto& pose) const noexcept
    {
        return {placement.to_object(pose.tip_m), placement.to_object(pose.tail_m)};
    }
    ProbePose in_scene(const ProbePose& pose) const noexcept
    {
        return {placement.to_world(pose.tip_m), placement.to_world(pose.tail_m)};
    }
    // Of one of its objects, in this tick.
    const Placement& placement_of(const SceneObject& object) const noexcept
    {
        return objects.joined ? object.placement : placement;
    }
    // Of a body that moves: to where it is now.
    void move(double time_s) noexcept;
};

// The sphere, in the scene's space, outside of which nothing of a body is felt, effects included, wherever its motion
// takes it. The radius is infinite if its motion has no known bounds.
BoundingSphere bounding_sphere_of(const Scene& scene, const Body& body, double probe_radius_m);

// Whether nothing of the body can be felt by a probe at most `away_m` metres from this pose, which is in the body's
// space. Allows for the rounding of large coordinates.
bool lies_beyond(const Body& body, const ProbePose& probe, double away_m) noexcept;

// A contact with a joined surface, converted to the object it belongs to: its face and side, in its space. Joining
// moves vertices a little, so the proxy may lie beside the object's own triangle by as much.
Contact on_part(const Contact& contact, const Surface& joined, const SceneObject& part) noexcept;

// Contacts with one object of a body, in its space.
struct PartContacts {
    uint32_t part = 0;
    std::span<const Contact> contacts;
};

// Contacts with a joined surface, object by object.
class ContactsByPart {
public:
    static constexpr std::size_t most = CreaseRows::rows_most; // contacts

    // The contacts grouped by object and converted to its space. Groups are in the order of their first contact. Valid
    // until the next call.
    std::span<const PartContacts> of(const Scene& scene, const JoinedObjects& joined,
                                     std::span<const Contact> contacts) noexcept;

private:
    std::array<Contact, most> contacts_;
    std::array<PartContacts, most> parts_;
};

} // namespace haptel::runtime
