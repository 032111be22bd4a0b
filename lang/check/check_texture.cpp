// Parameters of textures: the numbers that applications and sliders set, and the material outputs.
#include "lang/abi/abi.h"
#include "lang/check/body_checker.h"
#include "lang/check/constant.h"
#include "lang/text/near_name.h"
#include "lang/text/number.h"

#include <cmath>
#include <functional>

namespace haptel::lang {

using namespace ast;

namespace {

struct OutputName {
    std::string_view name;
    uint32_t writes;
};
constexpr OutputName output_names[] = {{"stiffness_scale", HAPTEL_WRITES_STIFFNESS_SCALE},
                                       {"friction_scale", HAPTEL_WRITES_FRICTION_SCALE}};

// SI unit of the first literal that has one.
std::string unit_in(const Expression& e)
{
    if (auto literal = std::get_if<NumberLiteral>(&e.node)) return std::string(si_unit(literal->unit));
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
        if (culprit->type.is_error()) return std::nullopt; // of a mistake that was reported
        diagnostics.error(culprit->span, "not-constant", "expected a value known when the texture is compiled" + where,
                          "literals, global constants and built-in functions of them are");
        return std::nullopt;
    }
    return as_number(context.constants.value(e, type).front(), type);
}

uint32_t BodyChecker::check_output(TextureParameter& tree)
{
    constexpr const char* names = "a texture may write 'out float stiffness_scale' and 'out float friction_scale'";
    uint32_t bit = 0;
    for (const OutputName& output : output_names)
        if (output.name == tree.name.text) bit = output.writes;
    if (bit == 0) {
        Diagnostic& reported =
            diagnostics.error(tree.name.span, "unknown-output", "unknown output " + quoted(tree.name.text));
        const auto [nearest, is_only] = near_name(tree.name.text, {output_names[0].name, output_names[1].name});
        reported.hint = nearest.empty() ? names : "did you mean " + quoted(nearest) + "?";
        if (is_only) reported.fix = FixIt{tree.name.span, std::string(nearest)};
        unknown_names.emplace(nearest); // where it is meant it is not news
    }
    const Type type = resolve_type(context, tree.type);
    if (!type.is_error() && (type != float_type || tree.type.is_array)) {
        diagnostics.error(tree.type.base.span, "type-mismatch", "an output is a float", names);
        bit = 0;
    }
    if (tree.value || tree.minimum) {
        diagnostics.error((tree.value ? tree.value : tree.minimum)->span, "output-default",
                          "an output has neither default nor range, expected ',' or ')' behind its name",
                          "it is 1 until the body assigns it: " + tree.name.text + " = ...;");
        bit = 0;
    }
    return bit;
}

CheckedParameter check_texture_parameter(CheckContext& context, const FileScope& scope, TextureParameter& tree)
{
    Diagnostics& diagnostics = context.diagnostics;
    CheckedParameter made;
    made.tree = &tree;
    Symbol& symbol = context.program.symbols.emplace_back();
    made.symbol = &symbol;
    symbol.type = resolve_type(context, tree.type);
    const std::string name = quoted(tree.name.text);
    if (!symbol.type.is_error() && (!symbol.type.is_scalar() || symbol.type == void_type || tree.type.is_array)) {
        diagnostics.error(tree.type.base.span, "type-mismatch",
                          "a parameter of a texture is a float, int, uint, bool or image, found " +
                              (tree.type.is_array ? "a table" : to_string(symbol.type)),
                          !symbol.type.is_scalar() ? "take the components as parameters of their own" : "");
        symbol.type = Type::error();
    }
    if (symbol.type == image_type) {
        const Expression* given = tree.value ? tree.value.get() : tree.minimum.get();
        if (given)
            diagnostics.error(given->span, "image", "an image has neither default nor range, expected ',' or ')'",
                              "it is flat, 0 everywhere, until a scene names a file: parameters = { " + tree.name.text +
                                  " = \"dents.png\" }");
        return made;
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
