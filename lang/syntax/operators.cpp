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

// Of numbers and vectors of them, which become one kind of number; int and uint do not mix. A number goes with every
// component of a vector.
std::optional<OperatorTypes> numbers(Type left, Type right)
{
    if (!left.is_numeric() || !right.is_numeric() || left.is_array() || right.is_array()) return std::nullopt;
    if (left.is_matrix() || right.is_matrix()) return std::nullopt;
    if (left.size != right.size && !left.is_scalar() && !right.is_scalar()) return std::nullopt;
    if (left.scalar != right.scalar && left.is_whole() && right.is_whole()) return std::nullopt;
    const Scalar common = left.scalar == right.scalar ? left.scalar : Scalar::float_;
    return OperatorTypes{vec(left.size, common), vec(right.size, common), vec(std::max(left.size, right.size), common)};
}

std::optional<OperatorTypes> arithmetic(Type left, Type right)
{
    if (left.is_matrix() && left == right) return OperatorTypes{left, right, left};
    if (left.is_matrix() && right.is_numeric() && right.is_scalar()) return OperatorTypes{left, float_type, left};
    if (right.is_matrix() && left.is_numeric() && left.is_scalar()) return OperatorTypes{float_type, right, right};
    return numbers(left, right);
}

std::optional<OperatorTypes> compared(Type left, Type right)
{
    const auto types = left.is_scalar() && right.is_scalar() ? numbers(left, right) : std::nullopt;
    return types ? std::optional(OperatorTypes{types->left, types->right, bool_type}) : std::nullopt;
}

// Of whole numbers of one kind, where a uint is a uint.
std::optional<OperatorTypes> bits(Type left, Type right)
{
    return left.is_whole() && right.is_whole() ? numbers(left, right) : std::nullopt;
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
    case greater_equal: return compared(left, right);
    case equal:
    case not_equal:
        if (left == right && !left.is_array() && (left == bool_type || !left.is_scalar()))
            return OperatorTypes{left, right, bool_type};
        return compared(left, right);
    case logical_and:
    case logical_or:
    case logical_xor: return both(left == bool_type && right == bool_type, bool_type, bool_type);
    case remainder:
    case bit_and:
    case bit_or:
    case bit_xor: return bits(left, right);
    case shift_left:
    case shift_right: // the kind of number by which does not matter
        if (!right.is_whole() || !bits(left, vec(right.size, left.scalar))) return std::nullopt;
        if (right.is_array() || right.size > left.size) return std::nullopt;
        return OperatorTypes{left, right, left};
    }
    return std::nullopt;
}

bool is_linear_product(Type left, Type right)
{
    if (left.is_array() || right.is_array() || left.size != right.size) return false;
    const auto is_real_vector = [](Type type) { return type.is_vector() && type.scalar == Scalar::float_; };
    return left.is_matrix() ? right.is_matrix() || is_real_vector(right) : is_real_vector(left) && right.is_matrix();
}

bool converts_implicitly(Type from, Type to)
{
    return from == to || (from.is_whole() && !from.is_array() && to == vec(from.size));
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
