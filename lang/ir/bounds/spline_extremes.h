// How far a spline goes within a rectangle of places: from the Bezier points of its patches.
#pragma once

#include "lang/abi/abi.h"
#include "lang/ir/bounds/interval.h"

namespace haptel::ir {

// Places along one axis, in texels: finite, low <= high.
struct PlaceRange {
    double low, high;
};

// Everything that spline(image, x, y, orders) can be in there, its rounding included, and up to a few percent more.
// Takes time and a little memory by the cells that the rectangle meets. `orders`: at most 3 along each axis.
Interval spline_extremes(const haptel_image& image, PlaceRange x, PlaceRange y, uint32_t orders);

} // namespace haptel::ir
