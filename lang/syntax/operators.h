// The operators as GLSL has them: which operand types go together, what comes out, how they are spelled.
#pragma once

#include "lang/syntax/ast.h"

#include <optional>
#include <string_view>

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

// The operation inside "+=" and its like; nothing for "=".
std::optional<ast::BinaryOp> operation_of(ast::AssignOp op);

std::string_view spelling(ast::BinaryOp op);
std::string_view spelling(ast::UnaryOp op);
std::string_view spelling(ast::AssignOp op);

} // namespace haptel::lang
