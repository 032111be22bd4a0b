// What is touched as one, with one proxy: an object by itself, or several at rest that are joined (Scene::joined).
#pragma once

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
    uint32_t number(uint32_t part) const noexcept { return joined ? joined->objects[part] : first; }
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

// Within which a body is felt, effects included, wherever it goes: a radius without end if that is not known.
BoundingSphere bounding_sphere_of(const Scene& scene, const BodyObjects& objects, double probe_radius_m);

// The friction that holds one end of the probe: the mean of all that it touches, by how hard that pushes, so that in a
// crease one material comes in place of another without a step.
struct MeanFriction {
    Friction mean;
    double pushing_n = 0;

    void add(const Friction& friction, double push_n) noexcept;
};

// What the servo remembers of one.
struct Body {
    Body(const Scene& scene, const BodyObjects& objects, const ProbeSettings& probe);

    BodyObjects objects;
    const Motion* motion; // null: at rest
    // Moves, within bounds: may be asked where it was, and not at all for a while (sleep_queue.h). Its velocities are
    // known only from when it is touched to when the hand is out of its bounding sphere.
    bool bounded = false;
    double turn_rad_per_s = 0; // of those bounds
    BoundingSphere around;     // in its own space, within which it is felt
    ProbeContact contact;      // in the body's space
    Placement placement;       // of this tick
    // Of tip and tail, in the space of a body that moves; else not kept.
    HandVelocity velocity, tail_velocity;
    // Out of the hand's reach: its contact stands where the hand last was, and so does it itself if it is bounded.
    bool asleep = false;
    // Of the tick before: contact comes before texture.
    MeanFriction tip_friction, tail_friction;

    ProbePose pose_of(const DevicePose& pose) const noexcept
    {
        return {placement.to_object(pose.tip_m), placement.to_object(pose.tail_m)};
    }
    // Of one of its objects, in this tick.
    const Placement& placement_of(const SceneObject& object) const noexcept
    {
        return objects.joined ? object.placement : placement;
    }
    // Of a body that moves: to where it is now.
    void move(double time_s) noexcept;
};

// Nothing of it is felt within that distance of a probe in its space, where coordinates may be large.
bool lies_beyond(const Body& body, const ProbePose& probe, double away_m) noexcept;

// A contact with a joined surface as the object that it belongs to has it: in that one's space, on its own surface. The
// proxy may lie beside its triangle by what joining has moved vertices.
Contact on_part(const Contact& contact, const Surface& joined, const SceneObject& part) noexcept;

// Contacts with one object of a body, in its space.
struct PartContacts {
    uint32_t part = 0;
    std::span<const Contact> contacts;
};

// Contacts with a joined surface, object by object.
class ContactsByPart {
public:
    // As many as any probe has: the ends of a stylus, held by three sheets each, its shaft, and what it does not know
    // yet.
    static constexpr std::size_t most = 12;

    // In the order of the contacts, the first of each object counting. Valid until the next call.
    std::span<const PartContacts> of(const Scene& scene, const JoinedObjects& joined,
                                     std::span<const Contact> contacts) noexcept;

private:
    std::array<Contact, most> contacts_;
    std::array<PartContacts, most> parts_;
};

} // namespace haptel::runtime
