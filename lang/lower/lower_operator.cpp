// Operators, which go component by component but for products of matrices and vectors.
#include "lang/lower/lowering.h"
#include "lang/syntax/operators.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;
using ir::Op;
using ir::Value;

Values BodyLowering::lower(const Expression& e, const Unary& node)
{
    Values parts = expression(*node.operand);
    builder.span = e.span;
    for (Value& part : parts) {
        const bool is_real = builder.type(part) == ir::Type::real;
        const auto word = [&](uint32_t bits) { return builder.word(bits, builder.type(part)); };
        switch (node.op) {
        case UnaryOp::negate:
            part = is_real ? builder.operation(Op::neg, {part}) : integer(Op::isub, word(0), part);
            break;
        case UnaryOp::plus: break;
        case UnaryOp::logical_not: part = builder.operation(Op::lnot, {part}); break;
        case UnaryOp::bit_not: part = integer(Op::ixor, part, word(UINT32_MAX)); break;
        }
    }
    return parts;
}

// Flat, left to right: the types follow by the same rules as in the checker.
Values BodyLowering::lower(const Expression&, const Chain& node)
{
    Values left = expression(*node.first);
    Type left_type = node.first->type;
    for (const Chain::Link& link : node.rest) {
        const Values right = expression(*link.operand);
        builder.span = join(node.first->span, link.operand->span);
        left = binary(link.op, left, left_type, right, link.operand->type);
        left_type = operator_types(link.op, left_type, link.operand->type)->result;
    }
    return left;
}

Values BodyLowering::binary(BinaryOp op, const Values& a, Type a_type, const Values& b, Type b_type)
{
    const OperatorTypes types = *operator_types(op, a_type, b_type);
    const Values left = convert(a, a_type, types.left), right = convert(b, b_type, types.right);
    if (op == BinaryOp::multiply && is_linear_product(a_type, b_type)) return linear_product(left, right, a_type.size);
    const size_t size = std::max(left.size(), right.size());
    Values made;
    for (size_t i = 0; i < size; ++i)
        made.push_back(binary_scalar(op, left[left.size() == 1 ? 0 : i], right[right.size() == 1 ? 0 : i]));
    if (types.result.components() == size) return made;
    // == and != of vectors and matrices: of all components
    const Op joined = op == BinaryOp::equal ? Op::land : Op::lor;
    Value all = made[0];
    for (size_t i = 1; i < size; ++i) all = builder.operation(joined, {all, made[i]});
    return {all};
}

// m * v, v * m, m * m, of matrices of `size`. A row vector has a row, a column vector a column.
Values BodyLowering::linear_product(const Values& left, const Values& right, size_t size)
{
    const size_t rows = left.size() / size, columns = right.size() / size;
    Values made;
    for (size_t column = 0; column < columns; ++column)
        for (size_t row = 0; row < rows; ++row) {
            Value sum{};
            for (size_t i = 0; i < size; ++i) {
                const Value term = builder.operation(Op::mul, {left[i * rows + row], right[column * size + i]});
                sum = i == 0 ? term : builder.operation(Op::add, {sum, term});
            }
            made.push_back(sum);
        }
    return made;
}

Value BodyLowering::integer(Op op, Value a, Value b)
{
    const auto as_signed = [&](Value v) {
        return builder.type(v) == ir::Type::u32 ? builder.operation(Op::u_as_i, {v}) : v;
    };
    const bool is_unsigned = builder.type(a) == ir::Type::u32;
    const Value made = builder.operation(op, {as_signed(a), as_signed(b)});
    return is_unsigned ? builder.operation(Op::i_as_u, {made}) : made;
}

Value BodyLowering::binary_scalar(BinaryOp op, Value a, Value b)
{
    const ir::Type type = builder.type(a);
    const bool is_real = type == ir::Type::real, is_unsigned = type == ir::Type::u32;
    const auto make = [&](Op name, Value x, Value y) { return builder.operation(name, {x, y}); };
    const auto negated = [&](Value x) { return builder.operation(Op::lnot, {x}); };
    const Op less = is_real ? Op::lt : is_unsigned ? Op::ult : Op::ilt;
    const Op less_equal = is_real ? Op::le : is_unsigned ? Op::ule : Op::ile;
    const auto equal = [&] {
        if (type == ir::Type::boolean) return negated(make(Op::lxor, a, b));
        return make(is_real ? Op::eq : is_unsigned ? Op::ueq : Op::ieq, a, b);
    };
    switch (op) {
    case BinaryOp::add: return is_real ? make(Op::add, a, b) : integer(Op::iadd, a, b);
    case BinaryOp::subtract: return is_real ? make(Op::sub, a, b) : integer(Op::isub, a, b);
    case BinaryOp::multiply: return is_real ? make(Op::mul, a, b) : integer(Op::imul, a, b);
    case BinaryOp::divide: return make(is_real ? Op::div : is_unsigned ? Op::udiv : Op::idiv, a, b);
    case BinaryOp::remainder: return make(is_unsigned ? Op::urem : Op::irem, a, b);
    case BinaryOp::less: return make(less, a, b);
    case BinaryOp::less_equal: return make(less_equal, a, b);
    case BinaryOp::greater: return make(less, b, a);
    case BinaryOp::greater_equal: return make(less_equal, b, a);
    case BinaryOp::equal: return equal();
    case BinaryOp::not_equal: return negated(equal());
    case BinaryOp::logical_and: return make(Op::land, a, b);
    case BinaryOp::logical_or: return make(Op::lor, a, b);
    case BinaryOp::logical_xor: return make(Op::lxor, a, b);
    case BinaryOp::bit_and: return integer(Op::iand, a, b);
    case BinaryOp::bit_or: return integer(Op::ior, a, b);
    case BinaryOp::bit_xor: return integer(Op::ixor, a, b);
    case BinaryOp::shift_left: return integer(Op::ishl, a, b);
    case BinaryOp::shift_right:
        if (!is_unsigned) return integer(Op::ishr, a, b);
        return make(Op::ushr, a, builder.type(b) == ir::Type::i32 ? builder.operation(Op::i_as_u, {b}) : b);
    }
    return a;
}

} // namespace haptel::lang
