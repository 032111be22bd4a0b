#include "lang/emit_c/helpers.h"

#include "lang/emit_c/written_number.h"
#include "lang/ir/elementary_functions.h"
#include "lang/ir/op_info.h"
#include "lang/math/two_over_pi.h"

#include <span>
#include <utility>
#include <vector>

namespace haptel::emit_c {

namespace {

struct Helper {
    std::string name, text;
};

// As lang/ir/semantics.h, lang/math/spline.h and lang/math/elementary_angle.cpp have it, callees first. `real` is
// double or float, and $ the ending of its functions; what is in capitals are numbers of numbers_of().
constexpr std::pair<const char*, const char*> written[] = {
    {"haptel_bits64", R"(static uint64_t haptel_bits64(const double a)
{
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
})"},
    {"haptel_real64", R"(static double haptel_real64(const uint64_t bits)
{
    double a;
    memcpy(&a, &bits, sizeof a);
    return a;
})"},
    {"haptel_bits32", R"(static uint32_t haptel_bits32(const float a)
{
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
})"},
    {"haptel_real32", R"(static float haptel_real32(const uint32_t bits)
{
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
})"},
    {"haptel_product",
     R"(static void haptel_product(const uint64_t a, const uint64_t b, uint64_t* const high, uint64_t* const low)
{
    const uint64_t half = 0xffffffffu, a0 = a & half, a1 = a >> 32, b0 = b & half, b1 = b >> 32;
    const uint64_t lowest = a0 * b0, first = a1 * b0 + (lowest >> 32), second = a0 * b1 + (first & half);
    *high = a1 * b1 + (first >> 32) + (second >> 32);
    *low = second << 32 | (lowest & half);
})"},
    {"haptel_two_over_pi", R"(static uint64_t haptel_two_over_pi(const int first_bit)
{
    static const uint64_t words[] = {TWO_OVER_PI};
    const uint64_t* const word = words + first_bit / 64;
    const int shift = first_bit % 64;
    return shift == 0 ? word[0] : word[0] << shift | word[1] >> (64 - shift);
})"},
    {"haptel_reduce_angle",
     R"(/* Any angle from 2^20 on as quarter turns, whole, and a rest in two parts: its product with 192 bits of 2 / pi. */
static void haptel_reduce_angle(const double angle, double* const quarters, double* const high, double* const low)
{
    const uint64_t word = haptel_bits64(angle), one = 1, significand = (word & ((one << 52) - 1)) | one << 52;
    const int first = (int)(word >> 52) - 1075 - 2 + 64;
    uint64_t lowest_high, lowest_low, middle_high, middle_low, upper, lower, turns;
    int is_beyond_half, zeros = 0;
    *quarters = *high = *low = (double)NAN;
    if (!(angle <= 1.7976931348623157e308)) return;
    haptel_product(significand, haptel_two_over_pi(first + 128), &lowest_high, &lowest_low);
    haptel_product(significand, haptel_two_over_pi(first + 64), &middle_high, &middle_low);
    lower = middle_low + lowest_high;
    upper = significand * haptel_two_over_pi(first) + middle_high + (uint64_t)(lower < middle_low);
    turns = upper >> 62;
    upper = upper << 2 | lower >> 62;
    lower = lower << 2 | lowest_low >> 62;
    is_beyond_half = (upper >> 63) != 0;
    if (is_beyond_half) {
        ++turns;
        lower = 0u - lower;
        upper = ~upper + (uint64_t)(lower == 0);
    }
    while (zeros < 127 && (upper >> 63) == 0) {
        upper = upper << 1 | lower >> 63;
        lower <<= 1;
        ++zeros;
    }
    {
        const double sign = is_beyond_half ? -1.0 : 1.0;
        const double of_quarter = ldexp(sign * (double)(upper >> 11), -53 - zeros);
        const double rest_of_quarter = ldexp(sign * (double)(upper << 53 | lower >> 11), -117 - zeros);
        const double part_high = haptel_real64(haptel_bits64(of_quarter) & ~(uint64_t)0x7ffffff);
        const double part_low = of_quarter - part_high;
        const double product0 = of_quarter * QUARTER_REST, product1 = rest_of_quarter * QUARTER_UPPER;
        const double product2 = part_low * QUARTER_UPPER, product3 = part_high * QUARTER_UPPER;
        const double others = product2 + (product0 + product1);
        *quarters = (double)turns;
        *high = product3 + others;
        *low = (product3 - *high) + others;
    }
})"},
    {"haptel_min", R"(static real haptel_min(const real a, const real b)
{
    if (a != a || b != b) return a + b;
    if (a == b) return signbit(a) ? a : b;
    return a < b ? a : b;
})"},
    {"haptel_max", R"(static real haptel_max(const real a, const real b)
{
    if (a != a || b != b) return a + b;
    if (a == b) return signbit(a) ? b : a;
    return a < b ? b : a;
})"},
    {"haptel_sign", R"(static real haptel_sign(const real a)
{
    return a > 0 ? 1 : a < 0 ? -1 : a;
})"},
    {"haptel_mod", R"(static real haptel_mod(const real a, const real b)
{
    const real whole = floor$(a / b), cells = b * whole;
    return a - cells;
})"},
    {"haptel_length", R"(static real haptel_length(const real* const x, const int count)
{
    real most = fabs$(x[0]), scale = 1, unscale = 1, sum;
    int i;
    for (i = 1; i < count; ++i) most = haptel_max(most, fabs$(x[i]));
    if (most > LARGE) {
        scale = DOWN;
        unscale = UP;
    } else if (most < SMALL) {
        scale = UP;
        unscale = DOWN;
    }
    sum = x[0] * scale;
    sum = sum * sum;
    for (i = 1; i < count; ++i) {
        const real scaled = x[i] * scale, square = scaled * scaled;
        sum = sum + square;
    }
    return sqrt$(sum) * unscale;
})"},
    {"haptel_length2", R"(static real haptel_length2(const real a, const real b)
{
    real x[2];
    x[0] = a;
    x[1] = b;
    return haptel_length(x, 2);
})"},
    {"haptel_length3", R"(static real haptel_length3(const real a, const real b, const real c)
{
    real x[3];
    x[0] = a;
    x[1] = b;
    x[2] = c;
    return haptel_length(x, 3);
})"},
    {"haptel_length4", R"(static real haptel_length4(const real a, const real b, const real c, const real d)
{
    real x[4];
    x[0] = a;
    x[1] = b;
    x[2] = c;
    x[3] = d;
    return haptel_length(x, 4);
})"},
    {"haptel_polynomial", R"(static real haptel_polynomial(const real* const coefficients, int count, const real x)
{
    real sum = coefficients[--count];
    while (count > 0) {
        const real product = sum * x;
        sum = product + coefficients[--count];
    }
    return sum;
})"},
    {"haptel_sine_within_eighth", R"(static real haptel_sine_within_eighth(const real turns)
{
    static const real coefficients[] = {TURN_SINE};
    return turns * haptel_polynomial(coefficients, (int)(sizeof coefficients / sizeof(real)), turns * turns);
})"},
    {"haptel_cosine_within_eighth", R"(static real haptel_cosine_within_eighth(const real turns)
{
    static const real coefficients[] = {TURN_COSINE};
    const real square = turns * turns;
    const real rest = square * haptel_polynomial(coefficients, (int)(sizeof coefficients / sizeof(real)), square);
    return rest + 1;
})"},
    {"haptel_sinturn", R"(static real haptel_sinturn(const real a)
{
    const real way = a - nearbyint$(a), distance = fabs$(way);
    const real folded = distance > (real)0.25 ? (real)0.5 - distance : distance;
    const real size = folded > (real)0.125 ? haptel_cosine_within_eighth((real)0.25 - folded)
                                           : haptel_sine_within_eighth(folded);
    return signbit(way) ? -size : size;
})"},
    {"haptel_costurn", R"(static real haptel_costurn(const real a)
{
    const real way = a - nearbyint$(a), distance = fabs$(way);
    const real folded = distance > (real)0.25 ? (real)0.5 - distance : distance;
    const real size = folded > (real)0.125 ? haptel_sine_within_eighth((real)0.25 - folded)
                                           : haptel_cosine_within_eighth(folded);
    return distance > (real)0.25 ? -size : size;
})"},
    {"haptel_r_to_i", R"(static uint32_t haptel_r_to_i(const real a)
{
    if (a != a) return 0;
    if (a <= (real)-2147483648.0) return 0x80000000u;
    if (a >= (real)2147483647.0) return 0x7fffffffu;
    return (uint32_t)(int32_t)a;
})"},
    {"haptel_r_to_u", R"(static uint32_t haptel_r_to_u(const real a)
{
    if (a != a || a <= 0) return 0;
    if (a >= (real)4294967295.0) return 0xffffffffu;
    return (uint32_t)a;
})"},
    {"haptel_idiv", R"(static uint32_t haptel_idiv(const uint32_t a, const uint32_t b)
{
    if (b == 0) return 0;
    if (b == 0xffffffffu) return 0u - a;
    return (uint32_t)((int32_t)a / (int32_t)b);
})"},
    {"haptel_irem", R"(static uint32_t haptel_irem(const uint32_t a, const uint32_t b)
{
    if (b == 0 || b == 0xffffffffu) return 0;
    return (uint32_t)((int32_t)a % (int32_t)b);
})"},
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

std::string list_of(std::span<const double> numbers, bool is_single)
{
    std::string list;
    for (double number : numbers) list += (list.empty() ? "" : ", ") + literal(number, is_single);
    return list;
}

std::vector<std::pair<std::string, std::string>> numbers_of(bool is_single)
{
    using namespace ir::turn;
    constexpr auto& quarter = ir::elementary::Constants<double>::quarter_turn;
    constexpr double upper = ir::elementary::quarter_turn_upper;
    std::string words;
    for (uint64_t word : ir::elementary::two_over_pi_words)
        words += (words.empty() ? "" : ", ") + std::to_string(word) + "u";
    const auto number = [&](double wide, double single) { return literal(is_single ? single : wide, is_single); };
    return {{"real", is_single ? "float" : "double"},
            {"$", is_single ? "f" : ""},
            {"LARGE", number(0x1p500, 0x1p60)},
            {"SMALL", number(0x1p-500, 0x1p-60)},
            {"UP", number(0x1p600, 0x1p80)},
            {"DOWN", number(0x1p-600, 0x1p-80)},
            {"TURN_SINE", is_single ? list_of(sine_f32, true) : list_of(sine_f64, false)},
            {"TURN_COSINE", is_single ? list_of(cosine_f32, true) : list_of(cosine_f64, false)},
            {"QUARTER_UPPER", literal(upper)},
            {"QUARTER_REST", literal((quarter[0] - upper) + quarter[1])},
            {"TWO_OVER_PI", words}};
}

bool is_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Whether the word stands in the text, not as a part of another.
bool names(std::string_view text, std::string_view word)
{
    for (size_t at = 0; (at = text.find(word, at)) != text.npos; at += word.size())
        if ((at == 0 || !is_word(text[at - 1])) &&
            (at + word.size() == text.size() || !is_word(text[at + word.size()])))
            return true;
    return false;
}

std::string specialised(std::string_view text, const std::vector<std::pair<std::string, std::string>>& numbers)
{
    std::string made;
    for (size_t at = 0; at < text.size();) {
        size_t end = at + 1;
        if (is_word(text[at]))
            while (end < text.size() && is_word(text[end])) ++end;
        std::string_view word = text.substr(at, end - at);
        for (const auto& [name, value] : numbers)
            if (word == name) word = value;
        made += word;
        at = end;
    }
    return made;
}

template <typename F>
Helper elementary(const ir::OpInfo& info)
{
    using R = Written<F>;
    Lines lines;
    const R a(lines, lines.parameter()), b = info.arity == 2 ? R(lines, lines.parameter()) : a;
    const int result = ir::elementary::apply(info.op, a, b).result();
    const std::string type(R::type), name = "haptel_" + std::string(info.name);
    std::string text = "static " + type + " " + name + "(const " + type + " t0";
    if (info.arity == 2) text += ", const " + type + " t1";
    return {name, text + ")\n{\n" + lines.text_of(result) + "    return " + Lines::name(result) + ";\n}"};
}

// All of them, callees first.
std::vector<Helper> helpers(bool is_single)
{
    std::vector<Helper> all;
    const auto numbers = numbers_of(is_single);
    for (const auto& [name, text] : written) all.push_back({name, specialised(text, numbers)});
    for (const ir::OpInfo& info : ir::all_ops())
        if (ir::is_elementary(info.op)) all.push_back(is_single ? elementary<float>(info) : elementary<double>(info));
    return all;
}

} // namespace

std::string helpers_for(std::string_view text, bool is_single)
{
    static const std::vector<Helper> of_doubles = helpers(false), of_floats = helpers(true);
    const std::vector<Helper>& all = is_single ? of_floats : of_doubles;
    std::string called;
    for (auto helper = all.rbegin(); helper != all.rend(); ++helper)
        if (names(text, helper->name) || names(called, helper->name)) called.insert(0, helper->text + "\n\n");
    return called;
}

} // namespace haptel::emit_c
