// The cubic B-spline of an image at a place, and its derivatives: what Op::spline means, for any real type T.
//
// Places are in texels: texel (i, j) is at (i, j). Each operation asks for one derivative, `orders`: so often by x, so
// often by y, and what is outside of the edges. A cubic has three derivatives: a fourth is 0. Far outside a clamped
// image is flat; a tiled or mirrored one has no value at an infinite place.
#pragma once

#include "lang/abi/abi.h"

#include <cmath>
#include <cstdint>

namespace haptel::ir {

// Coefficients that matter along each axis.
constexpr uint32_t spline_support = 4;

constexpr uint32_t spline_order(uint32_t by_x, uint32_t by_y, uint32_t edge = HAPTEL_EDGE_CLAMPED)
{
    return by_x | by_y << 8 | edge << 16;
}
constexpr uint32_t spline_order_along(uint32_t orders, uint32_t axis)
{
    return orders >> 8 * axis & 255;
}
constexpr uint32_t spline_edges = 3;
constexpr uint32_t spline_edge(uint32_t orders)
{
    const uint32_t edge = orders >> 16 & 3;
    return edge < spline_edges ? edge : uint32_t{HAPTEL_EDGE_MIRRORED};
}

inline int32_t image_width(const haptel_image* image)
{
    return image ? image->width : 1;
}
inline int32_t image_height(const haptel_image* image)
{
    return image ? image->height : 1;
}

// What else there is of the same picture. Total: numbers count as the nearest that there is.
inline const haptel_image* image_part(const haptel_image* image, int32_t channel, int32_t level)
{
    const int32_t nearest_channel = channel < image->channels ? channel : image->channels - 1;
    const int32_t nearest_level = level < image->levels ? level : image->levels - 1;
    return image->parts + nearest_channel * image->levels + nearest_level;
}
inline const haptel_image* image_channel(const haptel_image* image, int32_t colour)
{
    if (!image || !image->parts) return image;
    return image_part(image, 1 + (colour < 0 ? 0 : colour > 3 ? 3 : colour), image->level);
}
inline const haptel_image* image_coarser(const haptel_image* image, int32_t levels)
{
    if (!image || !image->parts) return image;
    const int32_t left = image->levels - image->level;
    return image_part(image, image->channel, image->level + (levels < 0 ? 0 : levels < left ? levels : left));
}

// How much each of four neighbouring coefficients counts, `fraction` (0 to 1) of the way from the second to the third.
template <typename T>
void spline_weights(const T& fraction, uint32_t order, T (&weights)[spline_support])
{
    const T f = fraction, g = T(1) - f;
    switch (order) {
    case 0:
        weights[0] = g * g * g / T(6);
        weights[1] = (T(4) - f * f * (T(6) - T(3) * f)) / T(6);
        weights[2] = (T(4) - g * g * (T(6) - T(3) * g)) / T(6);
        weights[3] = f * f * f / T(6);
        return;
    case 1:
        weights[0] = -(g * g) / T(2);
        weights[1] = f * (T(1.5) * f - T(2));
        weights[2] = -(g * (T(1.5) * g - T(2)));
        weights[3] = f * f / T(2);
        return;
    case 2:
        weights[0] = g;
        weights[1] = T(3) * f - T(2);
        weights[2] = T(3) * g - T(2);
        weights[3] = f;
        return;
    case 3:
        weights[0] = T(-1);
        weights[1] = T(3);
        weights[2] = T(-3);
        weights[3] = T(1);
        return;
    default:
        for (T& weight : weights) weight = T(0);
    }
}

// Coefficients from one row to the next: a clamped image has those around it, too.
inline int64_t spline_stride(int64_t width, uint32_t edge)
{
    return edge == HAPTEL_EDGE_CLAMPED ? width + 2 : width;
}

// Where coefficient `index` of a line over `count` texels is stored, for any index not too far outside.
inline int64_t spline_texel(int64_t index, int64_t count, uint32_t edge)
{
    const auto within = [index](int64_t period) { return (index % period + period) % period; };
    if (edge == HAPTEL_EDGE_TILED) return within(count);
    if (edge == HAPTEL_EDGE_CLAMPED) return index < 0 ? 0 : index < count ? index + 1 : count + 1;
    const int64_t folded = within(2 * count);
    return folded < count ? folded : 2 * count - 1 - folded;
}

// Where along one axis: four texels and how much each counts.
template <typename T>
struct SplineSpan {
    int64_t texel[spline_support];
    T weight[spline_support];

    // False where `at` is no place.
    bool set(T at, int64_t count, uint32_t order, uint32_t edge)
    {
        using std::floor;
        const T size = T(static_cast<double>(count));
        if (edge == HAPTEL_EDGE_CLAMPED) {
            at = at < T(-3) ? T(-3) : at > size + T(2) ? size + T(2) : at; // flat from there on
        } else {
            const T period = edge == HAPTEL_EDGE_TILED ? size : size + size;
            at = at - period * T(floor(T(at / period)));
        }
        if (!(at - at == T(0))) return false;
        const T cell = floor(at);
        const auto first = static_cast<int64_t>(static_cast<double>(cell)) - 1;
        for (uint32_t i = 0; i < spline_support; ++i) texel[i] = spline_texel(first + i, count, edge);
        spline_weights(T(at - cell), order, weight);
        return true;
    }
};

template <typename T>
T spline(const haptel_image* image, const T& x, const T& y, uint32_t orders)
{
    if (!image) return T(0);
    const uint32_t edge = spline_edge(orders);
    SplineSpan<T> column, row;
    const bool is_place = column.set(x, image->width, spline_order_along(orders, 0), edge) &&
                          row.set(y, image->height, spline_order_along(orders, 1), edge);
    if (!is_place) return x - x + (y - y);
    const double* coefficients = image->coefficients[edge];
    const int64_t stride = spline_stride(image->width, edge);
    T sum(0);
    for (uint32_t j = 0; j < spline_support; ++j) {
        const double* line = coefficients + row.texel[j] * stride;
        T along(0);
        for (uint32_t i = 0; i < spline_support; ++i) along = along + column.weight[i] * T(line[column.texel[i]]);
        sum = sum + row.weight[j] * along;
    }
    return sum;
}

} // namespace haptel::ir
