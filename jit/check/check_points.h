// Where textures are checked: random points of a box in general position, circles, and the edges of what f64 holds.
#pragma once

#include "jit/check/check_gradient.h"
#include "lang/abi/abi.h"

#include <cstdint>
#include <vector>

namespace haptel::jit {

class CheckPoints {
public:
    CheckPoints(const CheckBox& within, uint64_t with_seed);

    // Largest side of the box, metres.
    double side_m() const { return side; }

    // n and uv are affine in p, so that their Jacobians are exact; time is 1.25 s.
    haptel_point at(const double (&p_m)[3]) const;

    // The same for the same seed and index, whatever the order.
    haptel_point random(uint64_t index) const;

    // Signed zeros, subnormals, whole numbers, corners of the box, and coordinates up to 1e18 m, in all combinations.
    std::vector<haptel_point> edges() const;

    // Radius a sixteenth of the smallest side, round a random point, in a random plane; `share` runs from 0 to 1.
    // Tangent is dp/dshare.
    struct CirclePoint {
        haptel_point point;
        double tangent_m[3];
    };
    CirclePoint circle(uint64_t index, double share) const;

private:
    CheckBox box;
    uint64_t seed;
    double side;

    double uniform(uint64_t index, uint64_t which) const; // [0, 1)
};

} // namespace haptel::jit
