// What follows from a mistake: no more messages.
#include "lang/syntax/grammar.h"

#include <utility>

namespace haptel::lang {

using namespace ast;

// After a mistake: to behind the next ';', or before what begins or ends a statement.
void Grammar::find_footing()
{
    if (position > 0 && list.tokens[position - 1].kind == Token::right_brace && !at(Token::semicolon)) return;
    skip_to({Token::left_brace});
    while (at(Token::right_paren) || at(Token::right_bracket)) { // of a bracket that was never opened
        advance();
        skip_to({Token::left_brace});
    }
    if (at(Token::left_brace)) {
        has_stray_brace = true;
        skip_brackets();
    }
    accept(Token::semicolon);
}

// What was read of statements with a mistake in them says nothing of the types and values that were meant.
void Grammar::forget(std::span<StatementPtr> statements)
{
    for (StatementPtr& made : statements) {
        if (auto declaration = std::get_if<Declaration>(&made->node)) {
            declaration->initializer = make(made->span, ErrorExpression{});
            declaration->type = {};
        } else if (!std::holds_alternative<If>(made->node) && !std::holds_alternative<For>(made->node)) {
            made->node = ExpressionStatement{make(made->span, ErrorExpression{})};
        }
    }
}

void Grammar::forget(TextureParameter& parameter)
{
    if (!parameter.is_output) parameter.value = make(parameter.span, ErrorExpression{});
    parameter.minimum = nullptr;
    parameter.maximum = nullptr;
    if (parameter.type.base.text == "image") parameter.type = {};
}

ExpressionPtr Grammar::unknown_value(const Expression& read)
{
    return make(read.span, ErrorExpression{});
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

} // namespace haptel::lang
