#include "lang/check/dimension/dimension_rules.h"

#include <array>
#include <charconv>
#include <string_view>

namespace haptel::lang {
namespace {

// The dimensions that the letters a, b, c stand for, as far as arguments have said.
using Letters = std::array<Dimension, 3>;

int parse_whole(std::string_view& text)
{
    int value = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    return value;
}

// "1", "a", "ab", "a^-1/2", "am^-1"
Dimension evaluate(std::string_view term, const Letters& letters)
{
    Dimension product = Dimension::plain();
    while (!term.empty()) {
        const char letter = term.front();
        term.remove_prefix(1);
        if (letter == '1') continue;
        Exponent exponent{1, 1};
        if (term.starts_with('^')) {
            term.remove_prefix(1);
            exponent.numerator = parse_whole(term);
            if (term.starts_with('/')) {
                term.remove_prefix(1);
                exponent.denominator = parse_whole(term);
            }
        }
        const Dimension base = letter == 'm' ? Dimension::length() : letters[static_cast<size_t>(letter - 'a')];
        product = product * base.power(exponent);
    }
    return product;
}

} // namespace

DimensionResult apply_rule(BuiltinId id, std::span<const Dimension> arguments)
{
    const std::string_view rule = all_builtins()[static_cast<size_t>(id)].dimensions;
    const size_t open = rule.find('(');
    std::string_view rest = rule.substr(open + 1, rule.size() - open - 2);
    Letters letters{Dimension::any(), Dimension::any(), Dimension::any()};
    DimensionResult made;
    for (size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view term = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), term.size() + 1));
        const Dimension expected = evaluate(term, letters);
        const auto both = join(expected, arguments[i]);
        const bool is_letter = term.size() == 1 && term != "1";
        if (!both && made.fits) made = {Dimension::any(), false, i, expected, is_letter};
        if (is_letter) letters[static_cast<size_t>(term.front() - 'a')] = both.value_or(Dimension::any());
    }
    made.result = evaluate(rule.substr(0, open), letters);
    return made;
}

} // namespace haptel::lang
