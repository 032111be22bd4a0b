#include "runtime/contact/crease_rows.h"

#include "runtime/contact/project.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace haptel::runtime {

namespace {

// What rounding alone leaves to a piece is none.
constexpr double least_share = 1e-12;

// Most are on facets, and are asked nothing more.
bool may_be_on_crease(const Surface& surface, const Contact& contact)
{
    return contact.normal != contact.facet_normal && !contact.by_shaft && !contact.unsettled && !contact.on_crease &&
           on_crease(surface, contact.face, contact.side, contact.barycentric);
}

} // namespace

std::span<const Contact> CreaseRows::of(const Surface& surface, std::span<const Contact> contacts) noexcept
{
    const auto is_one = [&](const Contact& contact) { return may_be_on_crease(surface, contact); };
    if (std::none_of(contacts.begin(), contacts.end(), is_one)) return contacts;
    count_ = 0;
    for (std::size_t i = 0; i < contacts.size(); ++i)
        add(surface, contacts[i], rows_.size() - count_ - (contacts.size() - i - 1));
    return {rows_.data(), count_};
}

// At most so many rows as there is room for.
void CreaseRows::add(const Surface& surface, const Contact& contact, std::size_t room) noexcept
{
    struct Facet {
        uint32_t face, side;
        uint32_t piece; // number of its shading normal, by which pieces differ
    };
    std::array<Facet, facets_most> facets;
    std::array<HalfSpace, facets_most> free; // before each facet, the proxy at 0
    std::size_t count = 0;
    const bool is_on_crease = may_be_on_crease(surface, contact);
    bool closed = is_on_crease;
    const auto meets = [&](uint32_t face, uint32_t side, uint32_t corner) {
        if (count < facets_most) {
            facets[count] = {face, side, surface.faces[face].fan_or_part[corner][side]};
            free[count] = {surface.facet_normal(face, side), 0};
        }
        ++count;
    };
    if (const auto [on, i] = feature_at(contact.barycentric); closed && on == Feature::On::vertex) {
        closed = for_each_sector(surface, {contact.face, i, contact.side},
                                 [&](const Sector& sector) { meets(sector.face, sector.side, sector.corner); });
    } else if (closed) {
        const SideEdge link = surface.faces[contact.face].link[i][contact.side];
        closed = link.face() != contact.face;
        meets(contact.face, contact.side, i);
        meets(link.face(), link.side(), link.edge());
        facets[0].piece = 0, facets[1].piece = 1; // at one end they may be the same
    }
    const glm::dvec3 pushed_m = contact.depth_m * contact.normal;
    Projection<glm::dvec3> held;
    if (closed && count <= facets_most)
        held = project({free.data(), count}, -pushed_m, glm::dvec3(0), surface.lattice.unit_m);
    const double pushes_m = std::accumulate(held.push.begin(), held.push.begin() + std::ptrdiff_t(held.count), 0.0);
    if (held.count == 0 || held.count > room || pushes_m > opposed_most * contact.depth_m) {
        rows_[count_] = contact;
        rows_[count_++].on_crease |= is_on_crease;
        return;
    }
    const std::size_t first = count_;
    double depth_m = 0;
    glm::dvec3 lag_m = contact.lag_m + pushed_m;
    for (std::size_t i = 0; i < held.count; ++i) {
        const Facet& facet = facets[held.active[i]];
        const glm::dvec3 normal = free[held.active[i]].normal;
        glm::dvec3 push_m(0);
        bool told = false; // its piece, by a facet before
        for (std::size_t j = 0; j < held.count; ++j) {
            if (facets[held.active[j]].piece != facet.piece) continue;
            told |= j < i;
            push_m += held.push[j] * free[held.active[j]].normal;
        }
        const double piece_m = glm::length(push_m);
        if (told || !(piece_m > least_share * contact.depth_m)) continue;
        Contact& row = rows_[count_++] = contact;
        row.face = facet.face;
        row.side = facet.side;
        row.barycentric = barycentric_of(surface, row.face, surface.lattice.units(contact.proxy_m));
        row.facet_normal = normal;
        row.depth_m = row.pressed_m = piece_m;
        row.normal = push_m / piece_m;
        depth_m += row.depth_m;
        lag_m -= push_m;
    }
    const std::span<Contact> rows(rows_.data() + first, count_ - first);
    for (Contact& row : rows) row.lag_m = row.depth_m / depth_m * lag_m;
    std::ranges::sort(rows, std::greater(), &Contact::depth_m);
}

} // namespace haptel::runtime
