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
    if (at(Token::assign) && kind(1) == Token::greater && !lost) {
        error(join(span(), span(1)), "foreign-word", "there are no functions without a name in Haptel",
              "pass a function by its name, fbm(wave, q, 4, 2.0, 0.5), or what '_' leaves of it, fbm(wave(_, 0.2), q, "
              "4, 2.0, 0.5)");
    } else if (at(Token::assign) && !lost) {
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
    advance();
    ExpressionPtr when_true = expression();
    if (!accept(Token::colon)) {
        error(span(), "syntax", "expected ':' and a value for when the condition is false" + found())
            .related.push_back({question, "for this '?'"});
        return unknown(since(condition->span));
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
        read_foreign_operator();
        const Operator* first = operator_of(kind());
        if (!first || first->precedence < lowest_precedence) return left;
        Chain chain{std::move(left), {}};
        Span whole = chain.first->span;
        const Nesting nesting(*this, Nesting::operand);
        for (const Operator* next = first; next && next->precedence == first->precedence; next = operator_of(kind())) {
            const Span op_span = span();
            advance();
            ExpressionPtr operand = binary(first->precedence + 1);
            whole = join(whole, operand->span);
            chain.rest.push_back({next->op, op_span, std::move(operand)});
            read_foreign_operator();
        }
        left = make(whole, std::move(chain));
    }
}

// unary = ("-" | "+" | "!" | "~") unary | postfix
ExpressionPtr Grammar::unary()
{
    if (at(Token::name) && text() == "not" && kind(1) == Token::name) read_foreign_operator();
    constexpr std::pair<Token, UnaryOp> prefixes[] = {{Token::minus, UnaryOp::negate},
                                                      {Token::plus, UnaryOp::plus},
                                                      {Token::bang, UnaryOp::logical_not},
                                                      {Token::tilde, UnaryOp::bit_not}};
    const auto prefix = std::ranges::find(prefixes, kind(), &std::pair<Token, UnaryOp>::first);
    if (prefix == std::end(prefixes)) return postfix();
    const Span first = span();
    const Nesting nesting(*this, Nesting::bracket);
    advance();
    ExpressionPtr operand = unary();
    const Span whole = join(first, operand->span);
    return make(whole, Unary{prefix->second, std::move(operand)});
}

// postfix = primary {"." name | "[" expression "]"}
ExpressionPtr Grammar::postfix()
{
    ExpressionPtr object = primary();
    Nesting nesting(*this, 0);
    bool is_member = false; // as it stands, not in parentheses
    while (at(Token::dot) || (at(Token::left_bracket) && kind(1) != Token::left_bracket) || at(Token::left_paren) ||
           at(Token::arrow)) {
        nesting.deepen(Nesting::bracket);
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
            advance();
            arguments();
            object = unknown(since(object->span));
        } else {
            if (at(Token::arrow))
                error(span(), "no-pointers", "there are no pointers in Haptel", "write '.' to take components: q.xy");
            advance();
            Name member = name("after '.': components such as x or xyz");
            const Span whole = since(object->span);
            is_member = !member.text.empty();
            object = is_member ? make(whole, Member{std::move(object), std::move(member)}) : unknown(whole);
        }
    }
    return object;
}

// primary = number | "true" | "false" | name_or_call | "(" expression ")"
ExpressionPtr Grammar::primary()
{
    const Span first = span();
    if (at(Token::number)) return number();
    if (const Range* argument = argument_here()) {
        const size_t behind = position + 1;
        const Use* inside = macro_use;
        ExpressionPtr read = read_range(*argument, inside->around, "the argument");
        if (!at(Token::end)) position = behind;
        return read;
    }
    if (Macro* macro = macro_here()) return use_of(*macro);
    if (at(Token::name)) return name_or_call();
    if (accept(Token::kw_true)) return make(first, BoolLiteral{true});
    if (accept(Token::kw_false)) return make(first, BoolLiteral{false});
    if (at(Token::left_paren)) {
        const Nesting nesting(*this, Nesting::bracket);
        const Token behind = kind(3);
        if (kind(1) == Token::name && kind(2) == Token::right_paren && is_type_word(text(1)) &&
            (behind == Token::name || behind == Token::number || behind == Token::left_paren))
            return cast();
        advance();
        ExpressionPtr inner = expression();
        if (at(Token::comma) && !lost) {
            error(span(), "syntax", "expected ')', found ','", "a vector is made by its constructor: vec3(x, y, z)");
            skip_to({Token::right_paren});
            inner = unknown(inner->span);
        }
        close(Token::right_paren, first);
        inner->span = since(first);
        return inner;
    }
    if (at(Token::invalid)) {
        advance();
        lost = true;
        return unknown(first);
    }
    if (at(Token::left_brace)) {
        error(first, "syntax", "braces may only stand behind '=' of a constant table");
        has_stray_brace = true;
        skip_braces();
        return unknown(since(first));
    }
    const bool is_step = at(Token::plus_plus) || at(Token::minus_minus);
    if (is_step || at(Token::ampersand) || at(Token::star)) {
        if (is_step)
            error(first, "assignment-in-expression",
                  "'" + std::string(text()) + "' is a statement of its own, not part of an expression",
                  "write it on a line before");
        else if (at(Token::star) && previous_kind() == Token::star)
            error(join(previous_span(), first), "foreign-word", "there is no '**' in Haptel",
                  "a power is pow(x, y), a square x * x");
        else
            error(first, "no-pointers", "expected an expression" + found() + "; there are no pointers in Haptel");
        const Nesting nesting(*this, Nesting::bracket);
        advance();
        return unary(); // which may be sound
    }
    if (at(Token::kw_out) && kind(1) == Token::name) {
        slip(first, "foreign-word", "a call names what is written as it names what is read", "leave 'out' out").fix =
            FixIt{{file, first.begin, span(1).begin}, ""};
        advance();
        return unary();
    }
    if (at(Token::greater) && previous_kind() == Token::assign && previous_span().end == first.begin) {
        error(join(previous_span(), first), "foreign-word", "there is no '=>' in Haptel",
              "a function stands at the top of a file, float f(vec3 q) { return ...; }, and is passed by its name");
        return unknown(first);
    }
    Diagnostic& reported = error(first, "expected-expression", "expected an expression" + found());
    if (at(Token::kw_texture) && kind(1) == Token::left_paren)
        reported.hint = foreign_word(ForeignKind::function, "texture2D")->hint;
    if (at(Token::string))
        reported.hint = "a text names a file; what is chosen by a word in OSL is a function: perlin(q)";
    return unknown(first);
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
        return unknown(where);
    }
    if (read.unit.empty() && at(Token::name) && !si_unit(text()).empty() && !on_new_line()) return parted_number(where);
    return make(where, NumberLiteral{read.kind, read.value, read.integer, std::string(read.unit),
                                     std::string(sources.text(where))});
}

// brace_list = "{" [element {"," element} [","]] "}"                    element = expression | brace_list
ExpressionPtr Grammar::brace_list(bool is_row)
{
    const Span opener = span();
    BraceList list_of;
    const Nesting nesting(*this, Nesting::bracket);
    advance();
    while (!at(Token::right_brace) && !at(Token::end)) {
        if (at(Token::left_brace)) {
            if (is_row)
                error(span(), "nested-table", "tables have at most two dimensions",
                      "write the rows one behind the other and index by row * columns + column");
            list_of.elements.push_back(brace_list(true));
            if (is_row) list_of.elements.back() = unknown(list_of.elements.back()->span);
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

// At '[' behind a struct's name: whether "(" follows the "]", as in "Cell[2](a, b)".
bool Grammar::makes_structs(std::string_view type) const
{
    if (!struct_names.contains(type) && type.find('.') == type.npos) return false;
    const size_t closer = closer_ahead(0);
    return kind(closer) == Token::right_bracket && kind(closer + 1) == Token::left_paren;
}

// "oak.rings" is one name where "oak" is the prefix of an import, or must be one since the whole is called.
bool Grammar::at_prefixed_name(size_t ahead, Token called_by) const
{
    return kind(ahead) == Token::name && kind(ahead + 1) == Token::dot && kind(ahead + 2) == Token::name &&
           (kind(ahead + 3) == called_by || import_prefixes.contains(text(ahead)));
}

// "oak.Cell": a struct of the file behind that prefix.
bool Grammar::at_prefixed_type() const
{
    return kind() == Token::name && kind(1) == Token::dot && kind(2) == Token::name;
}

Name Grammar::prefixed_name()
{
    Name made{std::string(text()) + "." + std::string(text(2)), join(span(), span(2))};
    advance(3);
    return made;
}

// name_or_call = name | name "(" [expression {"," expression}] ")" | grad_call            name = [name "."] name
ExpressionPtr Grammar::name_or_call()
{
    Name callee = at_prefixed_name() ? prefixed_name() : name("");
    if (at(Token::left_bracket) && (is_own_type(callee.text) || makes_structs(callee.text)))
        return array_constructor(std::move(callee));
    if (at(Token::less) && is_own_type(callee.text)) skip_type_arguments();
    if (!at(Token::left_paren)) return make(callee.span, NameExpression{callee.text});
    if (callee.text == "grad") return grad_call(callee.span);

    advance();
    std::vector<Name> names;
    std::vector<ExpressionPtr> values = arguments(&names);
    return make(since(callee.span), CallExpression{std::move(callee), std::move(values), std::move(names)});
}

// The rest of a call behind '(': [argument {"," argument}] ")"          argument = [name "="] expression
// Names are read where they may stand; `names` is empty where none does.
std::vector<ExpressionPtr> Grammar::arguments(std::vector<Name>* names)
{
    std::vector<ExpressionPtr> result;
    const Span opener = previous_span();
    const Nesting nesting(*this, Nesting::bracket);
    if (accept(Token::right_paren)) return result;
    do {
        Name own;
        if (names && at(Token::name) && kind(1) == Token::assign) {
            own = name("");
            advance();
        }
        result.push_back(expression());
        if (!names || (own.text.empty() && names->empty())) continue;
        names->resize(result.size());
        names->back() = std::move(own);
    } while (accept(Token::comma));
    if (!close(Token::right_paren, opener, true) || lost)
        result.push_back(unknown(span())); // nobody knows how many were meant
    return result;
}

// grad_call = "grad" "(" function ")" "(" expression {"," expression} ")"     function = name | "grad" "(" function ")"
// Behind "grad". Anything else in the first brackets is an ordinary call of a function named grad, for the checker.
ExpressionPtr Grammar::grad_call(Span first)
{
    GradCall call;
    advance();
    size_t ahead = 0;
    for (; kind(ahead) == Token::name && text(ahead) == "grad" && kind(ahead + 1) == Token::left_paren; ahead += 2)
        ++call.order;
    const size_t first_name = ahead;
    bool closed = kind(ahead) == Token::name;
    const bool has_prefix = at_prefixed_name(ahead, Token::right_paren);
    if (has_prefix) ahead += 2;
    for (uint32_t i = 1; i <= call.order; ++i) closed = closed && kind(ahead + i) == Token::right_paren;
    if ((has_own_grad || has_prefix) && closed) // else it is called, or "grad(p.x)"
        closed = kind(ahead + 1 + call.order) == Token::left_paren;
    if (!closed) {
        const uint32_t reports = diagnostics.reports();
        std::vector<ExpressionPtr> values = arguments();
        if (!accept(Token::left_paren)) return make(since(first), CallExpression{{"grad", first}, std::move(values)});
        if (diagnostics.reports() == reports) // else what stands in the brackets is told
            error(first, "grad", "grad takes the name of a function",
                  "put the expression into a function, float f(vec3 q) { return ...; }, and write grad(f)(q)");
        arguments();
        return unknown(since(first));
    }
    advance(first_name);
    call.function = has_prefix ? prefixed_name() : name("");
    advance(call.order);
    if (!accept(Token::left_paren)) {
        error(since(first), "grad", "the derivative of a function is a function: expected its arguments" + found(),
              "write grad(" + call.function.text + ")(q)");
        return unknown(since(first));
    }
    call.arguments = arguments();
    return make(since(first), std::move(call));
}

// array_constructor = type "[" [expression] "]" "(" expression {"," expression} ")"        Behind the type's name.
ExpressionPtr Grammar::array_constructor(Name type)
{
    BraceList made;
    const Span first = type.span;
    made.type.emplace();
    made.type->base = std::move(type);
    array_suffix(*made.type);
    if (!expect(Token::left_paren, "and the elements of the array")) return unknown(since(first));
    made.elements = arguments();
    return make(since(first), std::move(made));
}

} // namespace haptel::lang
