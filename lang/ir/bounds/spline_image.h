// An image as textures read it, with what is known of its derivatives: made once from texels, then immutable.
#pragma once

#include "lang/abi/abi.h"
#include "lang/ir/bounds/interval.h"

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace haptel::ir {

class SplineImage {
public:
    static constexpr int32_t side_max = 1 << 15;
    // Of some 4000 a side: they take a quarter of a microsecond and 32 bytes each.
    static constexpr int64_t texels_max = int64_t{1} << 24;

    // Row after row, the lowest first. Null, with the reason in `error`: sides below 1 or beyond the greatest, texels
    // that are no finite numbers.
    static std::shared_ptr<const SplineImage> make(std::span<const double> texels, int64_t width, int64_t height,
                                                   std::string& error);
    SplineImage(const SplineImage&) = delete;
    SplineImage& operator=(const SplineImage&) = delete;

    const haptel_image& view() const { return image; }

    // Everything that spline(&view(), x, y, orders) can be for places in these intervals, rounding included. The first
    // wide place of each `orders` takes a look at the whole image: 10 to 60 ns for each texel. Safe from any thread.
    Interval bounds(const Interval& x, const Interval& y, uint32_t orders) const;

private:
    SplineImage() = default;
    const Interval& over_all(uint32_t orders) const;

    std::vector<double> coefficients[3]; // by HAPTEL_EDGE_*
    haptel_image image{};
    struct Known {
        std::once_flag asked;
        Interval found;
    };
    mutable Known known[3][4][4]; // by HAPTEL_EDGE_*, orders by x, by y
};

} // namespace haptel::ir
