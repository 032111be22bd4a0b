// A ball that is put down where it overlaps something: as large as fits, and out of there.
#include "runtime/contact/sphere_contact.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// A ball smaller than this is a point that rounding can move through a face.
constexpr double least_radius = 0x1p20;

// A ball that moves out looks so many times as far as it lacks, for grooves hold it farther out than their walls are
// near, grows at once by no more than this of what it has looked at, and tries so many ways, each half as long as one
// that was not free. Once it has looked at so many faces it stays where it has come to.
constexpr double out_most = 4, out_of_room = 0.9;
constexpr int ways_out_most = 32;
constexpr uint64_t faces_out_most = 1 << 15;

} // namespace

// As large as fits there.
void SphereContact::place(const glm::dvec3& at) noexcept
{
    proxy_.at = at;
    if (!find_around(0)) {
        ++counters_.walks_cut;
        grown_ = 0;
        return;
    }
    grown_ = faces_.distance(at, radius_);
    placed_ = grown_ >= std::min(least_radius, radius_);
}

// The ball as it is keeps in front of the planes all along a straight way out of those of the larger ball: it meets
// nothing that it has not looked at.
bool SphereContact::move_out(double most_m) noexcept
{
    if (!placed_ || grown_ >= radius_ || (radius_ - grown_) * surface_->lattice.unit_m > most_m) return false;
    const double before = grown_;
    const uint64_t seen = counters_.triangles_tested;
    double share = 1;
    bool looked = false; // from here
    for (int tries = 0; tries < ways_out_most && radius_ - grown_ > centre_settled * radius_; ++tries) {
        const double lacks = radius_ - grown_;
        if (!looked && around_.room(proxy_.at) < 0.5 * lacks) {
            if (counters_.triangles_tested - seen > faces_out_most || !find_around(out_most * lacks)) break;
            looked = true;
        }
        const double room = around_.room(proxy_.at), more = share * std::min(lacks, out_of_room * room);
        faces_.pick(proxy_.at, grown_ + more + 2 * distance_rounding, room, NearFaces::Screened::no,
                    NearFaces::Laid::here);
        const glm::dvec3 out = project(faces_.rows(), proxy_.at, proxy_.at, distance_rounding).at;
        bool free = glm::distance(proxy_.at, out) <= room;
        for (const HalfSpace& space : faces_.rows())
            free = free && glm::dot(space.normal, out) - space.offset >= -2 * distance_rounding;
        share = free ? std::min(1.0, 2 * share) : 0.5 * share;
        if (!free) continue;
        proxy_.at = out;
        looked = false;
        grow();
    }
    forget();
    return grown_ > before;
}

} // namespace haptel::runtime
