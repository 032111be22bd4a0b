#include "lang/emit_c/helpers.h"

#include "lang/emit_c/angle_helpers.h"
#include "lang/emit_c/image_helpers.h"
#include "lang/emit_c/operation_helpers.h"
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
    const auto add = [&](std::span<const HelperText> texts) {
        for (const auto& [name, text] : texts) all.push_back({name, specialised(text, numbers)});
    };
    add(angle_helpers);
    add(operation_helpers);
    add(image_helpers);
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
