#include "lang/syntax/operators.h"

namespace haptel::lang {
namespace {

bool is_scalar_number(Type type)
{
    return type.is_numeric() && type.is_scalar();
}

// Of two numbers; int and uint do not mix.
std::optional<Type> common_number(Type left, Type right)
{
    if (!is_scalar_number(left) || !is_scalar_number(right)) return std::nullopt;
    if (left == right) return left;
    if (left == float_type || right == float_type) return float_type;
    return std::nullopt;
}

std::optional<OperatorTypes> arithmetic(Type left, Type right)
{
    if (left.is_array() || right.is_array()) return std::nullopt;
    if (!left.is_scalar() && left == right) return OperatorTypes{left, right, left};
    if (!left.is_scalar() && is_scalar_number(right)) return OperatorTypes{left, float_type, left};
    if (!right.is_scalar() && is_scalar_number(left)) return OperatorTypes{float_type, right, right};
    if (auto common = common_number(left, right)) return OperatorTypes{*common, *common, *common};
    return std::nullopt;
}

std::optional<OperatorTypes> both(bool fits, Type operands, Type result)
{
    return fits ? std::optional(OperatorTypes{operands, operands, result}) : std::nullopt;
}

std::optional<OperatorTypes> comparison(Type left, Type right)
{
    auto common = common_number(left, right);
    return both(common.has_value(), common.value_or(float_type), bool_type);
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
    case greater_equal: return comparison(left, right);
    case equal:
    case not_equal:
        if (left == right && !left.is_array() && (left == bool_type || !left.is_scalar()))
            return OperatorTypes{left, right, bool_type};
        return comparison(left, right);
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

std::optional<ast::BinaryOp> operation_of(ast::AssignOp op)
{
    using ast::BinaryOp;
    using enum ast::AssignOp;
    switch (op) {
    case assign: return std::nullopt;
    case add: return BinaryOp::add;
    case subtract: return BinaryOp::subtract;
    case multiply: return BinaryOp::multiply;
    case divide: return BinaryOp::divide;
    case remainder: return BinaryOp::remainder;
    case bit_and: return BinaryOp::bit_and;
    case bit_or: return BinaryOp::bit_or;
    case bit_xor: return BinaryOp::bit_xor;
    case shift_left: return BinaryOp::shift_left;
    case shift_right: return BinaryOp::shift_right;
    }
    return std::nullopt;
}

std::string_view spelling(ast::BinaryOp op)
{
    using enum ast::BinaryOp;
    switch (op) {
    case add: return "+";
    case subtract: return "-";
    case multiply: return "*";
    case divide: return "/";
    case remainder: return "%";
    case less: return "<";
    case less_equal: return "<=";
    case greater: return ">";
    case greater_equal: return ">=";
    case equal: return "==";
    case not_equal: return "!=";
    case logical_and: return "&&";
    case logical_or: return "||";
    case logical_xor: return "^^";
    case bit_and: return "&";
    case bit_or: return "|";
    case bit_xor: return "^";
    case shift_left: return "<<";
    case shift_right: return ">>";
    }
    return {};
}

std::string_view spelling(ast::UnaryOp op)
{
    using enum ast::UnaryOp;
    switch (op) {
    case negate: return "-";
    case plus: return "+";
    case logical_not: return "!";
    case bit_not: return "~";
    }
    return {};
}

std::string_view spelling(ast::AssignOp op)
{
    using enum ast::AssignOp;
    switch (op) {
    case assign: return "=";
    case add: return "+=";
    case subtract: return "-=";
    case multiply: return "*=";
    case divide: return "/=";
    case remainder: return "%=";
    case bit_and: return "&=";
    case bit_or: return "|=";
    case bit_xor: return "^=";
    case shift_left: return "<<=";
    case shift_right: return ">>=";
    }
    return {};
}

} // namespace haptel::lang
