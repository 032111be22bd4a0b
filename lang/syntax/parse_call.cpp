// Names and what they call: functions, derivatives of functions, constructors of arrays.
#include "lang/syntax/grammar.h"

namespace haptel::lang {

using namespace ast;

// name_or_call = name | name "(" [expression {"," expression}] ")" | grad_call
ExpressionPtr Grammar::name_or_call()
{
    Name callee{std::string(text()), span()};
    advance();
    if (at(Token::left_bracket) && is_own_type(callee.text)) return array_constructor(std::move(callee));
    if (at(Token::less) && is_own_type(callee.text)) skip_type_arguments();
    if (!at(Token::left_paren)) return make(callee.span, NameExpression{callee.text});
    if (callee.text == "grad") return grad_call(callee.span);

    const Span opener = span();
    advance();
    std::vector<ExpressionPtr> values = arguments(opener);
    const Span whole = since(callee.span);
    return make(whole, CallExpression{std::move(callee), std::move(values)});
}

// The rest of a call behind '(': [expression {"," expression}] ")"
std::vector<ExpressionPtr> Grammar::arguments(Span opener)
{
    std::vector<ExpressionPtr> result;
    const Nesting nesting(*this, Nesting::bracket);
    if (nesting.too_deep()) {
        skip_to({Token::right_paren});
        accept(Token::right_paren);
        return result;
    }
    if (accept(Token::right_paren)) return result;
    do result.push_back(expression());
    while (accept(Token::comma));
    if (!close(Token::right_paren, opener, true) || lost)
        result.push_back(make(span(), ErrorExpression{})); // nobody knows how many were meant
    return result;
}

// grad_call = "grad" "(" function ")" "(" expression {"," expression} ")"     function = name | "grad" "(" function ")"
// Behind "grad". Anything else in the first brackets is an ordinary call of a function named grad, for the checker.
ExpressionPtr Grammar::grad_call(Span first)
{
    GradCall call;
    size_t ahead = 1; // behind '('
    while (kind(ahead) == Token::name && sources.text(span(ahead)) == "grad" && kind(ahead + 1) == Token::left_paren) {
        ++call.order;
        ahead += 2;
    }
    const bool named = kind(ahead) == Token::name;
    bool closed = named;
    for (uint32_t i = 0; i < call.order; ++i) closed = closed && kind(ahead + 1 + i) == Token::right_paren;
    const Span opener = span();
    if (!closed) {
        advance();
        std::vector<ExpressionPtr> values = arguments(opener);
        if (at(Token::left_paren)) {
            if (call.order == 1) // else the innermost has said it
                error(first, "grad", "grad takes the name of a function",
                      "put the expression into a function, float f(vec3 q) { return ...; }, and write grad(f)(q)");
            const Span second = span();
            advance();
            arguments(second);
            return make(since(first), ErrorExpression{});
        }
        return make(since(first), CallExpression{{"grad", first}, std::move(values)});
    }
    call.function = {std::string(sources.text(span(ahead))), span(ahead)};
    for (size_t i = 0; i < ahead + 1 + call.order; ++i) advance();
    if (!at(Token::left_paren)) {
        error(since(first), "grad", "the derivative of a function is a function: expected its arguments" + found(),
              "write grad(" + call.function.text + ")(q)");
        return make(since(first), ErrorExpression{});
    }
    const Span second = span();
    advance();
    call.arguments = arguments(second);
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
    const Span opener = span();
    if (!expect(Token::left_paren, "and the elements of the array")) return make(since(first), ErrorExpression{});
    made.elements = arguments(opener);
    return make(since(first), std::move(made));
}

} // namespace haptel::lang
