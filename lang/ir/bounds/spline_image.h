// An image as textures read it, with what is known of its derivatives: made once from texels, then immutable.
#pragma once

#include "lang/abi/abi.h"
#include "lang/ir/bounds/interval.h"
#include "lang/ir/ir.h"

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace haptel::ir {

// What a program reads of a picture besides its brightness: red, green, blue, alpha, a bit each, and coarser levels. No
// more is made of a file, as each costs what the brightness does.
struct ImageParts {
    uint8_t channels = 0;
    bool levels = false;
    auto operator<=>(const ImageParts&) const = default;
};

ImageParts parts_read(const Module& module);

// Numbers of a picture's texels, row after row, the lowest first.
struct ImageTexels {
    std::span<const double> brightness;
    std::span<const double> colours[4] = {}; // red, green, blue, alpha; empty: the brightness, and an alpha of 1
    int64_t width = 0, height = 0;
};

class SplineImage {
public:
    static constexpr int32_t side_max = 1 << 15;
    // Of some 4000 a side: they take a quarter of a microsecond and 32 bytes each, in each channel.
    static constexpr int64_t texels_max = int64_t{1} << 24;

    // Null, with the reason in `error`: sides below 1 or beyond the greatest, texels that are no finite numbers.
    static std::shared_ptr<const SplineImage> make(const ImageTexels& texels, ImageParts parts, std::string& error);
    SplineImage(const SplineImage&) = delete;
    SplineImage& operator=(const SplineImage&) = delete;

    const haptel_image& view() const { return views[0]; }
    // As image_part() of spline.h; level 0 or above.
    const SplineImage& part(int32_t channel, int32_t level) const;

    // Everything that spline(&view(), x, y, orders) can be for places in these intervals, rounding included. The first
    // wide place of each `orders` takes a look at the whole image: 10 to 60 ns for each texel. Safe from any thread.
    Interval bounds(const Interval& x, const Interval& y, uint32_t orders) const;

private:
    SplineImage() = default;
    static std::shared_ptr<SplineImage> make_one(std::span<const double> texels, int64_t width, int64_t height);
    void add_parts(const ImageTexels& texels, ImageParts wanted);
    const Interval& over_all(uint32_t orders) const;

    std::vector<double> coefficients[3];                  // by HAPTEL_EDGE_*
    std::vector<std::shared_ptr<const SplineImage>> made; // the parts but this one itself
    std::vector<const SplineImage*> parts;                // by channel and level; empty: this one alone
    std::vector<haptel_image> views;                      // likewise, of this one first
    struct Known {
        std::once_flag asked;
        Interval found;
    };
    mutable Known known[3][4][4]; // by HAPTEL_EDGE_*, orders by x, by y
};

} // namespace haptel::ir
