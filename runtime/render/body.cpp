#include "runtime/render/body.h"

#include "runtime/surface/collision.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <limits>

namespace haptel::runtime {

std::vector<BodyObjects> bodies_of(const Scene& scene)
{
    std::vector<const JoinedObjects*> joined_by(scene.objects.size());
    for (const JoinedObjects& joined : scene.joined)
        for (const uint32_t number : joined.objects) joined_by[number] = &joined;
    std::vector<BodyObjects> bodies;
    for (uint32_t number = 0; number < scene.objects.size(); ++number) {
        const JoinedObjects* joined = joined_by[number];
        if (!joined || number == *std::min_element(joined->objects.begin(), joined->objects.end()))
            bodies.push_back({number, joined});
    }
    return bodies;
}

namespace {

constexpr double radius_slack = 1e-6; // of a radius

BoundingSphere box_of(const Surface& surface)
{
    const glm::dvec3 middle = 0.5 * surface.box_minimum_m + 0.5 * surface.box_maximum_m;
    return {.centre_m = middle, .radius_m = glm::distance(surface.box_minimum_m, middle)};
}

// From the surface to where nothing is felt of it any more.
double felt_within_m(const Scene& scene, const BodyObjects& objects, double probe_radius_m)
{
    double reach_m = 0;
    for (const uint32_t number : objects.numbers())
        reach_m = std::max(reach_m, scene.objects[number].effects.reach_m());
    return probe_radius_m + reach_m;
}

// Nothing: at rest, not known, or too fast for a tick.
std::optional<MotionBounds> bounds_of(const Scene& scene, const BodyObjects& objects)
{
    const Motion* motion = objects.motion(scene);
    if (!motion) return std::nullopt;
    const BoundingSphere box = box_of(*objects.surface(scene));
    const auto bounds = motion->bounds(box.centre_m, box.radius_m);
    return bounds && bounds->turn_rad_per_s <= turn_max_rad * scene.servo.rate_hz ? bounds : std::nullopt;
}

} // namespace

Body::Body(const Scene& scene, const BodyObjects& of, const ProbeSettings& probe)
    : objects(of)
    , motion(of.motion(scene))
    , bounded(bounds_of(scene, of))
    , around(box_of(*of.surface(scene)))
    , contact(probe, of.surface(scene), scene.servo.rate_hz)
    , placement(of.placement(scene))
    , velocity(1 / scene.servo.rate_hz)
    , tail_velocity(1 / scene.servo.rate_hz)
{
    around.radius_m = (around.radius_m + felt_within_m(scene, of, probe.radius_m)) * (1 + radius_slack);
}

BoundingSphere bounding_sphere_of(const Scene& scene, const Body& body, double probe_radius_m)
{
    if (!body.motion) return {body.placement.to_world(body.around.centre_m), body.around.radius_m};
    if (!body.bounded) return {.radius_m = std::numeric_limits<double>::infinity()};
    const MotionBounds& bounds = *body.bounded;
    const double radius_m = bounds.radius_m + felt_within_m(scene, body.objects, probe_radius_m);
    // r more, so that r = sway + turn * (radius + r + radius): the hand is farther away than it seems to move at the
    // edge of the ball.
    const double seems_m = (bounds.sway_m + 2 * turn_max_rad * radius_m) / (1 - turn_max_rad);
    return {bounds.centre_m, (radius_m + seems_m) * (1 + radius_slack), bounds.turn_rad_per_s > 0};
}

void Body::move(double time_s) noexcept
{
    const auto now = motion->at(time_s);
    if (now && finite(*now)) placement = *now;
}

bool lies_beyond(const Body& body, const ProbePose& probe, double away_m) noexcept
{
    return gap_m(body.around, probe.tip_m, probe.tail_m) > std::max(away_m, far_enough_m(probe.tip_m, probe.tail_m, 0));
}

void MeanFriction::add(const Friction& friction, double push_n) noexcept
{
    if (!(push_n > 0)) return;
    pushing_n += push_n;
    const double share = push_n / pushing_n;
    const double own = friction.static_coefficient + friction.dynamic_coefficient;
    mean.static_coefficient += share * (friction.static_coefficient - mean.static_coefficient);
    mean.dynamic_coefficient += share * (friction.dynamic_coefficient - mean.dynamic_coefficient);
    // A grain is the more the harder what has it holds.
    if (const double all = mean.static_coefficient + mean.dynamic_coefficient;
        all > 0 && (friction.grain.is_there || mean.grain.is_there))
        mean.grain = mixed(mean.grain, friction.grain, std::min(1.0, share * own / all));
}

Contact on_part(const Contact& contact, const Surface& joined, const SceneObject& part) noexcept
{
    const Surface& own = *part.surface;
    const Placement& placement = part.placement;
    const bool on_facet = contact.normal == contact.facet_normal;
    Contact result = contact;
    result.face = joined.origins[contact.face].face;
    result.proxy_m = placement.to_object(contact.proxy_m);
    result.hand_m = placement.to_object(contact.hand_m);
    result.barycentric = barycentric_of(own, result.face, own.lattice.units(result.proxy_m));
    result.facet_normal = own.facet_normal(result.face, contact.side);
    result.normal = on_facet ? result.facet_normal : placement.direction_to_object(contact.normal);
    result.lag_m = placement.direction_to_object(contact.lag_m);
    return result;
}

std::span<const PartContacts> ContactsByPart::of(const Scene& scene, const JoinedObjects& joined,
                                                 std::span<const Contact> contacts) noexcept
{
    const Surface& surface = *joined.surface;
    const auto part_of = [&](const Contact& contact) { return surface.origins[contact.face].part; };
    contacts = contacts.first(std::min(contacts.size(), most));
    std::size_t contact_count = 0, part_count = 0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const uint32_t part = part_of(contacts[i]);
        const bool again = std::any_of(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(i),
                                       [&](const Contact& earlier) { return part_of(earlier) == part; });
        if (again) continue;
        const std::size_t first = contact_count;
        for (const Contact& contact : contacts.subspan(i))
            if (part_of(contact) == part)
                contacts_[contact_count++] = on_part(contact, surface, scene.objects[joined.objects[part]]);
        parts_[part_count++] = {part, {contacts_.data() + first, contact_count - first}};
    }
    return {parts_.data(), part_count};
}

} // namespace haptel::runtime
