// Textures: their parameters, which are the numbers that applications and sliders set, and the material outputs.
#include "lang/abi/outputs.h"
#include "lang/check/body_checker.h"
#include "lang/check/type_hint.h"
#include "lang/text/number.h"

#include <algorithm>
#include <cmath>

namespace haptel::lang {

using namespace ast;

namespace {

// 'out float friction_scale'
std::string declaration_of(const OutputInfo& output)
{
    return "'out " + std::string(output.components == 1 ? "float " : "vec3 ") + std::string(output.name) + "'";
}

// 'out float a', 'out float b' and 'out vec3 c'
std::string all_declarations()
{
    std::string all;
    for (const OutputInfo& output : output_table) {
        if (!all.empty()) all += &output == std::end(output_table) - 1 ? " and " : ", ";
        all += declaration_of(output);
    }
    return all;
}

std::vector<std::string_view> all_names()
{
    std::vector<std::string_view> all;
    for (const OutputInfo& output : output_table) all.push_back(output.name);
    return all;
}

Type type_of(const OutputInfo& output)
{
    return vec(static_cast<uint8_t>(output.components));
}

// Where the body does not assign it.
std::string shown_value(const OutputInfo& output)
{
    return output.value == 0 ? "0" : "1";
}

// SI unit of the first literal that has one.
std::string unit_in(const Expression& e)
{
    if (auto literal = std::get_if<NumberLiteral>(&e.node)) return std::string(si_unit(literal->unit));
    std::string unit;
    const auto call = std::get_if<CallExpression>(&e.node); // vec2(21cm, 7cm)
    if (std::holds_alternative<Unary>(e.node) || std::holds_alternative<Chain>(e.node) ||
        (call && call->target.is_constructor))
        for (const Expression* operand : operands_of(e))
            if (unit.empty()) unit = unit_in(*operand);
    return unit;
}

} // namespace

std::string list_of(const std::vector<Name>& names)
{
    std::string list;
    for (size_t i = 0; i < names.size(); ++i)
        list += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + printable(names[i].text);
    return list;
}

namespace {

void make_choice(Symbol& symbol, uint32_t value)
{
    symbol.kind = SymbolKind::constant;
    symbol.type = int_type;
    symbol.value = {value};
    symbol.range = ir::IntRange{value, value};
    symbol.is_choice = symbol.is_read = true;
    symbol.read_only = "it is the name of a choice";
}

} // namespace

// As constants of the innermost scope. Two lists may have a name in common that stands for the same in both.
void BodyChecker::declare_choices(const std::vector<Name>& names)
{
    for (uint32_t i = 0; i < names.size(); ++i) {
        const Symbol* known = find_local(names[i].text);
        const bool is_shared = known && known->is_choice && known->value == std::vector<ConstantPart>{i};
        if (!is_shared) make_choice(declare(names[i], SymbolKind::constant, int_type), i);
    }
}

// For where one of them is expected and nothing is declared. Of two of one name, which is told, the first.
const Choices* BodyChecker::choices_of(const std::vector<Name>& names)
{
    Choices& made = context.program.choices.emplace_back(Choices{&names});
    for (uint32_t i = 0; i < names.size(); ++i) {
        Symbol& symbol = context.program.symbols.emplace_back();
        symbol.name = names[i].text;
        symbol.span = names[i].span;
        make_choice(symbol, i);
        made.constants.emplace(symbol.name, &symbol);
    }
    return &made;
}

// Of what is around the body.
void BodyChecker::check_parameters(Texture& tree, CheckedTexture& texture)
{
    open_scope();
    for (TextureParameter& parameter : tree.parameters) {
        if (parameter.is_output)
            check_output(parameter, texture);
        else
            check_parameter(parameter, texture);
    }
}

void BodyChecker::check_texture(Texture& tree, CheckedTexture& texture)
{
    check_parameters(tree, texture);
    std::ranges::sort(texture.outputs, {}, &CheckedOutput::info); // they stand in the table by bit
    whole_body(tree.body, tree.name, float_type, "texture", tree.damage);
    for (const CheckedOutput& output : texture.outputs)
        if (output.symbol->parts_assigned == 0 && !context.is_library && !in_damaged_body)
            diagnostics.warning(output.symbol->span, "unassigned-output",
                                "output " + quoted(output.symbol->name) + " is never assigned: it is always " +
                                    shown_value(*output.info),
                                "assign it in the body or leave it out");
    close_scope();
    texture.slot_count = slot_count;
    texture.mentions = std::move(mentions);
}

void BodyChecker::check_output(TextureParameter& tree, CheckedTexture& texture)
{
    const OutputInfo* const output = find_output(tree.name.text);
    bool is_sound = output != nullptr;
    if (!is_sound) {
        Diagnostic& reported =
            diagnostics.error(tree.name.span, "unknown-output", "unknown output " + quoted(tree.name.text),
                              "a texture may write " + all_declarations());
        const NearName near = near_name(tree.name.text, all_names());
        propose(reported, tree.name.span, near);
        unknown_names.emplace(near.name); // where it is meant it is not news
    }
    const Type type = resolve_type(context, tree.type);
    const Type wanted = output ? type_of(*output) : float_type;
    if (!type.is_error() && (type != wanted || tree.type.is_array)) {
        diagnostics.error(tree.type.base.span, "type-mismatch",
                          wanted == float_type ? "an output is a float"
                                               : quoted(tree.name.text) + " is a " + to_string(wanted),
                          output ? "write " + declaration_of(*output) : "");
        is_sound = false;
    }
    if (tree.value || tree.minimum || !tree.choices.empty()) {
        const Span given = tree.value     ? tree.value->span
                           : tree.minimum ? tree.minimum->span
                                          : tree.choices.front().span;
        diagnostics.error(
            given, "output-default", "an output has neither default nor range, expected ',' or ')' behind its name",
            (output ? "it is " + shown_value(*output) + " until the body assigns it: " : "assign it in the body: ") +
                tree.name.text + " = ...;");
        is_sound = false;
    }
    Symbol& symbol = declare(tree.name, SymbolKind::local, is_sound ? wanted : Type::error());
    flow.variables[symbol.slot].assigned = all_parts; // from the start
    symbol.is_read = true;                            // by whoever called
    if (is_sound) texture.outputs.push_back({&symbol, output});
}

// The components of a constant outside of any body; none once a mistake was reported. The end of a vector's range may
// be one number for all of them.
std::vector<double> BodyChecker::check_constant(Expression& e, Type type, const std::string& where, bool is_range)
{
    const uint32_t reports = diagnostics.reports();
    expression(e);
    const Type wanted = is_range && type.is_vector() && e.type.is_scalar() ? float_type : type;
    require(e, wanted, where);
    if (diagnostics.reports() != reports) return {};
    if (const Expression* culprit = first_not_constant(e)) {
        diagnostics.error(culprit->span, "not-constant", "expected a value known when the texture is compiled" + where,
                          "literals, global constants and built-in functions of them are");
        return {};
    }
    std::vector<double> numbers;
    for (const ConstantPart& part : context.constants.value(e, wanted)) numbers.push_back(as_number(part, wanted));
    numbers.resize(type.components(), numbers.front());
    return numbers;
}

void BodyChecker::check_parameter(TextureParameter& tree, CheckedTexture& texture)
{
    const std::string name = quoted(tree.name.text);
    Type type = resolve_type(context, tree.type);
    const bool is_vector = type.is_vector() && type.scalar == Scalar::float_;
    const bool may_be_set = (type.is_scalar() && type != void_type) || is_vector;
    if (!type.is_error() && (!may_be_set || tree.type.is_array)) {
        diagnostics.error(tree.type.base.span, "type-mismatch",
                          "a parameter of a texture is a float, int, uint, bool, vec2, vec3, vec4 or image, found " +
                              (tree.type.is_array ? "a table" : to_string(type)),
                          type.is_struct()
                              ? "take its members as parameters, and make it in the body: " + constructor_of(type)
                          : !type.is_scalar() ? "take the components as parameters of their own"
                                              : "");
        type = Type::error();
    }
    if (!tree.choices.empty() && !type.is_error() && type != int_type) {
        diagnostics.error(join(tree.choices.front().span, tree.choices.back().span), "choices",
                          "choices are for an int, found " + to_string(type), "they are 0, 1, 2 ... by other names");
        type = int_type; // as it was meant
    }
    Symbol& symbol = declare(tree.name, SymbolKind::texture_parameter, type);
    symbol.slot = texture.parameters.empty() ? 0
                                             : texture.parameters.back().symbol->slot +
                                                   static_cast<uint32_t>(texture.parameters.back().components.size());
    symbol.read_only = "it is a parameter of the texture";
    symbol.is_parameter = true;
    CheckedParameter& made = texture.parameters.emplace_back();
    made.tree = &tree;
    made.symbol = &symbol;
    made.components.resize(type.is_vector() ? type.size : 1);
    if (type == image_type) {
        const Expression* given = tree.value ? tree.value.get() : tree.minimum.get();
        if (given)
            diagnostics.error(given->span, "image", "an image has neither default nor range, expected ',' or ')'",
                              "it is flat, 0 everywhere, until a scene names a file: parameters = { " + tree.name.text +
                                  " = \"dents.png\" }");
        return;
    }
    // Where nothing of the texture is known, and of a preset in the file that it has it from.
    if (!tree.choices.empty()) made.choices = choices_of(tree.choices);
    const auto constant = [&](Expression& e, const std::string& where, bool is_range = false) {
        const bool is_own = !context.scopes || e.span.file >= context.scopes->size();
        BodyChecker around(context, is_own ? scope : (*context.scopes)[e.span.file]);
        around.choices = made.choices;
        return around.check_constant(e, type, where, is_range);
    };
    const std::vector<double> value =
        tree.value ? constant(*tree.value, " as the default of " + name) : std::vector<double>{};
    for (const Expression* e : {tree.value.get(), tree.minimum.get(), tree.maximum.get()})
        if (e && made.unit.empty()) made.unit = unit_in(*e);
    const bool is_finite = std::ranges::all_of(value, [](double number) { return std::isfinite(number); });
    if (!is_finite)
        diagnostics.error(tree.value->span, "not-finite", "the default of " + name + " is not a finite number");
    const bool has_value = !value.empty() && is_finite;
    for (size_t i = 0; has_value && i < value.size(); ++i) made.components[i].value = value[i];
    if (made.choices) {
        declare_choices(tree.choices);
        const auto last = static_cast<int64_t>(tree.choices.size()) - 1;
        CheckedParameter::Component& only = made.components.front();
        only.minimum = 0;
        only.maximum = static_cast<double>(last);
        symbol.range = ir::IntRange{0, last};
        if (has_value && (only.value < only.minimum || only.value > only.maximum))
            diagnostics.error(tree.value->span, "default-out-of-range",
                              "the default " + printable(context.sources.text(tree.value->span)) + " of " + name +
                                  " is none of its choices, 0 .. " + std::to_string(last),
                              "expected " + list_of(tree.choices));
    }
    if (!tree.minimum || !tree.maximum) return;
    if (type == bool_type) {
        diagnostics.error(join(tree.minimum->span, tree.maximum->span), "type-mismatch", "a bool has no range");
        return;
    }
    const std::vector<double> minimum = constant(*tree.minimum, " as the least value of " + name, true);
    const std::vector<double> maximum = constant(*tree.maximum, " as the greatest value of " + name, true);
    if (minimum.empty() || maximum.empty()) return;
    if (check_range(tree, made, has_value, minimum, maximum) && is_integer(type))
        symbol.range = ir::IntRange{static_cast<int64_t>(minimum[0]), static_cast<int64_t>(maximum[0])};
}

// The range that was read, for each component. False if it is none.
bool BodyChecker::check_range(const TextureParameter& tree, CheckedParameter& made, bool has_value,
                              const std::vector<double>& minimum, const std::vector<double>& maximum)
{
    const auto shown = [&](const Expression& e) { return printable(context.sources.text(e.span)); };
    const std::string name = quoted(tree.name.text), range = shown(*tree.minimum) + " .. " + shown(*tree.maximum);
    const auto of_component = [&](size_t i) {
        return minimum.size() > 1 ? std::string(" in its component ") + "xyzw"[i] : "";
    };
    for (size_t i = 0; i < minimum.size(); ++i)
        if (!(minimum[i] <= maximum[i])) {
            diagnostics.error(join(tree.minimum->span, tree.maximum->span), "empty-range",
                              "the range " + range + " of " + name + " is empty" + of_component(i) +
                                  ", expected the lesser value first");
            return false;
        }
    for (size_t i = 0; i < minimum.size(); ++i) {
        CheckedParameter::Component& component = made.components[i];
        component.minimum = minimum[i];
        component.maximum = maximum[i];
        if (!has_value || (component.value >= minimum[i] && component.value <= maximum[i])) continue;
        diagnostics.error(tree.value->span, "default-out-of-range",
                          "the default " + shown(*tree.value) + " of " + name + " is outside of its range " + range +
                              of_component(i));
        has_value = false; // told
    }
    return true;
}

} // namespace haptel::lang
