#include "lang/syntax/operators.h"

#include <algorithm>

namespace haptel::lang {

using ast::BinaryOp;

namespace {

constexpr Operator operators[] = {
    {BinaryOp::logical_or, Token::logical_or, 1},
    {BinaryOp::logical_xor, Token::logical_xor, 2},
    {BinaryOp::logical_and, Token::logical_and, 3},
    {BinaryOp::bit_or, Token::pipe, 4, Token::or_assign},
    {BinaryOp::bit_xor, Token::caret, 5, Token::xor_assign},
    {BinaryOp::bit_and, Token::ampersand, 6, Token::and_assign},
    {BinaryOp::equal, Token::equal, 7},
    {BinaryOp::not_equal, Token::not_equal, 7},
    {BinaryOp::less, Token::less, 8},
    {BinaryOp::less_equal, Token::less_equal, 8},
    {BinaryOp::greater, Token::greater, 8},
    {BinaryOp::greater_equal, Token::greater_equal, 8},
    {BinaryOp::shift_left, Token::shift_left, 9, Token::shift_left_assign},
    {BinaryOp::shift_right, Token::shift_right, 9, Token::shift_right_assign},
    {BinaryOp::add, Token::plus, 10, Token::plus_assign},
    {BinaryOp::subtract, Token::minus, 10, Token::minus_assign},
    {BinaryOp::multiply, Token::star, 11, Token::star_assign},
    {BinaryOp::divide, Token::slash, 11, Token::slash_assign},
    {BinaryOp::remainder, Token::percent, 11, Token::percent_assign},
};

bool is_scalar_number(Type type)
{
    return type.is_numeric() && type.is_scalar();
}

// Of two numbers, which become one type; int and uint do not mix.
std::optional<OperatorTypes> numbers(Type left, Type right, bool are_compared)
{
    if (!is_scalar_number(left) || !is_scalar_number(right)) return std::nullopt;
    if (left != right && left != float_type && right != float_type) return std::nullopt;
    const Type common = left == right ? left : float_type;
    return OperatorTypes{common, common, are_compared ? bool_type : common};
}

std::optional<OperatorTypes> arithmetic(Type left, Type right)
{
    if (left.is_array() || right.is_array()) return std::nullopt;
    if (!left.is_scalar() && left == right) return OperatorTypes{left, right, left};
    if (!left.is_scalar() && is_scalar_number(right)) return OperatorTypes{left, float_type, left};
    if (!right.is_scalar() && is_scalar_number(left)) return OperatorTypes{float_type, right, right};
    return numbers(left, right, false);
}

std::optional<OperatorTypes> both(bool fits, Type operands, Type result)
{
    return fits ? std::optional(OperatorTypes{operands, operands, result}) : std::nullopt;
}

} // namespace

std::optional<OperatorTypes> operator_types(ast::BinaryOp op, Type left, Type right)
{
    using enum ast::BinaryOp;
    switch (op) {
    case multiply:
        if (is_linear_product(left, right)) return OperatorTypes{left, right, left.is_matrix() ? right : left};
        return arithmetic(left, right);
    case add:
    case subtract:
    case divide: return arithmetic(left, right);
    case less:
    case less_equal:
    case greater:
    case greater_equal: return numbers(left, right, true);
    case equal:
    case not_equal:
        if (left == right && !left.is_array() && (left == bool_type || !left.is_scalar()))
            return OperatorTypes{left, right, bool_type};
        return numbers(left, right, true);
    case logical_and:
    case logical_or:
    case logical_xor: return both(left == bool_type && right == bool_type, bool_type, bool_type);
    case remainder:
    case bit_and:
    case bit_or:
    case bit_xor: return both(left == right && is_integer(left), left, left);
    case shift_left:
    case shift_right:
        if (is_integer(left) && is_integer(right)) return OperatorTypes{left, right, left};
        return std::nullopt;
    }
    return std::nullopt;
}

bool is_linear_product(Type left, Type right)
{
    if (left.is_array() || right.is_array() || left.size != right.size) return false;
    return left.is_matrix() ? right.is_matrix() || right.is_vector() : left.is_vector() && right.is_matrix();
}

bool converts_implicitly(Type from, Type to)
{
    return from == to || (is_integer(from) && to == float_type);
}

const Operator& operator_of(BinaryOp op)
{
    return *std::ranges::find(operators, op, &Operator::op);
}

const Operator* operator_of(Token token)
{
    const auto found = std::ranges::find(operators, token, &Operator::token);
    return found == std::end(operators) ? nullptr : found;
}

bool is_assignment(Token token)
{
    return token == Token::assign || operation_in(token).has_value();
}

std::optional<BinaryOp> operation_in(Token assignment)
{
    const auto found = std::ranges::find(operators, assignment, &Operator::assignment);
    return found == std::end(operators) || assignment == Token::invalid ? std::nullopt : std::optional(found->op);
}

} // namespace haptel::lang
