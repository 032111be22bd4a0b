// Expressions. Operators of one precedence in a row become one flat Chain.
#include "lang/syntax/grammar.h"
#include "lang/syntax/operators.h"
#include "lang/text/number.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// expression = conditional
ExpressionPtr Grammar::expression()
{
    ExpressionPtr result = conditional();
    if (at(Token::assign) && !lost) {
        error(span(), "assignment-in-expression", "expected the end of the expression, found '='",
              "to compare, write '=='; an assignment is a statement of its own");
    }
    return result;
}

// conditional = binary ["?" expression ":" conditional]
ExpressionPtr Grammar::conditional()
{
    ExpressionPtr condition = binary(1);
    if (!at(Token::question)) return condition;
    const Span question = span();
    const Nesting nesting(*this, Nesting::bracket);
    if (nesting.too_deep()) {
        skip_to({Token::comma});
        return make(condition->span, ErrorExpression{});
    }
    advance();
    ExpressionPtr when_true = expression();
    if (!accept(Token::colon)) {
        error(span(), "syntax", "expected ':' and a value for when the condition is false" + found())
            .related.push_back({question, "for this '?'"});
        return make(since(condition->span), ErrorExpression{});
    }
    ExpressionPtr when_false = conditional();
    const Span whole = join(condition->span, when_false->span);
    return make(whole, Conditional{std::move(condition), std::move(when_true), std::move(when_false)});
}

// binary = unary {operator unary}, grouped by precedence: || ^^ && | ^ & (== !=) (< <= > >=) (<< >>) (+ -) (* / %)
ExpressionPtr Grammar::binary(int lowest_precedence)
{
    ExpressionPtr left = unary();
    for (;;) {
        foreign_operator();
        const Operator* first = operator_of(kind());
        if (!first || first->precedence < lowest_precedence) return left;
        Chain chain{std::move(left), {}};
        Span whole = chain.first->span;
        const Nesting nesting(*this, Nesting::operand);
        if (nesting.too_deep()) {
            skip_to({Token::comma});
            return make(whole, ErrorExpression{});
        }
        for (const Operator* next = first; next && next->precedence == first->precedence; next = operator_of(kind())) {
            const Span op_span = span();
            advance();
            ExpressionPtr operand = binary(first->precedence + 1);
            whole = join(whole, operand->span);
            chain.rest.push_back({next->op, op_span, std::move(operand)});
            foreign_operator();
        }
        left = make(whole, std::move(chain));
    }
}

// unary = ("-" | "+" | "!" | "~") unary | postfix
ExpressionPtr Grammar::unary()
{
    if (at(Token::name) && text() == "not" && (kind(1) == Token::name || kind(1) == Token::left_paren))
        foreign_operator();
    const auto prefix = [&]() -> std::optional<UnaryOp> {
        if (at(Token::minus)) return UnaryOp::negate;
        if (at(Token::plus)) return UnaryOp::plus;
        if (at(Token::bang)) return UnaryOp::logical_not;
        if (at(Token::tilde)) return UnaryOp::bit_not;
        return std::nullopt;
    }();
    if (!prefix) return postfix();
    const Span first = span();
    const Nesting nesting(*this, Nesting::bracket);
    if (nesting.too_deep()) {
        skip_to({Token::comma});
        return make(first, ErrorExpression{});
    }
    advance();
    ExpressionPtr operand = unary();
    const Span whole = join(first, operand->span);
    return make(whole, Unary{*prefix, std::move(operand)});
}

// postfix = primary {"." name | "[" expression "]"}
ExpressionPtr Grammar::postfix()
{
    ExpressionPtr object = primary();
    const uint32_t depth_before = depth;
    bool is_member = false; // as it stands, not in parentheses
    while (at(Token::dot) || at(Token::left_bracket) || at(Token::left_paren) || at(Token::arrow)) {
        depth += Nesting::bracket;
        if (depth > Nesting::limit) {
            report_too_deep();
            skip_to({Token::comma});
            object = make(object->span, ErrorExpression{});
            break;
        }
        if (at(Token::left_bracket)) {
            const Span opener = span();
            advance();
            ExpressionPtr index = expression();
            close(Token::right_bracket, opener);
            is_member = false;
            const Span whole = since(object->span);
            object = make(whole, Index{std::move(object), std::move(index)});
        } else if (at(Token::left_paren) && is_member) {
            object = method_call(std::move(object));
            is_member = false;
        } else if (at(Token::left_paren)) {
            error(span(), "not-callable", "only a name can be called",
                  "for a constant table write: const float A[3] = {1.0, 2.0, 3.0};");
            const Span opener = span();
            advance();
            arguments(opener);
            object = make(since(object->span), ErrorExpression{});
        } else {
            if (at(Token::arrow))
                error(span(), "no-pointers", "there are no pointers in Haptel", "write '.' to take components: q.xy");
            advance();
            std::optional<Name> member = name("after '.': components such as x or xyz");
            const Span whole = since(object->span);
            is_member = member.has_value();
            if (member)
                object = make(whole, Member{std::move(object), std::move(*member)});
            else
                object = make(whole, ErrorExpression{});
        }
    }
    depth = depth_before;
    return object;
}

// primary = number | "true" | "false" | name_or_call | "(" expression ")"
ExpressionPtr Grammar::primary()
{
    const Span first = span();
    if (at(Token::number)) return number();
    if (at(Token::name)) return name_or_call();
    if (at(Token::kw_true) || at(Token::kw_false)) {
        const bool value = at(Token::kw_true);
        advance();
        return make(first, BoolLiteral{value});
    }
    if (at(Token::left_paren)) {
        const Nesting nesting(*this, Nesting::bracket);
        if (nesting.too_deep()) {
            skip_brackets();
            return make(first, ErrorExpression{});
        }
        const Token behind = kind(3);
        if (kind(1) == Token::name && kind(2) == Token::right_paren && is_type_word(text(1)) &&
            (behind == Token::name || behind == Token::number || behind == Token::left_paren))
            return cast();
        advance();
        ExpressionPtr inner = expression();
        if (at(Token::comma) && !lost) {
            error(span(), "syntax", "expected ')', found ','", "a vector is made by its constructor: vec3(x, y, z)");
            skip_to({Token::right_paren});
            inner = unknown_value(*inner);
        }
        close(Token::right_paren, first);
        inner->span = since(first);
        return inner;
    }
    if (at(Token::invalid)) {
        advance();
        lost = true;
        return make(first, ErrorExpression{});
    }
    if (at(Token::plus_plus) || at(Token::minus_minus)) {
        error(first, "assignment-in-expression",
              "'" + std::string(text()) + "' is a statement of its own, not part of an expression",
              "write it on a line before");
        return behind_stray_operator();
    }
    if (at(Token::left_brace)) {
        error(first, "syntax", "braces may only stand behind '=' of a constant table");
        has_stray_brace = true;
        skip_brackets();
        return make(since(first), ErrorExpression{});
    }
    if (at(Token::ampersand) || at(Token::star)) {
        const bool is_power = at(Token::star) && position > 0 && list.tokens[position - 1].kind == Token::star;
        if (is_power)
            error(join(previous_span(), first), "foreign-word", "there is no '**' in Haptel",
                  "a power is pow(x, y), a square x * x");
        else
            error(first, "no-pointers", "expected an expression" + found() + "; there are no pointers in Haptel");
        return behind_stray_operator();
    }
    Diagnostic& reported = error(first, "expected-expression", "expected an expression" + found());
    if (at(Token::kw_texture) && kind(1) == Token::left_paren)
        reported.hint = foreign_word(ForeignKind::function, "texture2D")->hint;
    return make(first, ErrorExpression{});
}

// After the report of an operator that cannot stand here: the operand may be sound.
ExpressionPtr Grammar::behind_stray_operator()
{
    const Span where = span();
    const Nesting nesting(*this, Nesting::bracket);
    if (nesting.too_deep()) {
        skip_to({Token::comma});
        return make(where, ErrorExpression{});
    }
    advance();
    return unary();
}

ExpressionPtr Grammar::number()
{
    const Span where = span();
    Number read = read_number(text());
    advance();
    if (!read.error.empty()) {
        if (!lost) diagnostics.error(where, read.code, std::move(read.error), read.hint);
        list.tokens[position - 1].kind = Token::invalid; // who knows what was glued together
        ++mistakes;
        return make(where, ErrorExpression{});
    }
    return make(where, NumberLiteral{read.kind, read.value, read.integer, std::string(read.unit),
                                     std::string(sources.text(where))});
}

// brace_list = "{" [expression {"," expression} [","]] "}"
ExpressionPtr Grammar::brace_list()
{
    const Span opener = span();
    BraceList list_of;
    const Nesting nesting(*this, Nesting::bracket);
    if (nesting.too_deep()) {
        skip_brackets();
        return make(since(opener), ErrorExpression{});
    }
    advance();
    while (!at(Token::right_brace) && !at(Token::end)) {
        if (at(Token::left_brace)) {
            error(span(), "nested-table", "tables have one dimension",
                  "write the rows one behind the other and index by row * columns + column");
            const Span inner = span();
            brace_list();
            list_of.elements.push_back(make(since(inner), ErrorExpression{}));
        } else {
            list_of.elements.push_back(expression());
        }
        if (accept(Token::comma)) continue;
        if (lost || !(at(Token::number) || at(Token::minus) || at(Token::name))) break;
        report_unclosed(Token::right_brace, opener, true); // a comma was forgotten
        lost = false;
        list_of.is_damaged = true;
    }
    close(Token::right_brace, opener, true);
    list_of.is_damaged |= lost;
    return make(since(opener), std::move(list_of));
}

} // namespace haptel::lang
