// Pictures in C text: the cubic B-spline of lang/math/spline.h, and the other images of the same picture.
#pragma once

#include "lang/emit/helper_text.h"

namespace haptel::emit_c {

inline constexpr emit::HelperText image_helpers[] = {
    {"haptel_image_part",
     R"(static const haptel_image* haptel_image_part(const haptel_image* const image, const int32_t channel, const int32_t level)
{
    const int32_t nearest_channel = channel < image->channels ? channel : image->channels - 1;
    const int32_t nearest_level = level < image->levels ? level : image->levels - 1;
    return image->parts + (nearest_channel * image->levels + nearest_level);
})"},
    {"haptel_image_channel",
     R"(static const haptel_image* haptel_image_channel(const haptel_image* const image, const uint32_t colour)
{
    const int32_t channel = (int32_t)colour < 0 ? 0 : (int32_t)colour > 3 ? 3 : (int32_t)colour;
    return image && image->parts ? haptel_image_part(image, 1 + channel, image->level) : image;
})"},
    {"haptel_image_coarser",
     R"(static const haptel_image* haptel_image_coarser(const haptel_image* const image, const uint32_t levels)
{
    int32_t more = (int32_t)levels < 0 ? 0 : (int32_t)levels;
    if (!image || !image->parts) return image;
    if (more > image->levels - image->level) more = image->levels - image->level;
    return haptel_image_part(image, image->channel, image->level + more);
})"},
    {"haptel_image_width", R"(static uint32_t haptel_image_width(const haptel_image* const image)
{
    return image ? (uint32_t)image->width : 1u;
})"},
    {"haptel_image_height", R"(static uint32_t haptel_image_height(const haptel_image* const image)
{
    return image ? (uint32_t)image->height : 1u;
})"},
    {"haptel_spline_texel",
     R"(static int64_t haptel_spline_texel(const int64_t index, const int64_t count, const uint32_t edge)
{
    const int64_t period = edge == HAPTEL_EDGE_TILED ? count : 2 * count;
    const int64_t within = (index % period + period) % period;
    if (edge == HAPTEL_EDGE_CLAMPED) return index < 0 ? 0 : index < count ? index + 1 : count + 1;
    return within < count ? within : 2 * count - 1 - within;
})"},
    {"haptel_spline_weights",
     R"(static void haptel_spline_weights(const real f, const uint32_t order, real* const weights)
{
    const real g = 1 - f;
    real inner;
    weights[0] = weights[1] = weights[2] = weights[3] = 0;
    if (order == 0) {
        weights[0] = g * g * g / 6;
        inner = 3 * f;
        inner = f * f * (6 - inner);
        weights[1] = (4 - inner) / 6;
        inner = 3 * g;
        inner = g * g * (6 - inner);
        weights[2] = (4 - inner) / 6;
        weights[3] = f * f * f / 6;
    } else if (order == 1) {
        weights[0] = -(g * g) / 2;
        inner = (real)1.5 * f;
        weights[1] = f * (inner - 2);
        inner = (real)1.5 * g;
        weights[2] = -(g * (inner - 2));
        weights[3] = f * f / 2;
    } else if (order == 2) {
        weights[0] = g;
        inner = 3 * f;
        weights[1] = inner - 2;
        inner = 3 * g;
        weights[2] = inner - 2;
        weights[3] = f;
    } else if (order == 3) {
        weights[0] = -1;
        weights[1] = 3;
        weights[2] = -3;
        weights[3] = 1;
    }
})"},
    {"haptel_spline_along",
     R"(/* Four texels along one axis and how much each counts; false where `at` is no place. */
static int haptel_spline_along(real at, const int32_t count, const uint32_t order, const uint32_t edge,
                               int64_t* const texels, real* const weights)
{
    const real size = (real)count, period = edge == HAPTEL_EDGE_TILED ? size : size + size;
    real cell;
    int64_t first;
    int i;
    if (edge == HAPTEL_EDGE_CLAMPED) {
        at = at < -3 ? -3 : at > size + 2 ? size + 2 : at;
    } else {
        const real periods = period * floor$(at / period);
        at = at - periods;
    }
    if (!(at - at == 0)) return 0;
    cell = floor$(at);
    first = (int64_t)cell - 1;
    for (i = 0; i < 4; ++i) texels[i] = haptel_spline_texel(first + i, count, edge);
    haptel_spline_weights(at - cell, order, weights);
    return 1;
})"},
    {"haptel_spline",
     R"(/* The cubic B-spline of an image at a place in texels; a byte of `orders` for how often by x, by y, and the edges. */
static real haptel_spline(const haptel_image* const image, const real x, const real y, const uint32_t orders)
{
    const uint32_t edges = orders >> 16 & 3u, edge = edges < 3u ? edges : (uint32_t)HAPTEL_EDGE_MIRRORED;
    int64_t columns[4], rows[4], stride;
    real by_column[4], by_row[4], sum = 0;
    int i, j;
    if (!image) return 0;
    if (!haptel_spline_along(x, image->width, orders & 255u, edge, columns, by_column) ||
        !haptel_spline_along(y, image->height, orders >> 8 & 255u, edge, rows, by_row))
        return x - x + (y - y);
    stride = edge == HAPTEL_EDGE_CLAMPED ? (int64_t)image->width + 2 : image->width;
    for (j = 0; j < 4; ++j) {
        const double* const line = image->coefficients[edge] + rows[j] * stride;
        real along = 0, part;
        for (i = 0; i < 4; ++i) {
            part = by_column[i] * (real)line[columns[i]];
            along = along + part;
        }
        part = by_row[j] * along;
        sum = sum + part;
    }
    return sum;
})"},
};

} // namespace haptel::emit_c
