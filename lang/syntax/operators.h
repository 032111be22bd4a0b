// The operators as GLSL has them: their tokens, which operand types go together and what comes out.
#pragma once

#include "lang/syntax/ast.h"
#include "lang/text/lexer.h"

#include <optional>

namespace haptel::lang {

// What the operands are converted to, and the result. Where one is a vector and the other a scalar, the scalar goes
// with each component.
struct OperatorTypes {
    Type left, right, result;
};
std::optional<OperatorTypes> operator_types(ast::BinaryOp op, Type left, Type right);

// Whether "*" is that of linear algebra: m * v, v * m, m * m. All else goes component by component.
bool is_linear_product(Type left, Type right);

// Without being asked: int and uint become float; nothing else changes.
bool converts_implicitly(Type from, Type to);

struct Operator {
    ast::BinaryOp op;
    Token token;
    int precedence;                    // higher binds tighter
    Token assignment = Token::invalid; // "+=" and its like, where there is one
};
const Operator& operator_of(ast::BinaryOp op);
const Operator* operator_of(Token token); // null: it is none

bool is_assignment(Token token);
// In "+=" and its like; nothing in "=".
std::optional<ast::BinaryOp> operation_in(Token assignment);

} // namespace haptel::lang
