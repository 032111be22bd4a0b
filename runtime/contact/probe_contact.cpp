#include "runtime/contact/probe_contact.h"

#include "runtime/contact/read_ahead.h"
#include "runtime/surface/corner.h"

namespace haptel::runtime {

namespace {

std::variant<PointContact, SphereContact, StylusContact, GripperContact>
make(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface, bool skips_free_space, double rate_hz)
{
    switch (probe.kind) {
    case ProbeKind::point: return PointContact(surface, skips_free_space);
    case ProbeKind::sphere: return SphereContact(surface, probe.radius_m);
    case ProbeKind::stylus: return StylusContact(surface, skips_free_space, rate_hz);
    case ProbeKind::gripper: return GripperContact(surface, skips_free_space);
    }
    return PointContact(surface, skips_free_space);
}

// Whether several parts, sheets or faces may hold the same end of the probe.
bool is_shared(const ProbeSettings& probe, const Surface& surface)
{
    return probe.kind == ProbeKind::sphere || !surface.origins.empty() || !surface.pierced_by.empty();
}

// Out of where a point touches: in a narrow pit its contact's normal, from the hand, leads into a wall.
glm::dvec3 way_out(const Surface& surface, const Contact& contact)
{
    const auto unit = [&](const glm::dvec3& sum) {
        return glm::length(sum) > Surface::least_normal ? glm::normalize(sum) : contact.normal;
    };
    const Face& face = surface.faces[contact.face];
    const auto [on, i] = feature_at(contact.barycentric);
    if (on == Feature::On::face) return contact.normal;
    if (on == Feature::On::vertex) return unit(surface.fans[face.fan[i][contact.side]].normal);
    const SideEdge link = face.link[i][contact.side];
    return unit(contact.facet_normal + surface.facet_normal(link.face(), link.side()));
}

std::span<const Contact> any(const Contact& contact)
{
    return {&contact, contact.touching ? std::size_t{1} : std::size_t{0}};
}

} // namespace

ProbeContact::ProbeContact(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface,
                           bool skips_free_space, double rate_hz)
    : surface_(surface.get())
    , shares_(is_shared(probe, *surface) ? std::make_unique<PartShares>() : nullptr)
    , contact_(make(probe, surface, skips_free_space, rate_hz))
{
}

std::span<const Contact> ProbeContact::update(const ProbePose& pose, const EndsFriction& friction) noexcept
{
    const std::span<const Contact> contacts = touched(pose, friction);
    return shares_ ? shares_->of(*surface_, contacts) : contacts;
}

std::span<const Contact> ProbeContact::touched(const ProbePose& pose, const EndsFriction& friction) noexcept
{
    if (auto* point = std::get_if<PointContact>(&contact_)) return any(point->update(pose.tip_m, friction.tip));
    if (auto* sphere = std::get_if<SphereContact>(&contact_)) return sphere->update(pose.tip_m, friction.tip);
    if (auto* gripper = std::get_if<GripperContact>(&contact_))
        return gripper->update(pose.tip_m, pose.tail_m, friction);
    auto& stylus = *std::get_if<StylusContact>(&contact_);
    stylus.update(pose.tip_m, pose.tail_m, friction);
    return stylus.contacts();
}

void ProbeContact::follow(const ProbePose& pose) noexcept
{
    if (auto* point = std::get_if<PointContact>(&contact_)) return point->follow(pose.tip_m);
    if (auto* sphere = std::get_if<SphereContact>(&contact_)) return sphere->follow(pose.tip_m);
    if (auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->follow(pose.tip_m, pose.tail_m);
    std::get_if<StylusContact>(&contact_)->follow(pose.tip_m, pose.tail_m);
}

void ProbeContact::reset() noexcept
{
    std::visit([](auto& contact) { contact.reset(); }, contact_);
}

bool ProbeContact::move_out(double most_m) noexcept
{
    auto* sphere = std::get_if<SphereContact>(&contact_);
    return sphere && sphere->move_out(most_m);
}

std::span<const Contact> ProbeContact::contacts() const noexcept
{
    if (const auto* point = std::get_if<PointContact>(&contact_)) return any(point->contact());
    if (const auto* sphere = std::get_if<SphereContact>(&contact_)) return sphere->contacts();
    if (const auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->contacts();
    return std::get_if<StylusContact>(&contact_)->contacts();
}

std::optional<ProbePose> ProbeContact::held(const ProbePose& hand, double off_m) const noexcept
{
    const std::span<const Contact> touching = contacts();
    if (touching.empty()) return {};
    ProbePose at = hand;
    const auto* stylus = std::get_if<StylusContact>(&contact_);
    const std::optional<Shaft> ideal = stylus ? stylus->ideal() : std::nullopt;
    if (const auto* sphere = std::get_if<SphereContact>(&contact_))
        at.tip_m = sphere->proxy_m();
    else if (ideal)
        at = {surface_->lattice.metres(ideal->tip), surface_->lattice.metres(ideal->tail)};
    else
        for (const Contact& contact : touching) (contact.along == 0 ? at.tip_m : at.tail_m) = contact.proxy_m;
    for (const Contact& contact : touching) { // the least move of both ends that moves the place so far
        if (contact.unsettled) continue;      // its normal is no surface's
        const double tail = contact.along, tip = 1 - tail, squares = tip * tip + tail * tail;
        const bool by_place = !contact.by_shaft && !std::holds_alternative<SphereContact>(contact_);
        const glm::dvec3 out = by_place ? way_out(*surface_, contact) : contact.normal;
        at.tip_m += tip / squares * off_m * out;
        at.tail_m += tail / squares * off_m * out;
    }
    return at;
}

// A ball keeps the faces around it by itself.
uint32_t ProbeContact::read_ahead() noexcept
{
    const auto around = [](auto& tip) {
        tip.look_around();
        const Contact& at = tip.contact();
        return at.touching ? runtime::read_ahead(tip.surface(), at.face, at.side) : 0;
    };
    if (auto* point = std::get_if<PointContact>(&contact_)) return around(*point);
    if (auto* stylus = std::get_if<StylusContact>(&contact_)) return around(*stylus);
    uint32_t seen = 0;
    if (auto* gripper = std::get_if<GripperContact>(&contact_)) {
        gripper->look_around();
        for (const Contact& at : gripper->contacts()) seen += runtime::read_ahead(gripper->surface(), at.face, at.side);
    }
    return seen;
}

double ProbeContact::gap_m(const ProbePose& pose) const noexcept
{
    if (const auto* point = std::get_if<PointContact>(&contact_)) return point->gap_m(pose.tip_m);
    if (const auto* sphere = std::get_if<SphereContact>(&contact_)) return sphere->gap_m(pose.tip_m);
    if (const auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->gap_m(pose.tip_m, pose.tail_m);
    return std::get_if<StylusContact>(&contact_)->gap_m(pose.tip_m, pose.tail_m);
}

const ContactCounters& ProbeContact::counters() const noexcept
{
    if (const auto* point = std::get_if<PointContact>(&contact_)) return point->counters();
    if (const auto* sphere = std::get_if<SphereContact>(&contact_)) return sphere->counters();
    if (const auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->counters();
    return std::get_if<StylusContact>(&contact_)->counters();
}

} // namespace haptel::runtime
