// Joins objects at rest that touch or cross each other into one surface.
//
// Take two boxes laid side by side. If each had a proxy of its own, the proxy that slides over the seam would meet the
// side wall of the second box, which is part of that closed mesh although nobody can get there. The joined surface has
// the faces of all of them, each with its object, and one proxy keeps off them all: a ball, which needs no links from
// object to object (contact/end_contact.h) and is kept off what lies inside of another object or flush with it. Objects
// that do not meet are not joined, nor is one that lies wholly inside another: a hand pressed through a soft ball still
// finds the hard one within.
#pragma once

#include "runtime/geometry/placement.h"
#include "runtime/surface/loading.h"
#include "runtime/surface/surface.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptel::runtime {

struct PlacedSurface {
    std::shared_ptr<const Surface> surface;
    Placement placement;
};

// Those of the surfaces that meet, by their numbers in rising order.
struct MeetingSurfaces {
    std::vector<uint32_t> numbers;
    std::string error; // why they cannot be joined: too many triangles. Then each is to be touched by itself.
};
std::vector<MeetingSurfaces> find_meeting(std::span<const PlacedSurface> surfaces, const Loading* loading = nullptr);

// Beyond this joining takes too long, and too much memory.
inline constexpr std::size_t joined_triangles_max = 4'000'000;

// The named surfaces as one, in the space that they are placed in. Origin::part is an index into `numbers`. Where faces
// of several lie on each other, those of the first are kept.
SurfaceResult join(std::span<const PlacedSurface> surfaces, std::span<const uint32_t> numbers,
                   const Loading* loading = nullptr);

} // namespace haptel::runtime
