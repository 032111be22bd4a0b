// What heads of functions and textures share: parameters one behind the other, and a body that follows.
#include "lang/syntax/grammar.h"

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
    if (at(Token::left_brace) && !is_head_damaged) lost = false; // all parameters were read
}

StatementPtr Grammar::body_of(std::string_view what)
{
    if (lost) find_body();
    lost = false;
    if (!at(Token::left_brace)) {
        error(span(), "syntax", "expected '{' and the body of " + std::string(what) + found());
        if (kind(1) == Token::left_brace || body_follows())
            find_body();
        else if (at(Token::semicolon) || at(Token::end) || at(Token::invalid) || at_top_level_start())
            return nullptr;
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
