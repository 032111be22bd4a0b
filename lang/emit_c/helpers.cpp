#include "lang/emit_c/helpers.h"

#include "lang/emit_c/angle_helpers.h"
#include "lang/emit_c/image_helpers.h"
#include "lang/emit_c/operation_helpers.h"
#include "lang/emit_c/words.h"
#include "lang/math/two_over_pi.h"

#include <span>
#include <vector>

namespace haptel::emit_c {

namespace {

std::string list_of(std::span<const double> numbers, bool is_single)
{
    std::string list;
    for (double number : numbers) list += (list.empty() ? "" : ", ") + literal(number, is_single);
    return list;
}

emit::Replacements numbers_of(bool is_single)
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

template <typename F>
struct Words {
    using Float = F;
    using Single = Words<float>;
    using Double = Words<double>;
    static constexpr bool is_single = sizeof(F) == sizeof(float);
    static constexpr std::string_view type = is_single ? "float" : "double",
                                      number = is_single ? "const float" : "const double",
                                      word = is_single ? "const uint32_t" : "const uint64_t", truth = "const int",
                                      fabs = is_single ? "fabsf" : "fabs", sqrt = is_single ? "sqrtf" : "sqrt",
                                      to_bits = is_single ? "haptel_bits32" : "haptel_bits64",
                                      to_number = is_single ? "haptel_real32" : "haptel_real64";
    static std::string literal(double value) { return emit_c::literal(value, is_single); }
};

// All of them, callees first.
std::vector<emit::Helper> helpers(bool is_single)
{
    std::vector<emit::Helper> all;
    const emit::Replacements numbers = numbers_of(is_single);
    emit::add(all, angle_helpers, numbers);
    emit::add(all, operation_helpers, numbers);
    emit::add(all, image_helpers, numbers);
    if (is_single)
        emit::add_elementary<Words<float>>(all, "static ", Words<float>::number);
    else
        emit::add_elementary<Words<double>>(all, "static ", Words<double>::number);
    return all;
}

} // namespace

std::string helpers_for(std::string_view text, bool is_single)
{
    static const std::vector<emit::Helper> of_doubles = helpers(false), of_floats = helpers(true);
    return emit::called_by(text, is_single ? of_floats : of_doubles);
}

} // namespace haptel::emit_c
