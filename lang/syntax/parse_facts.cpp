// Doc comments, and the facts in them: "/// @facts value -0.866 .. 0.866, slope 2.179, curvature 11.59, class C1".
#include "lang/ir/op_info.h"
#include "lang/syntax/grammar.h"
#include "lang/text/number.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

constexpr std::string_view marker = "@facts";

std::string_view without_slashes(std::string_view line)
{
    line.remove_prefix(3);
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    if (line.starts_with(' ')) line.remove_prefix(1);
    return line;
}

} // namespace

// The doc lines that stand right above the token, without slashes. A blank line separates them from what is further up.
std::string Grammar::doc_before(size_t token_index, std::optional<ir::Facts>* facts)
{
    const auto first = std::ranges::lower_bound(list.docs, token_index, {}, &DocLine::before_token);
    const auto last = std::ranges::upper_bound(list.docs, token_index, {}, &DocLine::before_token);
    auto begin = last;
    const auto is_set_apart = [&] {
        const std::string_view between = sources.text({file, (begin - 1)->span.end, begin->span.begin});
        return std::ranges::count(between, '\n') > 1;
    };
    while (begin != first && (begin == last || !is_set_apart())) --begin;
    std::string doc;
    for (auto line = begin; line != last; ++line) {
        const std::string_view whole = sources.text(line->span);
        const size_t words = whole.find_first_not_of(" \t", 3); // behind the slashes
        if (words != std::string_view::npos && whole.substr(words).starts_with(marker)) {
            if (!facts) continue;
            const Span where{file, line->span.begin + static_cast<uint32_t>(words), line->span.end};
            const Span inside{file, where.begin + static_cast<uint32_t>(marker.size()), where.end};
            *facts = Grammar(sources, file, lex(sources, inside, diagnostics), diagnostics).parse_facts(where);
            continue;
        }
        if (!doc.empty()) doc += '\n';
        doc += without_slashes(whole);
    }
    return doc;
}

// The number of "/// @bound 64"; null where no such line stands right above the token.
ExpressionPtr Grammar::bound_before(size_t token_index)
{
    constexpr std::string_view word = "@bound";
    const auto lines = std::ranges::equal_range(list.docs, token_index, {}, &DocLine::before_token);
    for (const DocLine& line : lines) {
        const std::string_view whole = sources.text(line.span);
        const size_t at_word = whole.find_first_not_of(" \t", 3);
        if (at_word == whole.npos || !whole.substr(at_word).starts_with(word)) continue;
        const Span inside{file, line.span.begin + static_cast<uint32_t>(at_word + word.size()), line.span.end};
        if (whole.size() > at_word + word.size() && whole[at_word + word.size()] != ' ') continue; // "@bounds"
        Grammar reader(sources, file, lex(sources, inside, diagnostics), diagnostics);
        const auto macro = reader.kind(1) == Token::end ? macros.find(reader.TokenCursor::text()) : macros.end();
        if (macro != macros.end() && !macro->second.takes_arguments) {
            const size_t here = position;
            ExpressionPtr value = read_range({macro->second.first, macro->second.end}, nullptr, "'@bound'");
            if (!at(Token::end)) position = here;
            return value;
        }
        ExpressionPtr bound = reader.expression();
        if (!reader.at(Token::end) && !reader.lost)
            reader.error(reader.span(), "unbounded-loop", "expected a whole number after '@bound'" + reader.found());
        return bound;
    }
    return nullptr;
}

// facts = fact {"," fact}
// fact  = "value" number ".." number | "slope" number | "curvature" number | "class" ("jump" | "C0" | "C1" | "C2")
ir::Facts Grammar::parse_facts(Span where)
{
    ir::Facts facts;
    facts.span = where;
    Span last{}; // of the last number
    const auto signed_number = [&]() -> std::optional<double> {
        last = span();
        const bool negative = accept(Token::minus);
        const Number read = read_number(at(Token::number) ? text() : std::string_view{});
        if (!read.error.empty()) {
            error(span(), "facts", at(Token::number) ? read.error : "expected a number" + found(), read.hint);
            return std::nullopt;
        }
        last = join(last, span());
        advance();
        return negative ? -read.value : read.value;
    };
    const auto size = [&](std::string_view what) {
        const std::optional<double> found = signed_number();
        if (found && *found < 0)
            error(last, "facts",
                  "expected a " + std::string(what) + " of 0 or more, found " + printable(sources.text(last)),
                  "it is a length: the greatest there is, whatever its direction");
        return found;
    };
    do {
        const std::string_view what = text();
        advance();
        if (what == "value") {
            facts.value_minimum = signed_number();
            const Span first = last;
            if (facts.value_minimum && expect(Token::dot_dot, "between least and greatest value"))
                facts.value_maximum = signed_number();
            if (facts.value_maximum && *facts.value_minimum > *facts.value_maximum)
                error(join(first, last), "facts",
                      "expected the least value before the greatest, found " +
                          printable(sources.text(join(first, last))),
                      "write value " + std::string(sources.text(last)) + " .. " + std::string(sources.text(first)));
        } else if (what == "slope") {
            facts.slope = size(what);
        } else if (what == "curvature") {
            facts.curvature = size(what);
        } else if (what == "class") {
            facts.continuity = ir::continuity_named(text());
            if (!facts.continuity || facts.continuity < ir::Continuity::jump || facts.continuity > ir::Continuity::c2)
                error(span(), "facts", "expected jump, C0, C1 or C2" + found());
            if (!lost) advance();
        } else {
            error(where, "facts", "expected value, slope, curvature or class in the facts",
                  "write /// @facts value -1 .. 1, slope 2.5, curvature 10, class C1");
        }
    } while (!lost && accept(Token::comma));
    if (!lost && !at(Token::end)) error(span(), "facts", "expected ','" + found());
    return facts;
}

} // namespace haptel::lang
