// Switches and their cases.
#include "lang/syntax/grammar.h"

#include <utility>

namespace haptel::lang {

using namespace ast;

// switch = "switch" "(" expression ")" "{" {case} "}"
StatementPtr Grammar::switch_statement()
{
    const Span first = span();
    advance();
    Switch made;
    Span opener = span();
    const bool opened = expect(Token::left_paren, "after 'switch'");
    made.selector = expression();
    if (opened)
        close(Token::right_paren, opener);
    else
        accept(Token::right_paren);
    if (lost) made.selector = unknown(made.selector->span);
    opener = span();
    if (!expect(Token::left_brace, "and the cases of the switch")) return make_statement(since(first), std::move(made));
    const Nesting nesting(*this, Nesting::bracket);
    while (!at(Token::right_brace) && !at(Token::end) && !at_top_level_start()) {
        if (at(Token::kw_case) || at(Token::kw_default)) {
            made.cases.push_back(one_case());
            continue;
        }
        error(span(), "switch", "expected 'case' or 'default'" + found(),
              "what a switch does stands behind the label of a case, and variables for all cases above the switch");
        Statements strayed;
        statement(strayed);
    }
    close(Token::right_brace, opener);
    return make_statement(since(first), std::move(made));
}

// case = label {label} {statement}          label = "case" expression ":" | "default" ":"
Switch::Case Grammar::one_case()
{
    Switch::Case made;
    const Span first = span();
    lost = false;
    while (at(Token::kw_case) || at(Token::kw_default)) {
        if (accept(Token::kw_default)) {
            made.labels.push_back(nullptr);
        } else {
            advance();
            made.labels.push_back(conditional());
            if (lost) made.labels.back() = unknown(made.labels.back()->span);
        }
        if (!accept(Token::colon)) {
            error(span(), "syntax", "expected ':' behind the label of a case" + found());
            lost = false;
        }
    }
    made.head = since(first);
    Scope body;
    while (!at(Token::right_brace) && !at(Token::kw_case) && !at(Token::kw_default) && !at(Token::end) &&
           !at_top_level_start())
        statement(body.statements);
    made.body = make_statement(since(first), std::move(body));
    return made;
}

} // namespace haptel::lang
