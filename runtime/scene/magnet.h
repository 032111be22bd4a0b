// The pull of a surface on a hand outside of it.
//
// A potential of the distance s to the surface alone, U = F r (2 x^2 - 4/3 x^3) with x = s / r, so that no closed path
// gives energy: the pull, 4 F x (1 - x), is 0 at the surface, F at half its reach r, and 0 again from there on. Where
// two places of the surface are equally near its direction turns at once, but U has no step there and, as any smallest
// of several, no valley: such a ridge gives no energy either.
#pragma once

namespace haptel::runtime {

struct Magnet {
    double force_n = 0; // >= 0, the largest pull; 0: none
    double reach_m = 0; // > 0 if it pulls

    bool acts() const { return force_n > 0; }
    double pull_n(double distance_m) const noexcept
    {
        const double x = distance_m / reach_m;
        return x > 0 && x < 1 ? 4 * force_n * x * (1 - x) : 0.0;
    }
};

} // namespace haptel::runtime
