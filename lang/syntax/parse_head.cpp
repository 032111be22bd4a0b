// What heads of functions and textures share: parameters one behind the other, and a body that follows.
#include "lang/syntax/grammar.h"

#include <utility>

namespace haptel::lang {

using namespace ast;

namespace {

constexpr size_t farthest_look = 1000; // tokens; keeps the whole parse linear

} // namespace

// Behind a parameter: whether it was read and ends here. A comma that was forgotten is reported, and taken as read.
bool Grammar::ends_parameter(Span opener)
{
    if (lost) return false;
    if (at(Token::comma) || at(Token::right_paren) || at(Token::left_brace)) return true;
    const bool next_begins = at(Token::kw_out) || (at(Token::name) && kind(1) == Token::name && is_type_word(text()));
    report_unclosed(Token::right_paren, opener, true);
    lost = !next_begins;
    return next_begins;
}

bool Grammar::next_parameter()
{
    const bool begins = accept(Token::comma) || (!lost && !at(Token::right_paren) && !at(Token::left_brace));
    if (begins && lost) stand_again();
    return begins;
}

// A parameter could not be read: to the comma, the ')' or the body behind it.
void Grammar::find_next_parameter(size_t first_position)
{
    uint32_t open = 0;
    for (; !at(Token::end) && !at_texture_or_import() && !at(Token::left_brace) && !at(Token::semicolon); advance()) {
        if (open == 0 && (at(Token::comma) || at(Token::right_paren))) break;
        if (at(Token::left_paren)) ++open;
        if (at(Token::right_paren)) --open;
    }
    note_unread(first_position);
}

// The head could not be read: to the '{' of the body.
void Grammar::find_body()
{
    const size_t first_position = position;
    while (!at(Token::left_brace) && !at(Token::end) && !at_texture_or_import()) {
        if (at(Token::semicolon) && kind(1) != Token::left_brace) break;
        advance();
    }
    note_unread(first_position);
}

// Behind the parameters. Where the body begins without ')', it is not skipped.
void Grammar::close_head(Span opener)
{
    if (accept(Token::right_paren)) return;
    report_unclosed(Token::right_paren, opener, true);
    if (at(Token::left_brace) && !is_head_damaged) lost = false;  // all parameters were read
    if (at(Token::left_brace) && kind(1) == Token::right_paren) { // the two have changed places
        std::swap(list.tokens[position].kind, list.tokens[position + 1].kind);
        advance();
    }
}

StatementPtr Grammar::body_of(std::string_view what)
{
    if (lost) find_body();
    lost = false;
    if (!at(Token::left_brace)) {
        error(span(), "syntax", "expected '{' and the body of " + std::string(what) + found());
        const bool is_before_body = kind(1) == Token::left_brace || body_follows();
        if (is_before_body)
            find_body();
        else if (at(Token::semicolon) || at(Token::end) || at(Token::invalid) || at_top_level_start())
            return nullptr;
        const bool is_alone = on_new_line() && kind(1) != Token::end &&
                              sources.text({file, span().end, span(1).begin}).find('\n') != std::string_view::npos;
        if (is_alone && !is_before_body) advance(); // it stands in the brace's place
    }
    depth = 0;
    StatementPtr body = at(Token::left_brace) ? block() : rest_of_block(after_previous()); // the brace was forgotten
    depth = Nesting::bracket;
    return body;
}

// What begins here ends in a '{' that must be a body's: it is a function, however its head is written.
bool Grammar::body_follows() const
{
    Token before = Token::name;
    for (size_t ahead = 0; ahead < farthest_look; before = kind(ahead++)) {
        const Token here = kind(ahead);
        if (here == Token::left_brace) return before != Token::assign && before != Token::right_bracket;
        if (here == Token::end || here == Token::semicolon || here == Token::right_brace || here == Token::kw_texture ||
            here == Token::kw_import || (here >= Token::kw_if && here <= Token::kw_return))
            return false;
    }
    return false;
}

// "t(float depth = 1mm) {...}": only textures have defaults and outputs.
bool Grammar::is_texture_without_its_word() const
{
    if (kind(1) != Token::left_paren || is_type_word(text()) || !body_follows()) return false;
    for (size_t ahead = 2; ahead < farthest_look && kind(ahead) != Token::left_brace; ++ahead)
        if (kind(ahead) == Token::assign || kind(ahead) == Token::kw_out) return true;
    return false;
}

// "f((float x)", behind the first bracket.
void Grammar::skip_doubled_bracket()
{
    if (!at(Token::left_paren)) return;
    error(span(), "syntax", "expected a parameter or ')'" + found());
    advance();
    lost = false;
}

// "float float f(", "vec2 f f(", "x float f(", "f float(": at the first word of a function's head.
void Grammar::mend_words_of_head()
{
    if (kind(1) != Token::name) return;
    const bool is_swapped = !is_type_word(text()) && is_own_type(text(1)) && kind(2) == Token::left_paren;
    const bool has_surplus = kind(2) == Token::name && kind(3) == Token::left_paren;
    if (is_swapped) {
        const std::string written = std::string(text(1)) + " " + std::string(text());
        Diagnostic& reported = error(join(span(), span(1)), "syntax", "expected the type before the name");
        reported.hint = "write " + written;
        reported.fix = FixIt{join(span(), span(1)), written};
    } else if (has_surplus) {
        const size_t surplus = is_own_type(text()) || !is_own_type(text(1)) ? 1 : 0;
        error(span(surplus), "syntax",
              "expected a type and a name before '(', found '" + std::string(text(surplus)) + "' too")
            .hint = "leave it out";
        if (surplus == 1 && !at(Token::end)) std::swap(list.tokens[position], list.tokens[position + 1]);
        advance();
    } else {
        return;
    }
    lost = false;
    if (is_swapped && !at(Token::end)) std::swap(list.tokens[position], list.tokens[position + 1]);
}

} // namespace haptel::lang
