#include "lang/check/constant.h"

#include "lang/ir/run/interpret.h"
#include "lang/lower/lowering.h"

namespace haptel::lang {

using namespace ast;

namespace {

// The many cells of large tables are plain numbers: those need no program.
std::optional<double> literal_real(const Expression& e)
{
    if (auto literal = std::get_if<NumberLiteral>(&e.node))
        return e.type == float_type ? literal->value : static_cast<double>(static_cast<int32_t>(literal->integer));
    auto unary = std::get_if<Unary>(&e.node);
    if (!unary || unary->op != UnaryOp::negate || e.type != float_type) return std::nullopt;
    const auto positive = literal_real(*unary->operand);
    return positive ? std::optional(-*positive) : std::nullopt;
}

const Expression* first_of(const std::vector<ExpressionPtr>& list)
{
    for (const ExpressionPtr& e : list)
        if (auto found = first_not_constant(*e)) return found;
    return nullptr;
}

} // namespace

const Expression* first_not_constant(const Expression& e)
{
    if (auto name = std::get_if<NameExpression>(&e.node)) {
        const bool known =
            name->symbol && (name->symbol->kind == SymbolKind::constant || name->symbol->kind == SymbolKind::table);
        return known && !e.type.is_error() ? nullptr : &e; // what a mistake has left without a type has no value
    }
    if (auto unary = std::get_if<Unary>(&e.node)) return first_not_constant(*unary->operand);
    if (auto member = std::get_if<Member>(&e.node)) return first_not_constant(*member->object);
    if (auto index = std::get_if<Index>(&e.node)) {
        auto found = first_not_constant(*index->object);
        return found ? found : first_not_constant(*index->index);
    }
    if (auto choice = std::get_if<Conditional>(&e.node)) {
        for (const ExpressionPtr* part : {&choice->condition, &choice->when_true, &choice->when_false})
            if (auto found = first_not_constant(**part)) return found;
        return nullptr;
    }
    if (auto chain = std::get_if<Chain>(&e.node)) {
        if (auto found = first_not_constant(*chain->first)) return found;
        for (const Chain::Link& link : chain->rest)
            if (auto found = first_not_constant(*link.operand)) return found;
        return nullptr;
    }
    if (auto call = std::get_if<CallExpression>(&e.node)) {
        const bool known =
            call->target.is_constructor || std::holds_alternative<const BuiltinOverload*>(call->target.function);
        return known ? first_of(call->arguments) : &e;
    }
    if (std::holds_alternative<NumberLiteral>(e.node) || std::holds_alternative<BoolLiteral>(e.node)) return nullptr;
    return &e;
}

std::vector<ConstantPart> evaluate_constant(const Expression& e, Type type)
{
    if (type == float_type)
        if (const auto value = literal_real(e)) return {*value};
    ir::Module module;
    Diagnostics unused; // the parser has bounded the depth of every expression
    ModuleLowering lowering(module, unused);
    BodyLowering body(lowering, "constant", 0);
    const Values parts = body.converted(e, type);
    const uint32_t function = body.builder.finish(parts);
    return ir::interpret<double>(module, function, {}, nullptr);
}

double as_number(const ConstantPart& part, Type type)
{
    if (auto real = std::get_if<double>(&part)) return *real;
    if (auto truth = std::get_if<bool>(&part)) return *truth ? 1 : 0;
    const uint32_t bits = std::get<uint32_t>(part);
    return type == uint_type ? static_cast<double>(bits) : static_cast<double>(static_cast<int32_t>(bits));
}

} // namespace haptel::lang
