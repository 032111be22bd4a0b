// What an integer expression can be, as far as it is plain from the text: constants, parameters with a range, loop
// counters, min, max, clamp and arithmetic of them. Rules of single operations: ir/int_range.h.
#include "lang/check/body_checker.h"
#include "lang/ir/semantics.h"

#include <algorithm>
#include <array>

namespace haptel::lang {

using namespace ast;

namespace {

ir::Type ir_type(Type type)
{
    return type == uint_type ? ir::Type::u32 : ir::Type::i32;
}

// Exact where both operands are known.
ir::IntRange apply(ir::Op op, Type type, ir::IntRange a, ir::IntRange b)
{
    if (a.is_constant() && b.is_constant()) {
        const auto slot = [](ir::IntRange r) { return ir::Slot<double>{0, static_cast<uint32_t>(r.minimum)}; };
        ir::Slot<double> result;
        ir::execute<double>(op, result, slot(a), slot(b), {}, {});
        return ir::constant_range(ir_type(type), result.bits);
    }
    return ir::range_of(op, ir_type(type), std::array{a, b});
}

struct IntOperation {
    BinaryOp op;
    ir::Op of_int, of_uint;
};
constexpr IntOperation operations[] = {
    {BinaryOp::add, ir::Op::iadd, ir::Op::iadd},        {BinaryOp::subtract, ir::Op::isub, ir::Op::isub},
    {BinaryOp::multiply, ir::Op::imul, ir::Op::imul},   {BinaryOp::divide, ir::Op::idiv, ir::Op::udiv},
    {BinaryOp::remainder, ir::Op::irem, ir::Op::urem},  {BinaryOp::bit_and, ir::Op::iand, ir::Op::iand},
    {BinaryOp::bit_or, ir::Op::ior, ir::Op::ior},       {BinaryOp::bit_xor, ir::Op::ixor, ir::Op::ixor},
    {BinaryOp::shift_left, ir::Op::ishl, ir::Op::ishl}, {BinaryOp::shift_right, ir::Op::ishr, ir::Op::ushr}};

ir::IntRange absolute(ir::IntRange a)
{
    const int64_t low = a.minimum <= 0 && a.maximum >= 0 ? 0 : std::min(std::abs(a.minimum), std::abs(a.maximum));
    const int64_t high = std::max(std::abs(a.minimum), std::abs(a.maximum));
    return high > INT32_MAX ? ir::full_range(ir::Type::i32) : ir::IntRange{low, high};
}

} // namespace

// What loops may rely on, since a function is compiled for the calls that there are; the finding that an index is
// always outside may not, since it is of the function as it stands.
ir::IntRange BodyChecker::range_over_calls(const Expression& e)
{
    counts_calls = true;
    const ir::IntRange found = range(e);
    counts_calls = false;
    return found;
}

void BodyChecker::hold(Variable& variable, const Expression& value)
{
    variable.range = range(value);
    variable.called = range_over_calls(value);
}

ir::IntRange BodyChecker::range(const Expression& e) const
{
    const ir::IntRange full = full_range(e.type);
    if (!is_integer(e.type)) return full;
    if (auto literal = std::get_if<NumberLiteral>(&e.node))
        return ir::constant_range(ir_type(e.type), static_cast<uint32_t>(literal->integer));
    if (auto name = std::get_if<NameExpression>(&e.node)) {
        if (!name->symbol) return full;
        if (name->symbol->kind == SymbolKind::local) {
            const Variable& variable = flow.variables[name->symbol->slot];
            return counts_calls ? variable.called : variable.range;
        }
        return name->symbol->range.value_or(full);
    }
    if (auto unary = std::get_if<Unary>(&e.node)) {
        const ir::IntRange a = range(*unary->operand);
        switch (unary->op) {
        case UnaryOp::plus: return a;
        case UnaryOp::negate: return apply(ir::Op::isub, e.type, {0, 0}, a);
        case UnaryOp::bit_not: return a.is_constant() ? apply(ir::Op::ixor, e.type, a, {-1, -1}) : full;
        case UnaryOp::logical_not: return full;
        }
    }
    if (auto chain = std::get_if<Chain>(&e.node)) {
        ir::IntRange left = range(*chain->first);
        for (const Chain::Link& link : chain->rest) {
            const auto operation = std::ranges::find(operations, link.op, &IntOperation::op); // others make no integer
            left =
                apply(e.type == uint_type ? operation->of_uint : operation->of_int, e.type, left, range(*link.operand));
        }
        return left;
    }
    if (auto choice = std::get_if<Conditional>(&e.node))
        return ir::join(range(*choice->when_true), range(*choice->when_false));
    if (auto call = std::get_if<CallExpression>(&e.node)) {
        const auto argument = [&](size_t i) { return range(*call->arguments[i]); };
        if (call->target.is_constructor && call->arguments.size() == 1) {
            const Type from = call->arguments[0]->type;
            if (from == e.type) return argument(0);
            if (from == int_type) return apply(ir::Op::i_as_u, e.type, argument(0), {});
            if (from == uint_type) return apply(ir::Op::u_as_i, e.type, argument(0), {});
            if (from == bool_type) return {0, 1};
            return full;
        }
        auto builtin = std::get_if<const BuiltinOverload*>(&call->target.function);
        if (!builtin) return full;
        const BuiltinId id = (*builtin)->builtin->id;
        if (id == BuiltinId::imin || id == BuiltinId::umin || id == BuiltinId::imax || id == BuiltinId::umax)
            return apply(*(*builtin)->builtin->op, e.type, argument(0), argument(1));
        if (id == BuiltinId::iclamp)
            return apply(ir::Op::imin, e.type, apply(ir::Op::imax, e.type, argument(0), argument(1)), argument(2));
        if (id == BuiltinId::uclamp)
            return apply(ir::Op::umin, e.type, apply(ir::Op::umax, e.type, argument(0), argument(1)), argument(2));
        if (id == BuiltinId::iabs) return absolute(argument(0));
    }
    return full;
}

} // namespace haptel::lang
