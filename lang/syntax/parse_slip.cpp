// A word too many, one too few, two the wrong way round: said once, and read as it was meant.
#include "lang/syntax/grammar.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

constexpr size_t farthest_look = 1000; // tokens; keeps the whole parse linear

} // namespace

// The name behind its type. "q vec3", "float float q" and "q" alone are read as they were meant.
std::optional<Name> Grammar::declared_name(TypeName& type)
{
    const bool is_typed = is_type_word(type.base.text) || type.is_array;
    constexpr Token ends[] = {Token::comma, Token::right_paren, Token::assign, Token::kw_in};
    if (!is_typed && std::find(std::begin(ends), std::end(ends), kind()) != std::end(ends)) {
        error(type.base.span, "syntax", "expected a type and a name, found only '" + type.base.text + "'").hint =
            "write float " + type.base.text;
        lost = false;
        Name alone = std::move(type.base);
        type.base = {};
        return alone;
    }
    std::optional<Name> declared = name("after '" + type.base.text + "'");
    if (!declared || !is_own_type(declared->text)) return declared;
    if (at(Token::name)) {
        Name& surplus = is_typed ? *declared : type.base;
        error(surplus.span, "syntax",
              "expected one type and one name, found '" + surplus.text + "' beside '" + std::string(text()) + "'")
            .hint = "leave one of them out";
        lost = false;
        if (!is_typed) type.base = std::move(*declared);
        declared = Name{std::string(text()), span()};
        advance();
    } else if (!is_typed) {
        const Span both = join(type.base.span, declared->span);
        const std::string written = declared->text + " " + type.base.text;
        Diagnostic& reported = error(both, "syntax", "expected the type before the name");
        reported.hint = "write " + written;
        reported.fix = FixIt{both, written};
        lost = false;
        std::swap(*declared, type.base);
    }
    return declared;
}

// "float depth = 1mm if 0mm .. 2mm": behind the default.
void Grammar::read_misspelt_in()
{
    const bool is_word = (at(Token::name) && !is_type_word(text())) || at(Token::kw_if);
    if (lost || !is_word || nearest_name(text(), {"in"}).empty()) return;
    const Span word = span();
    list.tokens[position].kind = Token::kw_in;
    Diagnostic& reported = error(word, "syntax", "expected 'in', ',' or ')'" + found());
    reported.hint = "did you mean 'in'?";
    reported.fix = FixIt{word, "in"};
    lost = false;
}

// Behind the ';' of what begins here stands what only bodies hold: all of it has strayed.
bool Grammar::statements_follow() const
{
    size_t ahead = 0;
    while (ahead < farthest_look && kind(ahead) != Token::semicolon && kind(ahead) != Token::left_brace &&
           kind(ahead) != Token::end)
        ++ahead;
    const Token behind = kind(ahead + 1);
    return kind(ahead) == Token::semicolon &&
           (behind == Token::kw_return || behind == Token::kw_if || behind == Token::kw_for ||
            behind == Token::kw_break || behind == Token::right_brace);
}

} // namespace haptel::lang
