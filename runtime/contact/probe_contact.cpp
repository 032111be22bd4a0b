#include "runtime/contact/probe_contact.h"

#include "runtime/contact/read_ahead.h"
#include "runtime/contact/sphere_contact.h"
#include "runtime/surface/corner.h"

namespace haptel::runtime {

namespace {

std::variant<std::unique_ptr<EndContact>, StylusContact, GripperContact>
make(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface, double rate_hz)
{
    switch (probe.kind) {
    case ProbeKind::point: break;
    case ProbeKind::sphere: return std::make_unique<SphereContact>(surface, probe.radius_m);
    case ProbeKind::stylus: return StylusContact(surface, rate_hz);
    case ProbeKind::gripper: return GripperContact(surface);
    }
    return make_point(surface);
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
    if (on == Feature::On::vertex) return unit(FanOutward(surface, {contact.face, i, contact.side}).normal);
    const SideEdge link = face.link[i][contact.side];
    return unit(contact.facet_normal + surface.facet_normal(link.face(), link.side()));
}

} // namespace

ProbeContact::ProbeContact(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface, double rate_hz)
    : surface_(surface.get())
    , by_planes_(probe.kind == ProbeKind::sphere || !surface->is_clean())
    , contact_(make(probe, surface, rate_hz))
{
}

std::span<const Contact> ProbeContact::update(const ProbePose& pose, const EndsFriction& friction) noexcept
{
    spent_ = {};
    const bool same = friction == friction_;
    if (settled_ && pose == pose_ && same) return contacts();
    const ContactCounters before = counters();
    pose_ = pose;
    if (!same) friction_ = friction;
    if (auto* end = std::get_if<End>(&contact_))
        (*end)->tick(pose.tip_m, friction.tip);
    else if (auto* gripper = std::get_if<GripperContact>(&contact_))
        gripper->update(pose.tip_m, pose.tail_m, friction);
    else
        std::get_if<StylusContact>(&contact_)->update(pose.tip_m, pose.tail_m, friction);
    spent_ = counters() - before;
    settled_ = spent_.walks_cut == 0;
    return contacts();
}

void ProbeContact::follow(const ProbePose& pose) noexcept
{
    settled_ = false;
    if (auto* end = std::get_if<End>(&contact_)) return (*end)->follow(pose.tip_m);
    if (auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->follow(pose.tip_m, pose.tail_m);
    std::get_if<StylusContact>(&contact_)->follow(pose.tip_m, pose.tail_m);
}

void ProbeContact::reset() noexcept
{
    settled_ = false;
    if (auto* end = std::get_if<End>(&contact_)) return (*end)->reset();
    if (auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->reset();
    std::get_if<StylusContact>(&contact_)->reset();
}

bool ProbeContact::move_out(double most_m) noexcept
{
    auto* end = std::get_if<End>(&contact_);
    const bool moved = end && (*end)->move_out(most_m);
    if (moved) settled_ = false;
    return moved;
}

std::span<const Contact> ProbeContact::contacts() const noexcept
{
    if (const auto* end = std::get_if<End>(&contact_)) return (*end)->contacts();
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
    if (const auto* end = std::get_if<End>(&contact_))
        at.tip_m = surface_->lattice.metres((*end)->proxy().at);
    else if (ideal)
        at = {surface_->lattice.metres(ideal->tip), surface_->lattice.metres(ideal->tail)};
    else
        for (const Contact& contact : touching) (contact.along == 0 ? at.tip_m : at.tail_m) = contact.proxy_m;
    for (const Contact& contact : touching) { // the least move of both ends that moves the place so far
        if (contact.unsettled) continue;      // its normal is no surface's
        const double tail = contact.along, tip = 1 - tail, squares = tip * tip + tail * tail;
        const glm::dvec3 out = contact.by_shaft || by_planes_ ? contact.normal : way_out(*surface_, contact);
        at.tip_m += tip / squares * off_m * out;
        at.tail_m += tail / squares * off_m * out;
    }
    return at;
}

// A ball keeps the faces around it by itself.
uint32_t ProbeContact::read_ahead(bool looks_around) noexcept
{
    auto* end = std::get_if<End>(&contact_);
    auto* gripper = std::get_if<GripperContact>(&contact_);
    auto* stylus = std::get_if<StylusContact>(&contact_);
    if (end && looks_around) (*end)->look_around();
    if (gripper && looks_around) gripper->look_around();
    if (stylus && looks_around) stylus->look_around();
    if (by_planes_) return 0;
    uint32_t seen = 0;
    for (const Contact& at : contacts())
        if (!at.by_shaft) seen += runtime::read_ahead(*surface_, at.face, at.side);
    return seen;
}

double ProbeContact::gap_m(const ProbePose& pose) const noexcept
{
    if (const auto* end = std::get_if<End>(&contact_)) return (*end)->gap_m(pose.tip_m);
    if (const auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->gap_m(pose.tip_m, pose.tail_m);
    return std::get_if<StylusContact>(&contact_)->gap_m(pose.tip_m, pose.tail_m);
}

ContactCounters ProbeContact::counters() const noexcept
{
    if (const auto* end = std::get_if<End>(&contact_)) return (*end)->counters();
    if (const auto* gripper = std::get_if<GripperContact>(&contact_)) return gripper->counters();
    return std::get_if<StylusContact>(&contact_)->counters();
}

} // namespace haptel::runtime
