#include "runtime/contact/probe_contact.h"

#include "runtime/contact/sphere_contact.h"
#include "runtime/surface/corner.h"

#include <algorithm>

namespace haptel::runtime {

namespace {

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

template <class Record>
void prefetch(const Record& record)
{
    const char* const first = reinterpret_cast<const char*>(&record);
    __builtin_prefetch(first);
    __builtin_prefetch(first + sizeof(Record) - 1); // it may lie across two lines, or three
    if constexpr (sizeof(Record) > 64) __builtin_prefetch(first + 64);
}

// The face that `to` leads to, and those beyond its other edges, `rings` times, into the cache: on a mesh that no cache
// holds, waiting for the next face's data is most of what a step onto it takes. Returns how many.
uint32_t read_from(const Surface& surface, const SideEdge& to, int rings)
{
    const Face& face = surface.faces[to.face()];
    for (size_t corner = 0; corner < 3; ++corner) {
        prefetch(surface.vertices[face.vertex[corner]]);
        prefetch(surface.shading_normal(face.fan_or_part[corner][to.side()]));
    }
    uint32_t seen = 1;
    if (rings == 0) return seen;
    for (const auto& link : face.link) prefetch(surface.faces[link[to.side()].face()]);
    for (uint32_t edge = 0; edge < 3; ++edge)
        if (edge != to.edge()) seen += read_from(surface, face.link[edge][to.side()], rings - 1);
    return seen;
}

} // namespace

ProbeContact::ProbeContact(const ProbeSettings& probe, const std::shared_ptr<const Surface>& surface, double rate_hz)
    : surface_(surface.get()), by_planes_(probe.kind == ProbeKind::sphere || !surface->is_clean())
{
    switch (probe.kind) {
    case ProbeKind::sphere: tip_ = std::make_unique<SphereContact>(surface, probe.radius_m); break;
    case ProbeKind::stylus: stylus_ = std::make_unique<StylusContact>(surface, rate_hz); break;
    case ProbeKind::gripper: tail_ = make_point(surface); [[fallthrough]];
    case ProbeKind::point: tip_ = make_point(surface); break;
    }
}

std::span<const Contact> ProbeContact::update(const ProbePose& pose, const EndsFriction& friction) noexcept
{
    spent_ = {};
    const bool same = friction == friction_;
    if (settled_ && pose == pose_ && same) return contacts();
    const ContactCounters before = counters();
    pose_ = pose;
    if (!same) friction_ = friction;
    stylus_ ? void(stylus_->update(pose.tip_m, pose.tail_m, friction)) : tip_->tick(pose.tip_m, friction.tip);
    if (tail_) {
        tail_->tick(pose.tail_m, friction.tail);
        of_fingers_count_ = 0;
        for (const Contact& contact : tip_->contacts()) of_fingers_[of_fingers_count_++] = contact;
        for (const Contact& contact : tail_->contacts()) (of_fingers_[of_fingers_count_++] = contact).along = 1;
    }
    spent_ = counters() - before;
    settled_ = spent_.walks_cut == 0;
    return contacts();
}

void ProbeContact::follow(const ProbePose& pose) noexcept
{
    settled_ = false;
    of_fingers_count_ = 0;
    stylus_ ? stylus_->follow(pose.tip_m, pose.tail_m) : tip_->follow(pose.tip_m);
    if (tail_) tail_->follow(pose.tail_m);
}

void ProbeContact::reset() noexcept
{
    settled_ = false;
    of_fingers_count_ = 0;
    stylus_ ? stylus_->reset() : tip_->reset();
    if (tail_) tail_->reset();
}

bool ProbeContact::move_out(double most_m) noexcept
{
    const bool moved = tip_ && !tail_ && tip_->move_out(most_m);
    if (moved) settled_ = false;
    return moved;
}

std::span<const Contact> ProbeContact::contacts() const noexcept
{
    if (stylus_) return stylus_->contacts();
    return tail_ ? std::span(of_fingers_.data(), of_fingers_count_) : tip_->contacts();
}

std::optional<ProbePose> ProbeContact::held(const ProbePose& hand, double off_m) const noexcept
{
    const std::span<const Contact> touching = contacts();
    if (touching.empty()) return {};
    ProbePose at = hand;
    const std::optional<Shaft> ideal = stylus_ ? stylus_->ideal() : std::nullopt;
    if (tip_ && !tail_)
        at.tip_m = surface_->lattice.metres(tip_->proxy().at);
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
    if (looks_around) {
        stylus_ ? stylus_->look_around() : tip_->look_around();
        if (tail_) tail_->look_around();
    }
    if (by_planes_) return 0;
    uint32_t seen = 0;
    for (const Contact& at : contacts())
        if (!at.by_shaft) seen += read_from(*surface_, SideEdge(at.face, 3, at.side), 2); // beyond all three edges
    return seen;
}

double ProbeContact::gap_m(const ProbePose& pose) const noexcept
{
    if (stylus_) return stylus_->gap_m(pose.tip_m, pose.tail_m);
    const double gap = tip_->gap_m(pose.tip_m);
    return tail_ ? std::min(gap, tail_->gap_m(pose.tail_m)) : gap;
}

ContactCounters ProbeContact::counters() const noexcept
{
    if (stylus_) return stylus_->counters();
    return tail_ ? tip_->counters() + tail_->counters() : tip_->counters();
}

} // namespace haptel::runtime
