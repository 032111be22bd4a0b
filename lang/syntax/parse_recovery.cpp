// After a mistake: where reading goes on, and what is no longer said. Heads of functions and textures, and statements.
#include "lang/syntax/grammar.h"

#include <utility>

namespace haptel::lang {

using namespace ast;

// ---- statements

// After a mistake: to behind the next ';', or before what begins or ends a statement.
void Grammar::find_footing()
{
    if (previous_kind() == Token::right_brace && !at(Token::semicolon)) return;
    skip_to({Token::left_brace});
    while (at(Token::right_paren) || at(Token::right_bracket)) { // of a bracket that was never opened
        advance();
        skip_to({Token::left_brace});
    }
    if (at(Token::left_brace)) {
        has_stray_brace = true;
        skip_braces();
    }
    accept(Token::semicolon);
}

// What was read of statements with a mistake in them says nothing of the types and values that were meant.
void Grammar::forget(std::span<StatementPtr> statements)
{
    for (StatementPtr& made : statements) {
        if (auto declaration = std::get_if<Declaration>(&made->node)) {
            declaration->initializer = unknown(made->span);
            declaration->type = {};
        } else if (!std::holds_alternative<If>(made->node) && !std::holds_alternative<For>(made->node) &&
                   !std::holds_alternative<Switch>(made->node)) {
            made->node = ExpressionStatement{unknown(made->span)};
        }
    }
}

void Grammar::forget(TextureParameter& parameter)
{
    if (!parameter.is_output) parameter.value = unknown(parameter.span);
    parameter.minimum = nullptr;
    parameter.maximum = nullptr;
    parameter.choices.clear();
    if (parameter.type.base.text == "image") parameter.type = {};
}

// From the token at `first_position` to here: what has a name there may be declared there.
void Grammar::note_unread(size_t first_position)
{
    for (size_t i = first_position; i < position; ++i)
        if (list.tokens[i].kind == Token::name)
            unread.emplace(sources.text({file, list.tokens[i].begin, list.tokens[i].end}));
}

// Of the function or texture whose parsing began after so many mistakes.
Damage Grammar::take_damage(uint32_t mistakes_before, StatementPtr& body)
{
    if (is_misshapen) body = nullptr; // its statements may belong elsewhere
    return {mistakes != mistakes_before, is_head_damaged, std::exchange(unread, {})};
}

// ---- heads

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
    for (; !at(Token::end) && !at_texture_or_import() && !at(Token::semicolon); advance()) {
        if (at(Token::left_brace) && !at_choices()) break;
        if (at(Token::left_brace)) skip_braces();
        if (open == 0 && (at(Token::comma) || at(Token::right_paren))) break;
        if (at(Token::left_paren)) ++open;
        if (at(Token::right_paren)) --open;
    }
    note_unread(first_position);
}

// Whether a '{' behind "in" begins names of choices. A body has a ';' before its first '}', or as far as one looks.
bool Grammar::at_choices() const
{
    if (!at(Token::left_brace) || previous_kind() != Token::kw_in) return false;
    const Token stop = kind(first_ahead({Token::right_brace, Token::semicolon, Token::end}));
    return stop != Token::semicolon && stop != Token::end;
}

// The head could not be read: to the '{' of the body.
void Grammar::find_body()
{
    const size_t first_position = position;
    while (!at(Token::left_brace) && !at(Token::end) && !at_texture_or_import()) {
        if (at(Token::semicolon) && kind(1) != Token::left_brace) break;
        advance();
        if (at_choices()) skip_braces();
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
    const size_t brace =
        first_ahead({Token::left_brace, Token::right_brace, Token::semicolon, Token::end, Token::kw_texture,
                     Token::kw_import, Token::kw_if, Token::kw_else, Token::kw_for, Token::kw_switch, Token::kw_case,
                     Token::kw_default, Token::kw_break, Token::kw_continue, Token::kw_return});
    const Token before = brace > 0 ? kind(brace - 1) : Token::name;
    return kind(brace) == Token::left_brace && before != Token::assign && before != Token::right_bracket;
}

// Behind the ';' of what begins here stands what only bodies hold: all of it has strayed.
bool Grammar::statements_follow() const
{
    const size_t end = first_ahead({Token::semicolon, Token::left_brace, Token::end});
    const Token behind = kind(end + 1);
    return kind(end) == Token::semicolon && (is_statement_word(behind) || behind == Token::right_brace);
}

} // namespace haptel::lang
