// Pictures in GLSL text: the cubic B-spline of lang/math/spline.h, and the other images of the same picture, read from
// haptel_images as lang/emit_glsl/image_words.h lays them out.
#pragma once

#include "lang/emit/helper_text.h"

namespace haptel::emit_glsl {

inline constexpr emit::HelperText image_helpers[] = {
    {"haptel_image_word", R"(uniform highp usampler2D haptel_images;
uint haptel_image_word(int place)
{
    int width = textureSize(haptel_images, 0).x;
    return texelFetch(haptel_images, ivec2(place % width, place / width), 0).x;
})"},
    {"haptel_image_part", R"(int haptel_image_part(int image, int channel, int level)
{
    int channels = int(haptel_image_word(image + 2)), levels = int(haptel_image_word(image + 3));
    int part = min(channel, channels - 1) * levels + min(level, levels - 1);
    return int(haptel_image_word(image + 6)) + WORDS_OF_IMAGE * part;
})"},
    {"haptel_image_channel", R"(int haptel_image_channel(int image, uint colour)
{
    if (image == 0 || haptel_image_word(image + 6) == 0u) return image;
    return haptel_image_part(image, 1 + clamp(int(colour), 0, 3), int(haptel_image_word(image + 5)));
})"},
    {"haptel_image_coarser", R"(int haptel_image_coarser(int image, uint by)
{
    if (image == 0 || haptel_image_word(image + 6) == 0u) return image;
    int levels = int(haptel_image_word(image + 3)), level = int(haptel_image_word(image + 5));
    int more = clamp(int(by), 0, levels - level);
    return haptel_image_part(image, int(haptel_image_word(image + 4)), level + more);
})"},
    {"haptel_image_width", R"(uint haptel_image_width(int image)
{
    return image == 0 ? 1u : haptel_image_word(image);
})"},
    {"haptel_image_height", R"(uint haptel_image_height(int image)
{
    return image == 0 ? 1u : haptel_image_word(image + 1);
})"},
    {"haptel_spline_texel", R"(int haptel_spline_texel(int index, int count, uint edge)
{
    int period = edge == TILED ? count : 2 * count;
    int within = (index + period) % period; // from -1 on
    if (edge == CLAMPED) return clamp(index + 1, 0, count + 1);
    return within < count ? within : 2 * count - 1 - within;
})"},
    {"haptel_spline_weights", R"(vec4 haptel_spline_weights(float f, uint order)
{
    float g = 1.0 - f;
    if (order == 0u)
        return vec4(g * g * g, 4.0 - f * f * (6.0 - 3.0 * f), 4.0 - g * g * (6.0 - 3.0 * g), f * f * f) / 6.0;
    if (order == 1u) return vec4(-(g * g) / 2.0, f * (1.5 * f - 2.0), -(g * (1.5 * g - 2.0)), f * f / 2.0);
    if (order == 2u) return vec4(g, 3.0 * f - 2.0, 3.0 * g - 2.0, f);
    if (order == 3u) return vec4(-1.0, 3.0, -3.0, 1.0);
    return vec4(0.0);
})"},
    {"haptel_spline_place", R"(/* Within one period of the image, or its border. */
float haptel_spline_place(float at, int count, uint edge)
{
    float size = float(count), period = edge == TILED ? size : size + size;
    if (edge == CLAMPED) return clamp(at, -3.0, size + 2.0);
    haptel_precise float periods = period * floor(at / period);
    haptel_precise float within = at - periods;
    return within;
})"},
    {"haptel_spline",
     R"(/* The cubic B-spline of an image at a place in texels; a byte of `orders` for how often by x, by y, and the edges. */
float haptel_spline(int image, float x, float y, uint orders)
{
    uint edges = orders >> 16 & 3u, edge = edges < 3u ? edges : MIRRORED;
    if (image == 0) return 0.0;
    if (!haptel_is_finite(x) || !haptel_is_finite(y)) return uintBitsToFloat(0x7fc00000u);
    int width = int(haptel_image_word(image)), height = int(haptel_image_word(image + 1));
    float column = haptel_spline_place(x, width, edge), row = haptel_spline_place(y, height, edge);
    float first_column = floor(column), first_row = floor(row);
    vec4 by_column = haptel_spline_weights(column - first_column, orders & 255u);
    vec4 by_row = haptel_spline_weights(row - first_row, orders >> 8 & 255u);
    int stride = edge == CLAMPED ? width + 2 : width;
    int texels = int(haptel_image_word(image + 7 + int(edge)));
    float sum = 0.0;
    for (int j = 0; j < 4; ++j) {
        int line = texels + haptel_spline_texel(int(first_row) - 1 + j, height, edge) * stride;
        float along = 0.0;
        for (int i = 0; i < 4; ++i) {
            int texel = line + haptel_spline_texel(int(first_column) - 1 + i, width, edge);
            along += by_column[i] * uintBitsToFloat(haptel_image_word(texel));
        }
        sum += by_row[j] * along;
    }
    return sum;
})"},
};

} // namespace haptel::emit_glsl
