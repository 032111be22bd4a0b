// Parameters of textures: the numbers that applications and sliders set.
#include "lang/body_checker.h"
#include "lang/constant.h"

#include <cmath>
#include <functional>

namespace haptel::lang {

using namespace ast;

namespace {

struct UnitName {
    std::string_view written, si;
};
constexpr UnitName units[] = {{"m", "m"},     {"cm", "m"}, {"mm", "m"}, {"um", "m"},  {"nm", "m"},  {"rad", "rad"},
                              {"deg", "rad"}, {"s", "s"},  {"ms", "s"}, {"Hz", "Hz"}, {"kHz", "Hz"}};

// SI unit of the first literal that has one.
std::string unit_in(const Expression& e)
{
    if (auto literal = std::get_if<NumberLiteral>(&e.node)) {
        for (const UnitName& unit : units)
            if (unit.written == literal->unit) return std::string(unit.si);
    }
    if (auto unary = std::get_if<Unary>(&e.node)) return unit_in(*unary->operand);
    if (auto chain = std::get_if<Chain>(&e.node)) {
        std::string unit = unit_in(*chain->first);
        for (const Chain::Link& link : chain->rest)
            if (unit.empty()) unit = unit_in(*link.operand);
        return unit;
    }
    return {};
}

// "0.0008 m", for messages.
std::string with_unit(const SourceSet& sources, const Expression& e)
{
    return printable(sources.text(e.span));
}

} // namespace

std::optional<double> BodyChecker::check_constant(Expression& e, Type type, const std::string& where)
{
    const uint32_t reports = diagnostics.reports();
    expression(e);
    if (!require(e, type, where) || diagnostics.reports() != reports) return std::nullopt;
    if (const Expression* culprit = first_not_constant(e)) {
        diagnostics.error(culprit->span, "not-constant", "expected a value known when the texture is compiled" + where)
            .hint = "literals, global constants and built-in functions of them are";
        return std::nullopt;
    }
    return as_number(evaluate_constant(e, type).front(), type);
}

CheckedParameter check_texture_parameter(CheckContext& context, const FileScope& scope, TextureParameter& tree)
{
    Diagnostics& diagnostics = context.diagnostics;
    CheckedParameter made;
    made.tree = &tree;
    Symbol& symbol = context.program.symbols.emplace_back();
    made.symbol = &symbol;
    if (tree.is_output) {
        diagnostics.error(tree.span, "not-supported", "outputs besides the height are not supported").hint =
            "return the height; set stiffness and friction in the scene";
        return made; // of no type: nothing more is said about it
    }
    symbol.type = resolve_type(context, tree.type);
    const std::string name = quoted(tree.name.text);
    if (!symbol.type.is_error() && (symbol.type.is_vector() || symbol.type == void_type || tree.type.is_array)) {
        diagnostics
            .error(tree.type.base.span, "type-mismatch",
                   "a parameter of a texture is a float, int, uint or bool, found " +
                       (tree.type.is_array ? "a table" : to_string(symbol.type)))
            .hint = symbol.type.is_vector() ? "take the components as parameters of their own" : "";
        symbol.type = Type::error();
    }
    BodyChecker checker(context, scope, true);
    const Type type = symbol.type;
    const auto value =
        tree.value ? checker.check_constant(*tree.value, type, " as the default of " + name) : std::nullopt;
    if (tree.value) made.unit = unit_in(*tree.value);
    made.value = value.value_or(0);
    if (!std::isfinite(made.value)) {
        diagnostics.error(tree.value->span, "not-finite", "the default of " + name + " is not a finite number");
        made.value = 0;
    }
    if (!tree.minimum || !tree.maximum) return made;
    if (type == bool_type) {
        diagnostics.error(join(tree.minimum->span, tree.maximum->span), "type-mismatch", "a bool has no range");
        return made;
    }
    const auto minimum = checker.check_constant(*tree.minimum, type, " as the least value of " + name);
    const auto maximum = checker.check_constant(*tree.maximum, type, " as the greatest value of " + name);
    if (!minimum || !maximum) return made;
    for (const Expression* e : {tree.minimum.get(), tree.maximum.get()})
        if (made.unit.empty()) made.unit = unit_in(*e);
    const std::string shown =
        with_unit(context.sources, *tree.minimum) + " .. " + with_unit(context.sources, *tree.maximum);
    if (!(*minimum <= *maximum)) {
        diagnostics.error(join(tree.minimum->span, tree.maximum->span), "empty-range",
                          "the range " + shown + " of " + name + " is empty, expected the lesser value first");
        return made;
    }
    made.minimum = *minimum;
    made.maximum = *maximum;
    if (type == int_type || type == uint_type)
        symbol.range = ir::IntRange{static_cast<int64_t>(*minimum), static_cast<int64_t>(*maximum)};
    if (value && (made.value < made.minimum || made.value > made.maximum))
        diagnostics.error(tree.value->span, "default-out-of-range",
                          "the default " + with_unit(context.sources, *tree.value) + " of " + name +
                              " is outside of its range " + shown);
    return made;
}

} // namespace haptel::lang
