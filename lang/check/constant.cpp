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

} // namespace

const Expression* first_not_constant(const Expression& e)
{
    if (auto name = std::get_if<NameExpression>(&e.node)) {
        const bool known =
            name->symbol && (name->symbol->kind == SymbolKind::constant || name->symbol->kind == SymbolKind::table);
        return known && !e.type.is_error() ? nullptr : &e; // what a mistake has left without a type has no value
    }
    if (auto call = std::get_if<CallExpression>(&e.node))
        if (!call->target.is_constructor && !std::holds_alternative<const BuiltinOverload*>(call->target.function))
            return &e;
    auto list = std::get_if<BraceList>(&e.node);
    if (std::holds_alternative<ErrorExpression>(e.node) || std::holds_alternative<GradCall>(e.node) ||
        (list && !list->type))
        return &e;
    for (const Expression* operand : operands_of(e))
        if (auto found = first_not_constant(*operand)) return found;
    return nullptr;
}

struct ConstantEvaluator::Work {
    ir::Module module;
    Diagnostics unused; // the parser has bounded the depth of every expression
    ModuleLowering lowering{module, unused};
};

ConstantEvaluator::ConstantEvaluator() : work(std::make_shared<Work>()) {}

std::vector<ConstantPart> ConstantEvaluator::value(const Expression& e, Type type)
{
    if (type == float_type)
        if (const auto literal = literal_real(e)) return {*literal};
    BodyLowering body(work->lowering, "constant", 0);
    const Values parts = body.converted(e, type);
    const uint32_t function = body.builder.finish(parts);
    ir::Interpreter<double> interpreter(work->module);
    std::vector<ConstantPart> found;
    const std::vector<ir::Type> types = ir_types(type);
    for (const ir::Slot<double>& slot : interpreter.run(function, {}, nullptr)) {
        const ir::Type part = types[found.size()];
        if (part == ir::Type::real)
            found.emplace_back(slot.real);
        else if (part == ir::Type::boolean)
            found.emplace_back(slot.bits != 0);
        else
            found.emplace_back(slot.bits);
    }
    work->module.functions.pop_back(); // nothing calls it
    return found;
}

double as_number(const ConstantPart& part, Type type)
{
    if (auto real = std::get_if<double>(&part)) return *real;
    if (auto truth = std::get_if<bool>(&part)) return *truth ? 1 : 0;
    const uint32_t bits = std::get<uint32_t>(part);
    return type == uint_type ? static_cast<double>(bits) : static_cast<double>(static_cast<int32_t>(bits));
}

} // namespace haptel::lang
