#include "runtime/contact/part_shares.h"

#include "runtime/contact/intersecting_faces.h"
#include "runtime/surface/collision.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace haptel::runtime {

namespace {

// Lattice units: what lies nearer to the proxy than this meets there. More than what metres lose of them, and wider
// than the slivers that joining leaves.
constexpr double near_units = 1024;

// Share of the depth that nobody feels.
constexpr double enough = 1e-6;

// Share of the depth: where the planes around leave more of it than this they are not what holds the proxy.
constexpr double lost = 1e-3;

// Of the way from the hand to the proxy: walls of a narrow groove that push more than this in sum, each by a stiffness
// and a texture of its own, share the way itself beyond it.
constexpr double opposed_way = 4;

// The planes around a place that may hold a proxy there, those of one part that coincide as one.
struct Planes {
    static constexpr uint32_t most = 10;
    Plane plane[most];
    uint32_t count = 0;
    const Surface& surface;

    explicit Planes(const Surface& of) : surface(of) {}

    uint32_t part_of(uint32_t face) const { return surface.origins.empty() ? 0 : surface.origins[face].part; }
    uint32_t part(uint32_t k) const { return part_of(plane[k].face); }
    void add(uint32_t face, uint32_t side)
    {
        const glm::dvec3 normal = surface.facet_normal(face, side);
        for (uint32_t k = 0; k < count; ++k)
            if (part(k) == part_of(face) && glm::distance(plane[k].normal, normal) < enough) return;
        if (count < most) plane[count++] = {face, side, normal, false};
    }
    bool of_one_part() const
    {
        for (uint32_t k = 1; k < count; ++k)
            if (part(k) != part(0)) return false;
        return true;
    }
};

// Faces around a place, on the side that a proxy there is on: from one to the next by the links of edges near it, and
// by the fans that meet in a vertex near it.
class Around {
public:
    static constexpr uint32_t most = 32;

    Around(const Surface& surface, const Contact& contact)
        : surface_(surface), at_(surface.lattice.units(contact.proxy_m))
    {
        reach(contact.face, contact.side);
        for (uint32_t k = 0; k < count_; ++k) go_on_from(face_[k], side_[k]);
    }
    const glm::dvec3& at() const { return at_; }
    void add_to(Planes& planes) const
    {
        for (uint32_t k = 0; k < count_; ++k) planes.add(face_[k], side_[k]);
    }

private:
    void reach(uint32_t face, uint32_t side)
    {
        for (uint32_t k = 0; k < count_; ++k)
            if (face_[k] == face && side_[k] == side) return;
        if (count_ == most) return;
        face_[count_] = face;
        side_[count_++] = side;
    }
    void go_on_from(uint32_t number, uint32_t side)
    {
        const Face& face = surface_.faces[number];
        for (uint32_t i = 0; i < 3; ++i) {
            const glm::dvec3 &begin = surface_.vertices[face.vertex[i]],
                             along = surface_.vertices[face.vertex[next(i)]] - begin, away = at_ - begin;
            const double way = glm::clamp(glm::dot(away, along) / glm::dot(along, along), 0.0, 1.0);
            if (glm::distance(away, way * along) > near_units) continue;
            reach(face.link[i][side].face(), face.link[i][side].side());
            if (glm::length(away) > near_units) continue;
            const uint32_t own = face.fan[i][side];
            for (uint32_t fan = surface_.fans[own].next; fan != own; fan = surface_.fans[fan].next)
                reach(surface_.fans[fan].face, surface_.fans[fan].side);
        }
    }

    const Surface& surface_;
    glm::dvec3 at_;
    uint32_t face_[most], side_[most];
    uint32_t count_ = 0;
};

Planes planes_around(const Surface& surface, const Contact& contact)
{
    Planes planes(surface);
    const Around around(surface, contact);
    around.add_to(planes);
    if (has_walls(surface, contact.face)) {
        PlaneSet walls;
        add_walls(surface, contact.face, around.at(), walls);
        for (uint32_t k = 0; k < walls.count; ++k) planes.add(walls.plane[k].face, walls.plane[k].side);
    }
    return planes;
}

// How much each plane pushes along its normal, none pulling, so that together they make up the push. If there are
// several ways, the one that is least in sum: it does not jump as the push turns.
struct Shares {
    double of[Planes::most] = {};
    double sum = INFINITY;
    double left = INFINITY; // length of what they do not make up
};

Shares shares(const Planes& planes, const glm::dvec3& push)
{
    const double few = enough * glm::length(push);
    Shares best;
    const auto offer = [&](std::initializer_list<std::pair<uint32_t, double>> found) {
        Shares candidate;
        candidate.sum = 0;
        glm::dvec3 rest = push;
        for (const auto& [k, share] : found) {
            if (!(share >= 0)) return;
            candidate.of[k] = share;
            candidate.sum += share;
            rest -= share * planes.plane[k].normal;
        }
        candidate.left = glm::length(rest);
        const bool better = candidate.left > few ? candidate.left < best.left
                                                 : best.left > few || candidate.sum < best.sum * (1 - enough);
        if (better) best = candidate;
    };
    const auto normal = [&](uint32_t k) { return planes.plane[k].normal; };
    for (uint32_t i = 0; i < planes.count; ++i) offer({{i, glm::dot(push, normal(i))}});
    for (uint32_t j = 0; j < planes.count; ++j)
        for (uint32_t i = 0; i < j; ++i) {
            const double cosine = glm::dot(normal(i), normal(j)), square = 1 - cosine * cosine;
            const double along_i = glm::dot(push, normal(i)), along_j = glm::dot(push, normal(j));
            offer({{i, (along_i - cosine * along_j) / square}, {j, (along_j - cosine * along_i) / square}});
        }
    for (uint32_t k = 0; k < planes.count; ++k)
        for (uint32_t j = 0; j < k; ++j)
            for (uint32_t i = 0; i < j; ++i) {
                const glm::dvec3 jk = glm::cross(normal(j), normal(k)), ki = glm::cross(normal(k), normal(i)),
                                 ij = glm::cross(normal(i), normal(j));
                const double volume = glm::dot(normal(i), jk);
                offer({{i, glm::dot(push, jk) / volume},
                       {j, glm::dot(push, ki) / volume},
                       {k, glm::dot(push, ij) / volume}});
            }
    return best;
}

} // namespace

std::span<const Contact> PartShares::of(const Surface& surface, std::span<const Contact> contacts) noexcept
{
    count_ = 0;
    for (const Contact& contact : contacts) add(surface, contact);
    for (const double along : {0.0, 1.0}) settle(along);
    return {contacts_.data(), count_};
}

// Of one end, or of a ball, which several faces of one mesh may hold, too: its walls push against each other by what
// the angle between them makes of the way. The sum stays.
void PartShares::settle(double along) noexcept
{
    glm::dvec3 way_m(0);
    double sum_m = 0;
    const auto ours = [&](const Contact& contact) { return !contact.by_shaft && contact.along == along; };
    for (std::size_t i = 0; i < count_; ++i)
        if (const Contact& contact = contacts_[i]; ours(contact)) {
            way_m += contact.depth_m * contact.normal;
            sum_m += contact.depth_m;
        }
    const double most_m = opposed_way * glm::length(way_m);
    if (!(sum_m > most_m)) return;
    const double kept = most_m / sum_m;
    for (std::size_t i = 0; i < count_; ++i) {
        Contact& contact = contacts_[i];
        if (!ours(contact) || contact.depth_m == 0) continue;
        const glm::dvec3 push = contact.depth_m * (kept * contact.normal + (1 - kept) / sum_m * way_m);
        contact.depth_m = glm::length(push);
        if (contact.depth_m > 0) contact.normal = push / contact.depth_m;
        contact.on_crease = true;
    }
}

void PartShares::add(const Surface& surface, const Contact& contact) noexcept
{
    const std::size_t first = count_;
    const auto keep = [&](const Contact& one) {
        if (count_ < contacts_.size()) contacts_[count_++] = one;
    };
    const bool joined = !surface.origins.empty(), by_plane = contact.on_crease;
    if (contact.by_shaft || contact.depth_m == 0 || (!joined && !by_plane)) return keep(contact);
    const Planes planes = planes_around(surface, contact);
    if (planes.of_one_part() && !by_plane) return keep(contact);

    const Shares share = shares(planes, contact.depth_m * contact.normal);
    if (!(share.left <= lost * contact.depth_m)) return keep(contact);
    double sum_m = 0;
    bool done[Planes::most] = {};
    for (uint32_t k = 0; k < planes.count; ++k) {
        if (done[k]) continue;
        glm::dvec3 push(0);
        uint32_t most = k, pushing = 0;
        for (uint32_t i = k; i < planes.count; ++i) {
            if (by_plane ? i != k : planes.part(i) != planes.part(k)) continue;
            done[i] = true;
            push += share.of[i] * planes.plane[i].normal;
            pushing += share.of[i] > 0;
            if (share.of[i] > share.of[most]) most = i;
        }
        const double depth_m = glm::length(push);
        if (!(depth_m > enough * contact.depth_m)) continue;
        Contact part = contact;
        part.face = planes.plane[most].face;
        part.side = planes.plane[most].side;
        part.barycentric = barycentric_of(surface, part.face, surface.lattice.units(contact.proxy_m));
        part.facet_normal = planes.plane[most].normal;
        part.normal = pushing == 1 ? part.facet_normal : push / depth_m;
        part.depth_m = depth_m;
        keep(part);
        sum_m += depth_m;
    }
    if (count_ == first) return keep(contact);
    const std::span<Contact> parts(contacts_.data() + first, count_ - first);
    for (Contact& part : parts) part.lag_m = part.depth_m / sum_m * contact.lag_m;
    std::sort(parts.begin(), parts.end(), [](const Contact& a, const Contact& b) {
        return a.depth_m != b.depth_m ? a.depth_m > b.depth_m : a.face < b.face;
    });
}

} // namespace haptel::runtime
