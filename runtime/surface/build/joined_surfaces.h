// Objects at rest that touch or cross each other, as one surface to the probe.
//
// With a proxy for each object, one that slides over two boxes laid side by side would pass at their seam into the side
// of the second: for itself it is closed there. Joined, what lies inside the other or on it is no way any more, and one
// proxy slides from object to object by links as it does over one mesh. Objects that do not meet stay apart, nested
// ones too: a hand pressed through a soft ball still finds the hard one inside.
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

// The surfaces named, in the space that they are placed in. `part` of an origin counts in `numbers`. What lies on each
// other is kept of the first.
SurfaceResult join(std::span<const PlacedSurface> surfaces, std::span<const uint32_t> numbers,
                   const Loading* loading = nullptr);

} // namespace haptel::runtime
