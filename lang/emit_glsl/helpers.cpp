#include "lang/emit_glsl/helpers.h"

#include "lang/emit/helper_text.h"
#include "lang/emit_glsl/image_helpers.h"
#include "lang/emit_glsl/image_words.h"
#include "lang/emit_glsl/names.h"
#include "lang/emit_glsl/operation_helpers.h"

#include <cmath>
#include <numbers>

namespace haptel::emit_glsl {

namespace {

// There is but one width.
struct Words {
    using Float = float;
    using Single = Words;
    using Double = Words;
    static constexpr std::string_view type = "float", number = "haptel_precise float", word = "uint", truth = "bool",
                                      fabs = "abs", sqrt = "sqrt", to_bits = "floatBitsToUint",
                                      to_number = "uintBitsToFloat";
    static std::string literal(double value) { return emit_glsl::literal(value); }
};
using Number = emit::Written<Words>;

// What f32 does in lang/math by a wider number, or by a sum whose rounding counts, which a compiler of GLSL without
// `precise` may drop. Found in place of the templates of the same names, by their argument.

Number nearest_whole(Number a)
{
    return a.called("roundEven");
}

Number way_to_even(Number y)
{
    constexpr double even = 0x1p24; // from here on all are
    const Number reach = select(abs(y) < even, abs(y), constant(y, even));
    return reach - 2 * nearest_whole(reach * 0.5);
}

// The leading digits of a number.
double leading(double number, int digits)
{
    const int shift = digits - 1 - std::ilogb(number);
    return std::ldexp(std::floor(std::ldexp(number, shift)), -shift);
}

// A quarter turn in parts of 8 bits, so that their products with a whole number below 2^16 are exact; beyond it the
// rest is off by no more than the angle's own last digit, and stays within an eighth of a turn.
ir::elementary::Circle<Number> circle_of(Number angle)
{
    constexpr double eighth = 0.79;
    const Number k = nearest_whole(abs(angle) * ir::elementary::two_over_pi);
    Number rest = abs(angle);
    double quarter = std::numbers::pi / 2;
    for (const int digits : {8, 8, 8, 24}) {
        const double part = leading(quarter, digits);
        rest = rest - k * part;
        quarter -= part;
    }
    return ir::elementary::Circle<Number>({k, ir::elementary::clamped(rest, -eighth, eighth), constant(angle, 0)});
}

// x^y = 2^(y e + y log2 m), x = 2^e m: the product of e with the upper half of y is exact, and so is its fraction.
Number power_of_positive(Number x, Number y)
{
    using C = ir::elementary::Constants<float>;
    const ir::elementary::Split<Number> split(x);
    const Number f = split.mantissa - 1, s = f / (f + 2), z = s * s;
    const Number logarithm = (2 * s + s * z * ir::elementary::polynomial(C::logarithm, z)) * ir::elementary::log2e;
    const Number upper = ir::elementary::without_low_half(y), whole = split.exponent * upper;
    const Number k = nearest_whole(whole);
    const Number left = (whole - k) + (split.exponent * (y - upper) + y * logarithm);
    const Number more = nearest_whole(left), r = (left - more) * std::numbers::ln2, u = r * r;
    const Number near = 1 + (r + (r * u * ir::elementary::polynomial(C::odd, u) +
                                  (0.5 * u + u * u * ir::elementary::polynomial(C::even, u))));
    const Number exponent = ir::elementary::clamped(k + more, -200, 200);
    const Number all = y * (split.exponent + logarithm);
    return select(all > 150, constant(x, ir::elementary::infinity),
                  select(all < -160, constant(x, 0), ir::elementary::scaled(near, exponent)));
}

Number pow(Number x, Number y)
{
    return ir::elementary::with_edges_of_power(x, y, power_of_positive(abs(x), y));
}

// By Horner's rule, of u.
std::string polynomial_text(std::span<const double> coefficients)
{
    std::string text = literal(coefficients.back());
    for (size_t i = coefficients.size() - 1; i-- > 0;) text = "(" + text + ") * u + " + literal(coefficients[i]);
    return text;
}

std::vector<emit::Helper> helpers()
{
    const emit::Replacements replacements = {{"LARGE", literal(0x1p60)},
                                             {"SMALL", literal(0x1p-60)},
                                             {"UP", literal(0x1p80)},
                                             {"DOWN", literal(0x1p-80)},
                                             {"TURN_SINE", polynomial_text(ir::turn::sine_f32)},
                                             {"TURN_COSINE", polynomial_text(ir::turn::cosine_f32)},
                                             {"WORDS_OF_IMAGE", std::to_string(words_of_image)},
                                             {"CLAMPED", std::to_string(HAPTEL_EDGE_CLAMPED) + "u"},
                                             {"TILED", std::to_string(HAPTEL_EDGE_TILED) + "u"},
                                             {"MIRRORED", std::to_string(HAPTEL_EDGE_MIRRORED) + "u"}};
    std::vector<emit::Helper> all;
    emit::add(all, operation_helpers, replacements);
    emit::add(all, image_helpers, replacements);
    emit::add_elementary<Words>(all, "", "float");
    for (emit::Helper& helper : all) {
        const std::string guard = "HAPTEL_HAS_" + helper.name.substr(helper.name.find('_') + 1);
        helper.text = "#ifndef " + guard + "\n#define " + guard + "\n" + helper.text + "\n#endif";
    }
    return all;
}

} // namespace

std::string helpers_for(std::string_view text)
{
    static const std::vector<emit::Helper> all = helpers();
    return emit::called_by(text, all);
}

} // namespace haptel::emit_glsl
