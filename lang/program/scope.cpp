#include "lang/program/scope.h"

#include "lang/syntax/ast.h"

#include <algorithm>

namespace haptel::lang {

std::string to_string(const ParameterInfo& parameter, const std::string& name, std::string_view separator)
{
    std::string text = parameter.passing == Passing::out ? "out " : parameter.passing == Passing::inout ? "inout " : "";
    text += to_string(parameter.type) + (name.empty() ? "" : ' ' + name);
    if (!parameter.is_function) return text;
    text += '(';
    for (size_t i = 0; i < parameter.signature.size(); ++i)
        (text += i > 0 ? separator : "") += to_string(parameter.signature[i]);
    return text + ')';
}

std::string name_of(const FunctionReference& function)
{
    if (auto source = std::get_if<const FunctionInfo*>(&function)) return (*source)->name;
    if (auto builtin = std::get_if<const BuiltinOverload*>(&function)) return std::string((*builtin)->builtin->name);
    if (auto parameter = std::get_if<const Symbol*>(&function)) return (*parameter)->name;
    if (auto bound = std::get_if<const ast::CallExpression*>(&function)) return (*bound)->callee.text;
    return {};
}

std::string to_string(const Candidate& candidate)
{
    std::string text = to_string(candidate.result) + ' ' + name_of(candidate.function) + '(';
    for (const ParameterInfo& parameter : candidate.parameters)
        (text += text.ends_with('(') ? "" : ", ") += to_string(parameter, parameter.name);
    return text + ')';
}

std::string signature_of(const FunctionInfo& function)
{
    std::string text = function.name + '(';
    for (const ParameterInfo& parameter : function.parameters)
        (text += text.ends_with('(') ? "" : ",") += to_string(parameter, {}, ",");
    return text + ')';
}

PrefixedName::PrefixedName(std::string_view written) : name(written)
{
    const size_t dot = written.find('.');
    if (dot == written.npos) return;
    prefix = written.substr(0, dot);
    name = written.substr(dot + 1);
}

std::span<const Declarations* const> FileScope::layers_of(std::string_view prefix) const
{
    if (prefix.empty()) return layers;
    const auto found = by_prefix.find(prefix);
    if (found == by_prefix.end() || !found->second) return {};
    return {&found->second, 1};
}

FunctionInfo* FileScope::texture(std::string_view written) const
{
    const PrefixedName parts(written);
    for (const Declarations* layer : layers_of(parts.prefix))
        if (const auto found = layer->textures.find(parts.name); found != layer->textures.end()) return found->second;
    return nullptr;
}

StructDeclaration* FileScope::structure(std::string_view written) const
{
    const PrefixedName parts(written);
    for (const Declarations* layer : layers_of(parts.prefix))
        if (const auto found = layer->structs.find(parts.name); found != layer->structs.end()) return found->second;
    return nullptr;
}

const Symbol* FileScope::constant(std::string_view written) const
{
    const PrefixedName parts(written);
    for (const Declarations* layer : layers_of(parts.prefix))
        if (const auto found = layer->constants.find(parts.name); found != layer->constants.end()) return found->second;
    return nullptr;
}

bool FileScope::is_unread(std::string_view written) const
{
    const PrefixedName parts(written);
    const auto prefix = by_prefix.find(parts.prefix);
    if (prefix != by_prefix.end() && !prefix->second) return true;
    return std::ranges::any_of(layers_of(parts.prefix),
                               [&](const Declarations* layer) { return layer->unread.contains(parts.name); });
}

bool FileScope::may_be_function(std::string_view written) const
{
    return std::ranges::any_of(layers_of(PrefixedName(written).prefix), &Declarations::lacks_functions);
}

bool FileScope::is_constant_below(std::string_view written) const
{
    const PrefixedName parts(written);
    return std::ranges::any_of(layers_of(parts.prefix),
                               [&](const Declarations* layer) { return layer->constant_names.contains(parts.name); });
}

std::vector<Candidate> FileScope::functions(std::string_view written) const
{
    const auto [prefix, name] = PrefixedName(written);
    std::vector<Candidate> found;
    size_t nearer = 0; // those of layers before
    const auto add = [&](const auto& function) {
        const bool replaced = std::any_of(found.begin(), found.begin() + nearer, [&](const Candidate& other) {
            return std::ranges::equal(other.parameters, function.parameters);
        });
        if (!replaced) found.emplace_back(function);
    };
    for (const Declarations* layer : layers_of(prefix)) {
        nearer = found.size();
        if (auto here = layer->functions.find(name); here != layer->functions.end())
            for (const FunctionInfo* function : here->second) add(*function);
    }
    nearer = found.size();
    if (prefix.empty())
        for (const BuiltinOverload& overload : builtin_overloads(name)) add(overload);
    return found;
}

} // namespace haptel::lang
