#include "runtime/render/smooth_rows.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// At one place of a crease the normals differ.
bool are_one(const Foot& a, const Foot& b)
{
    return a.share > 0 && b.share > 0 && !a.is_flat() && !b.is_flat() &&
           glm::distance(a.normal, b.normal) < one_place &&
           glm::distance(a.at_m, b.at_m) < one_place * glm::length(a.line_m[0]);
}

// The sum of both, held off the same place.
void add(Contact& row, const Contact& contact)
{
    const glm::dvec3 groove = glm::cross(row.normal, contact.normal);
    const double sine = glm::length(groove);
    const glm::dvec3 centre_m = row.proxy_m + row.radius_m * row.normal;
    const glm::dvec3 way_m = row.depth_m * row.normal + contact.depth_m * contact.normal;
    const double depth_m = glm::length(way_m);
    if (!(depth_m > 0)) return;
    row.normal = way_m / depth_m;
    row.depth_m = depth_m;
    row.lag_m += contact.lag_m;
    row.proxy_m = centre_m - row.radius_m * row.normal;
    if (row.rolls < 0 && sine < one_place) return; // as one facet
    if (row.rolls < 0)
        row.groove = groove / sine;
    else if (std::fabs(glm::dot(row.groove, contact.normal)) > one_place)
        row.groove = glm::dvec3(0); // a third one ends it
    row.rolls = row.radius_m / depth_m;
}

} // namespace

std::span<const Contact> SmoothRows::of(const Surface& surface, std::span<const Contact> contacts, const Shaft& way_m,
                                        FacetLines& lines) noexcept
{
    std::array<Foot, CreaseRows::rows_most> feet;
    // The first at each end: a point that is held as a ball touches all of them a little apart.
    std::array<const Contact*, 2> first{};
    std::size_t count = 0;
    for (const Contact& contact : contacts.first(std::min(contacts.size(), rows_.size()))) {
        Foot& foot = feet[count];
        foot.share = 0;
        if (!contact.by_shaft && !contact.unsettled && !contact.on_crease) {
            const Contact*& end = first[contact.along > 0];
            if (!end) end = &contact;
            const glm::dvec3 centre_m = end->proxy_m + end->radius_m * end->normal;
            foot = smooth_foot(surface, contact, centre_m - way_m.at(contact.along), lines);
        }
        std::size_t same = 0;
        while (same < count && !(rows_[same].along == contact.along && are_one(feet[same], foot))) ++same;
        if (same < count)
            add(rows_[same], contact);
        else
            rows_[count++] = contact;
    }
    return {rows_.data(), count};
}

} // namespace haptel::runtime
