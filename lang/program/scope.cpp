#include "lang/program/scope.h"

#include <algorithm>

namespace haptel::lang {
namespace {

std::string with_parameters(std::string head, std::span<const ParameterInfo> parameters, std::string_view separator,
                            bool names)
{
    std::string text = std::move(head) + '(';
    for (size_t i = 0; i < parameters.size(); ++i) {
        const ParameterInfo& parameter = parameters[i];
        if (i > 0) text += separator;
        text += to_string(parameter.type);
        if (names && !parameter.name.empty()) text += ' ' + parameter.name;
        if (!parameter.is_function) continue;
        text += '(';
        for (size_t j = 0; j < parameter.signature.size(); ++j)
            (text += j > 0 ? separator : "") += to_string(parameter.signature[j]);
        text += ')';
    }
    return text + ')';
}

} // namespace

std::string name_of(const FunctionReference& function)
{
    if (auto source = std::get_if<const FunctionInfo*>(&function)) return (*source)->name;
    if (auto builtin = std::get_if<const BuiltinOverload*>(&function)) return std::string((*builtin)->builtin->name);
    if (auto parameter = std::get_if<const Symbol*>(&function)) return (*parameter)->name;
    return {};
}

Candidate candidate_of(const FunctionInfo& function)
{
    return {&function, function.result, function.parameters};
}

Candidate candidate_of(const BuiltinOverload& overload)
{
    return {&overload, overload.result, overload.parameters};
}

Candidate candidate_of(const Symbol& function_parameter)
{
    return {&function_parameter, function_parameter.type, function_parameter.parameters};
}

std::string to_string(const Candidate& candidate)
{
    return with_parameters(to_string(candidate.result) + ' ' + name_of(candidate.function), candidate.parameters, ", ",
                           true);
}

std::string signature_of(const FunctionInfo& function)
{
    return with_parameters(function.name, function.parameters, ",", false);
}

const Symbol* FileScope::constant(std::string_view name) const
{
    for (const Declarations* layer : layers)
        if (auto found = layer->constants.find(name); found != layer->constants.end()) return found->second;
    return nullptr;
}

bool FileScope::declares_constant_later(std::string_view name) const
{
    return std::any_of(layers.begin(), layers.end(), [&](auto* layer) { return layer->constant_names.contains(name); });
}

bool FileScope::is_function(std::string_view name) const
{
    const auto declared = [&](const Declarations* layer) { return layer->functions.contains(name); };
    return std::any_of(layers.begin(), layers.end(), declared) || !builtin_overloads(name).empty();
}

std::vector<Candidate> FileScope::functions(std::string_view name) const
{
    std::vector<Candidate> found;
    const auto add = [&](Candidate candidate, uint32_t layer) {
        const bool replaced = std::any_of(found.begin(), found.end(), [&](const Candidate& other) {
            return other.layer < layer && std::ranges::equal(other.parameters, candidate.parameters);
        });
        candidate.layer = layer;
        if (!replaced) found.push_back(std::move(candidate));
    };
    uint32_t layer = 0;
    for (const Declarations* declarations : layers) {
        if (auto here = declarations->functions.find(name); here != declarations->functions.end())
            for (const FunctionInfo* function : here->second) add(candidate_of(*function), layer);
        ++layer;
    }
    for (const BuiltinOverload& overload : builtin_overloads(name)) add(candidate_of(overload), layer);
    return found;
}

bool FileScope::lacks_functions() const
{
    return std::any_of(layers.begin(), layers.end(), [](const Declarations* layer) { return layer->lacks_functions; });
}

bool FileScope::may_be_unread(std::string_view name) const
{
    return std::any_of(layers.begin(), layers.end(), [&](auto* layer) { return layer->unread.contains(name); });
}

void FileScope::collect_function_names(std::vector<std::string_view>& names) const
{
    for (const Declarations* layer : layers)
        for (const auto& [name, functions] : layer->functions) names.push_back(name);
    names.insert(names.end(), builtin_names().begin(), builtin_names().end());
}

void FileScope::collect_constant_names(std::vector<std::string_view>& names) const
{
    for (const Declarations* layer : layers)
        for (const auto& [name, symbol] : layer->constants) names.push_back(name);
}

} // namespace haptel::lang
