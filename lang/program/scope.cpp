#include "lang/program/scope.h"

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

FunctionInfo* FileScope::texture(std::string_view name) const
{
    for (const Declarations* layer : layers)
        if (const auto found = layer->textures.find(name); found != layer->textures.end()) return found->second;
    return nullptr;
}

StructDeclaration* FileScope::structure(std::string_view name) const
{
    for (const Declarations* layer : layers)
        if (const auto found = layer->structs.find(name); found != layer->structs.end()) return found->second;
    return nullptr;
}

bool FileScope::is_unread(std::string_view name) const
{
    return std::ranges::any_of(layers, [&](const Declarations* layer) { return layer->unread.contains(name); });
}

std::vector<Candidate> FileScope::functions(std::string_view name) const
{
    std::vector<Candidate> found;
    size_t nearer = 0; // those of layers before
    const auto add = [&](const auto& function) {
        const bool replaced = std::any_of(found.begin(), found.begin() + nearer, [&](const Candidate& other) {
            return std::ranges::equal(other.parameters, function.parameters);
        });
        if (!replaced) found.emplace_back(function);
    };
    for (const Declarations* layer : layers) {
        nearer = found.size();
        if (auto here = layer->functions.find(name); here != layer->functions.end())
            for (const FunctionInfo* function : here->second) add(*function);
    }
    nearer = found.size();
    for (const BuiltinOverload& overload : builtin_overloads(name)) add(overload);
    return found;
}

} // namespace haptel::lang
