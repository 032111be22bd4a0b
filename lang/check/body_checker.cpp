// Scopes and whole bodies.
#include "lang/check/body_checker.h"
#include "lang/syntax/foreign.h"
#include "lang/text/limits.h"
#include "lang/text/near_name.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

BodyChecker::BodyChecker(CheckContext& check_context, const FileScope& file_scope, bool in_library)
    : context(check_context), diagnostics(check_context.diagnostics), scope(file_scope), is_library(in_library)
{
}

// ---- names

Symbol* BodyChecker::find_local(std::string_view name) const
{
    const auto found = by_name.find(name);
    return found == by_name.end() || found->second.empty() ? nullptr : found->second.back().symbol;
}

const Symbol* BodyChecker::find(std::string_view name) const
{
    if (const Symbol* local = find_local(name)) return local;
    if (const Symbol* constant = scope.constant(name)) return constant;
    for (const Symbol* input : context.inputs)
        if (input->name == name) return input;
    return nullptr;
}

void BodyChecker::mark_read(std::string_view name)
{
    if (Symbol* local = find_local(name)) local->is_read = true;
}

Symbol& BodyChecker::declare(const Name& name, SymbolKind kind, Type type)
{
    if (type_named(name.text)) {
        diagnostics.error(name.span, "reserved-name", quoted(name.text) + " is a type, expected a name of your own");
    }
    const size_t depth = scope_marks.size();
    if (Symbol* other = find_local(name.text);
        other && !type.is_error() && !other->type.is_error() && by_name.find(name.text)->second.back().depth == depth) {
        other->is_read = other->is_assigned = true; // whichever was meant
        diagnostics.error(name.span, "duplicate-name", quoted(name.text) + " is declared twice in one block")
            .related.push_back({other->span, "first declared here"});
    }
    Symbol& symbol = context.program.symbols.emplace_back();
    symbol.kind = kind;
    symbol.name = name.text;
    symbol.type = type;
    symbol.span = name.span;
    symbol.is_read = type_named(name.text).has_value();
    if (kind == SymbolKind::local) {
        symbol.slot = slot_count;
        if (symbol.slot == variables_max)
            diagnostics.error(name.span, "too-large",
                              "expected at most " + std::to_string(variables_max) +
                                  " variables in a function or texture",
                              "an array is one; what repeats is a loop");
        Variable& variable = new_variable();
        if (type == uint_type) variable.range = ir::full_range(ir::Type::u32);
    }
    by_name[symbol.name].push_back({&symbol, depth}); // the key lives in the symbol
    declared.push_back(&symbol);
    return symbol;
}

BodyChecker::Variable& BodyChecker::new_variable()
{
    flow.variables.resize(++slot_count);
    return flow.variables.back();
}

void BodyChecker::close_scope()
{
    for (; declared.size() > scope_marks.back(); declared.pop_back()) {
        const Symbol& symbol = *declared.back();
        report_unused(symbol);
        by_name.find(symbol.name)->second.pop_back();
    }
    scope_marks.pop_back();
}

void BodyChecker::report_unused(const Symbol& symbol)
{
    if (symbol.is_read || is_library || in_damaged_body || symbol.type.is_error()) return;
    if (symbol.is_parameter)
        diagnostics.warning(symbol.span, "unused-parameter",
                            "parameter " + quoted(symbol.name) + " of " + quoted(owner_name) + " is never read");
    else
        diagnostics.warning(symbol.span, "unused-variable", quoted(symbol.name) + " is never read");
}

bool BodyChecker::may_be_unread(const std::string& name) const
{
    return scope.may_be_unread(name) || (damage && (damage->in_head || damage->unread.contains(name)));
}

void BodyChecker::report_unknown_name(Span span, const std::string& name)
{
    if (may_be_unread(name) || !unknown_names.insert(name).second || diagnostics.full())
        return diagnostics.count_consequence();
    const auto report = [&]() -> Diagnostic& {
        return diagnostics.error(span, "unknown-name", "unknown name " + quoted(name));
    };
    if (scope.declares_constant_later(name)) {
        report().hint = "it is declared further down: a constant is known from its declaration on";
        return;
    }
    if (const ForeignWord* foreign = foreign_word(ForeignKind::name, name)) {
        Diagnostic& reported = report();
        reported.hint = foreign->hint;
        if (!foreign->replacement.empty()) reported.fix = FixIt{span, std::string(foreign->replacement)};
        return;
    }
    if (context.near_searches == 0) return in_damaged_body ? diagnostics.count_consequence() : void(report());
    --context.near_searches;
    std::vector<std::string_view> names;
    for (const auto& [local, bindings] : by_name)
        if (!bindings.empty()) names.push_back(local);
    std::sort(names.begin(), names.end()); // the hash's order must not decide between equals
    scope.collect_constant_names(names);
    for (const Symbol* input : context.inputs) names.push_back(input->name);
    const auto [nearest, is_only] = near_name(name, names);
    // Most likely what declares it could not be read.
    if (in_damaged_body && nearest.empty()) return diagnostics.count_consequence();
    Diagnostic& reported = report();
    if (!nearest.empty()) {
        reported.hint = "did you mean " + quoted(nearest) + "?";
        if (is_only) reported.fix = FixIt{span, std::string(nearest)};
        mark_read(nearest); // if it was meant, it is read
    }
}

// ---- bodies

void BodyChecker::whole_body(StatementPtr& tree, const Name& name, Type result, const char* what,
                             const Damage& body_damage)
{
    result_type = result;
    damage = &body_damage;
    in_damaged_body = body_damage.any;
    if (!tree) return;
    if (auto block = std::get_if<Scope>(&tree->node))
        statements(block->statements); // in the parameters' scope, as in C
    if (flow.reachable && !in_damaged_body && !result.is_error()) {
        diagnostics.error(name.span, "missing-return",
                          std::string(what) + " " + quoted(name.text) + " can end without returning a " +
                              to_string(result),
                          "end it with 'return ...;' outside of every if and for");
    }
}

void BodyChecker::check_function(Function& tree, FunctionInfo& info)
{
    owner_name = info.name;
    open_scope();
    uint32_t functions = 0;
    for (size_t i = 0; i < info.parameters.size(); ++i) {
        ParameterInfo& parameter = info.parameters[i];
        const Name& name = tree.parameters[i].name;
        if (name.text.empty()) {
            if (!parameter.is_function)
                new_variable(); // keeps slots of value parameters in a row
            else
                ++functions;
            continue;
        }
        Symbol& symbol =
            declare(name, parameter.is_function ? SymbolKind::function : SymbolKind::local, parameter.type);
        symbol.is_parameter = true;
        if (parameter.is_function) {
            symbol.slot = functions++;
            for (Type type : parameter.signature) symbol.parameters.push_back({type});
        } else {
            flow.variables[symbol.slot].assigned = all_parts;
            if (parameter.type == image_type) symbol.read_only = "it is an image";
        }
        parameter.symbol = &symbol;
    }
    whole_body(tree.body, tree.name, info.result, "function", tree.damage);
    close_scope();
    info.slot_count = slot_count;
    info.reads = reads;
    info.mentions = std::move(mentions);
}

void BodyChecker::check_texture(Texture& tree, CheckedTexture& texture)
{
    owner_name = tree.name.text;
    open_scope();
    for (TextureParameter& parameter : tree.parameters) {
        if (!parameter.is_output) continue;
        const uint32_t bit = check_output(parameter);
        Symbol& symbol = declare(parameter.name, SymbolKind::local, bit ? float_type : Type::error());
        flow.variables[symbol.slot].assigned = all_parts; // 1 from the start
        symbol.is_read = true;                            // by whoever called
        if (bit) texture.outputs.push_back({&symbol, bit});
    }
    std::ranges::sort(texture.outputs, {}, &CheckedOutput::writes);
    for (size_t i = 0; i < texture.parameters.size(); ++i) {
        CheckedParameter& parameter = texture.parameters[i];
        Symbol& symbol = declare(parameter.tree->name, SymbolKind::texture_parameter, parameter.symbol->type);
        symbol.slot = static_cast<uint32_t>(i);
        symbol.range = parameter.symbol->range;
        symbol.read_only = "it is a parameter of the texture";
        symbol.is_parameter = true;
        parameter.symbol = &symbol;
    }
    whole_body(tree.body, tree.name, float_type, "texture", tree.damage);
    for (const CheckedOutput& output : texture.outputs)
        if (!output.symbol->is_assigned && !is_library && !in_damaged_body)
            diagnostics.warning(output.symbol->span, "unassigned-output",
                                "output " + quoted(output.symbol->name) + " is never assigned: it is always 1",
                                "assign it in the body or leave it out");
    close_scope();
    texture.slot_count = slot_count;
    texture.mentions = std::move(mentions);
}

Symbol* BodyChecker::check_global(Declaration& declaration)
{
    open_scope();
    is_global = true;
    Statement scratch{declaration.name.span, Break{}};
    declaration.is_const = true;
    check(scratch, declaration);
    Symbol* made = declared.empty() ? nullptr : declared.back();
    declared.clear(); // unread globals are nobody's mistake
    if (!made || made->kind != SymbolKind::local) return made;
    const bool has_type = declaration.initializer && !declaration.initializer->type.is_error();
    const Expression* culprit = has_type ? first_not_constant(*declaration.initializer) : nullptr;
    if (culprit && !culprit->type.is_error())
        diagnostics.error(culprit->span, "not-constant",
                          "a global is constant, expected a value known when the texture is compiled",
                          "literals, other constants and built-in functions of them are");
    made->kind = SymbolKind::constant; // no variable of any body
    made->type = Type::error();
    return made;
}

} // namespace haptel::lang
