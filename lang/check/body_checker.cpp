// Scopes and whole bodies.
#include "lang/check/body_checker.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

void propose(Diagnostic& reported, Span span, const NearName& near, bool fits)
{
    if (near.name.empty()) return;
    reported.hint = "did you mean " + quoted(near.name) + "?";
    if (near.is_only && fits) reported.fix = FixIt{span, std::string(near.name)};
}

void propose(Diagnostic& reported, Span span, const ForeignWord& word)
{
    reported.hint = word.hint;
    if (word.is_exact && !word.replacement.empty()) reported.fix = FixIt{span, std::string(word.replacement)};
}

// ---- names

Symbol* BodyChecker::find_local(std::string_view name) const
{
    const auto found = by_name.find(name);
    return found == by_name.end() || found->second.empty() ? nullptr : found->second.back();
}

const Symbol* BodyChecker::find_choice(std::string_view name) const
{
    if (!choices) return nullptr;
    const auto found = choices->constants.find(name);
    return found == choices->constants.end() ? nullptr : found->second;
}

const Symbol* BodyChecker::find(std::string_view name) const
{
    if (const Symbol* choice = find_choice(name)) return choice;
    if (const Symbol* local = find_local(name)) return local;
    if (const Symbol* constant = scope.constant(name)) return constant;
    for (const Symbol* input : context.inputs)
        if (input->name == name) return input;
    return nullptr;
}

void BodyChecker::mark_read(std::string_view name)
{
    if (Symbol* local = find_choice(name) ? nullptr : find_local(name)) local->is_read = true;
}

Symbol& BodyChecker::declare(const Name& name, SymbolKind kind, Type type)
{
    const bool is_type = type_named(name.text).has_value() || scope.structure(name.text);
    if (is_type)
        diagnostics.error(name.span, "reserved-name", quoted(name.text) + " is a type, expected a name of your own");
    const bool is_prefix = scope.by_prefix.contains(name.text);
    if (is_prefix && !is_global)
        diagnostics.error(name.span, "duplicate-name",
                          quoted(name.text) + " is the prefix of an import in this file, expected another name");
    Symbol* other = find_local(name.text);
    const bool is_twice = std::find(declared.begin() + scope_marks.back(), declared.end(), other) != declared.end();
    if (is_twice && !type.is_error() && !other->type.is_error()) {
        other->is_read = true; // whichever was meant
        other->parts_assigned = all_parts;
        diagnostics.error(name.span, "duplicate-name", quoted(name.text) + " is declared twice in one block")
            .related.push_back({other->span, "first declared here"});
    }
    Symbol& symbol = context.program.symbols.emplace_back();
    symbol.kind = kind;
    symbol.name = name.text;
    symbol.type = type;
    symbol.span = name.span;
    symbol.is_read = is_type || is_prefix;
    if (kind == SymbolKind::local) {
        symbol.slot = slot_count;
        if (symbol.slot == variables_max)
            diagnostics.error(name.span, "too-large",
                              "expected at most " + std::to_string(variables_max) +
                                  " variables in a function or texture",
                              "an array is one; what repeats is a loop");
        flow.variables.resize(++slot_count);
        flow.variables.back().hold(full_range(type));
    }
    by_name[symbol.name].push_back(&symbol); // the key lives in the symbol
    declared.push_back(&symbol);
    return symbol;
}

void BodyChecker::close_scope()
{
    for (; declared.size() > scope_marks.back(); declared.pop_back()) {
        const Symbol& symbol = *declared.back();
        by_name.find(symbol.name)->second.pop_back();
        if (symbol.is_read || context.is_library || in_damaged_body || symbol.type.is_error()) continue;
        if (symbol.is_parameter)
            diagnostics.warning(symbol.span, "unused-parameter",
                                "parameter " + quoted(symbol.name) + " of " + quoted(owner_name) + " is never read");
        else
            diagnostics.warning(symbol.span, "unused-variable", quoted(symbol.name) + " is never read");
    }
    scope_marks.pop_back();
}

bool BodyChecker::may_be_unread(const std::string& name) const
{
    const std::string_view prefix = PrefixedName(name).prefix;
    const bool is_of_local = !prefix.empty() && find_local(prefix); // which is called as a prefix is: told
    return is_of_local || (damage && (damage->in_head || damage->unread.contains(name))) || scope.is_unread(name);
}

void BodyChecker::report_unknown_name(Span span, const std::string& name)
{
    if (may_be_unread(name) || !unknown_names.insert(name).second || diagnostics.full())
        return diagnostics.count_consequence();
    const auto report = [&]() -> Diagnostic& {
        return diagnostics.error(span, "unknown-name", "unknown name " + quoted(name));
    };
    if (scope.by_prefix.contains(name)) {
        diagnostics.error(span, "not-a-value", quoted(name) + " is the prefix of an import, expected a value",
                          "write " + name + ". and a name of its file");
        return;
    }
    if (scope.is_constant_below(name)) {
        report().hint = "it is declared further down: a constant is known from its declaration on";
        return;
    }
    if (const ForeignWord* foreign = foreign_word(ForeignKind::name, name)) return propose(report(), span, *foreign);
    NearName near;
    if (context.near_searches > 0) {
        --context.near_searches;
        std::vector<std::string_view> names;
        for (const auto& [local, symbols] : by_name)
            if (!symbols.empty()) names.push_back(local);
        std::ranges::sort(names); // the hash's order must not decide between equals
        for (const auto& [prefix, behind] : scope.by_prefix) names.push_back(prefix);
        for (const Symbol* input : context.inputs) names.push_back(input->name);
        if (choices)
            for (const Name& choice : *choices->names) names.push_back(choice.text);
        const PrefixedName parts(name);
        if (!parts.prefix.empty()) names.clear();
        for (const Declarations* layer : scope.layers_of(parts.prefix))
            for (const auto& [constant, symbol] : layer->constants) names.push_back(constant);
        near = near_name(parts.name, names);
    }
    const std::string_view prefix = PrefixedName(name).prefix;
    const std::string behind_prefix = std::string(prefix) + "." + std::string(near.name);
    if (!near.name.empty() && !prefix.empty()) near.name = behind_prefix;
    // Most likely what declares it could not be read.
    if (in_damaged_body && near.name.empty()) return diagnostics.count_consequence();
    Diagnostic& reported = report();
    if (choices) reported.hint = "expected " + list_of(*choices->names);
    propose(reported, span, near);
    mark_read(near.name); // if it was meant, it is read
}

// ---- bodies

void BodyChecker::whole_body(StatementPtr& tree, const Name& name, Type result, const char* what,
                             const Damage& body_damage)
{
    result_type = result;
    owner_name = name.text;
    damage = &body_damage;
    in_damaged_body = body_damage.any;
    if (!tree) return;
    if (auto block = std::get_if<Scope>(&tree->node))
        statements(block->statements); // in the parameters' scope, as in C
    if (flow.reachable && result == void_type) return require_outputs(name.span);
    if (flow.reachable && !in_damaged_body && !result.is_error()) {
        diagnostics.error(name.span, "missing-return",
                          std::string(what) + " " + quoted(name.text) + " can end without returning a " +
                              to_string(result),
                          "end it with 'return ...;' outside of every if and for");
    }
}

void BodyChecker::check_function(Function& tree, FunctionInfo& info)
{
    open_scope();
    is_never_called = !info.is_mentioned && !info.is_in_circle && !context.is_library;
    uint32_t functions = 0;
    for (size_t i = 0; i < info.parameters.size(); ++i) {
        ParameterInfo& parameter = info.parameters[i];
        const Name& name = tree.parameters[i].name;
        if (name.text.empty()) {
            ++(parameter.is_function ? functions : slot_count); // keeps slots in a row
            continue;
        }
        Symbol& symbol =
            declare(name, parameter.is_function ? SymbolKind::function : SymbolKind::local, parameter.type);
        symbol.is_parameter = true;
        if (parameter.is_function) {
            symbol.slot = functions++;
            for (Type type : parameter.signature) symbol.parameters.push_back({type});
        } else {
            if (parameter.passing != Passing::out || info.is_texture) flow.variables[symbol.slot].assigned = all_parts;
            if (parameter.held) flow.variables[symbol.slot].hold(*parameter.held);
            if (parameter.range && !parameter.held && !info.is_in_circle && !context.is_library)
                flow.variables[symbol.slot].called = *parameter.range;
            if (parameter.is_written()) must_be_written.push_back(&symbol);
            symbol.is_read = parameter.is_written();
            if (parameter.type == image_type) symbol.read_only = "it is an image";
            if (parameter.choices) declare_choices(*parameter.choices->names);
        }
        parameter.symbol = &symbol;
    }
    whole_body(tree.body, tree.name, info.result, "function", tree.damage);
    close_scope();
    info.slot_count = slot_count;
    info.reads = reads;
    info.mentions = std::move(mentions);
}

std::vector<ConstantPart> BodyChecker::check_default(Expression& e, const ParameterInfo& parameter, Span where)
{
    open_scope();
    is_global = true;
    const uint32_t reports = diagnostics.reports();
    if (parameter.is_function || parameter.is_written() || parameter.type == image_type) {
        diagnostics.error(where, "default-argument", "expected a value that is only read before a default");
        return {};
    }
    if (expression(e).is_error()) return {};
    require(e, parameter.type, " for " + quoted(parameter.name));
    const Expression* varies = first_not_constant(e);
    if (varies && !varies->type.is_error())
        diagnostics.error(varies->span, "not-constant",
                          "a default is constant, expected a value known when the texture is compiled",
                          "literals, constants and built-in functions of them are");
    if (varies || diagnostics.reports() != reports || parameter.type.is_error()) return {};
    return context.constants.value(e, parameter.type);
}

Symbol& BodyChecker::check_global(Declaration& declaration)
{
    open_scope();
    is_global = declaration.is_const = true;
    check(declaration.name.span, declaration);
    Symbol& made = *declared.back();
    if (made.kind != SymbolKind::local) return made;
    made.kind = SymbolKind::constant; // no variable of any body
    made.type = Type::error();
    return made;
}

} // namespace haptel::lang
