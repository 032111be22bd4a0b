#include "lang/check/call_order.h"

#include "lang/program/scope.h"
#include "lang/syntax/ast.h"

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>
#include <unordered_map>

namespace haptel::lang {

using namespace ast;

namespace {

struct Named {
    std::string_view name;
    size_t arguments; // of the call; SIZE_MAX: it is passed
    auto operator<=>(const Named&) const = default;
};

void add_names(const Expression& e, std::set<Named>& names)
{
    const auto add = [&](std::string_view written, size_t arguments) {
        names.insert({PrefixedName(written).name, arguments}); // wherever it comes from
    };
    if (auto name = std::get_if<NameExpression>(&e.node)) add(name->name, SIZE_MAX);
    if (auto call = std::get_if<CallExpression>(&e.node)) add(call->callee.text, call->arguments.size());
    if (auto grad = std::get_if<GradCall>(&e.node)) add(grad->function.text, grad->arguments.size());
    for (const Expression* operand : operands_of(e)) add_names(*operand, names);
}

std::set<Named> names_in(const FunctionInfo& function)
{
    std::set<Named> names;
    if (!function.tree || !function.tree->body) return names;
    std::set<std::string_view> own; // of variables: what is named like them is not passed
    for (const FunctionParameter& parameter : function.tree->parameters) own.insert(parameter.name.text);
    for_each_in(*function.tree->body, [&](const Statement& s) {
        if (auto declaration = std::get_if<Declaration>(&s.node)) own.insert(declaration->name.text);
        for (const Expression* e : expressions_of(s)) add_names(*e, names);
    });
    std::erase_if(names, [&](const Named& one) { return one.arguments == SIZE_MAX && own.contains(one.name); });
    return names;
}

bool may_be(const Named& named, const FunctionInfo& function)
{
    const size_t all = function.parameters.size();
    if (named.arguments == SIZE_MAX || function.is_texture || named.arguments == all) return true;
    return named.arguments < all && function.parameters[named.arguments].value;
}

} // namespace

std::vector<FunctionInfo*> callers_first(std::deque<FunctionInfo>& functions)
{
    std::unordered_map<std::string_view, std::vector<size_t>> called; // by name
    for (size_t i = 0; i < functions.size(); ++i) called[functions[i].name].push_back(i);
    std::vector<std::vector<size_t>> callees(functions.size());
    std::vector<size_t> callers(functions.size()); // that are not in order yet
    for (size_t i = 0; i < functions.size(); ++i)
        for (const Named& named : names_in(functions[i]))
            if (const auto found = called.find(named.name); found != called.end())
                for (const size_t callee : found->second) {
                    if (callee == i || !may_be(named, functions[callee])) continue;
                    callees[i].push_back(callee);
                    ++callers[callee];
                }
    std::vector<size_t> order;
    for (size_t i = 0; i < functions.size(); ++i)
        if (callers[i] == 0) order.push_back(i);
    for (size_t next = 0; next < order.size(); ++next)
        for (const size_t callee : callees[order[next]])
            if (--callers[callee] == 0) order.push_back(callee);
    for (size_t i = 0; i < functions.size(); ++i)
        if (callers[i] > 0) {
            functions[i].is_in_circle = true;
            order.push_back(i);
        }
    std::vector<FunctionInfo*> sorted;
    for (const size_t i : order) sorted.push_back(&functions[i]);
    return sorted;
}

std::vector<uint32_t> imported_first(const std::vector<CheckFile>& files)
{
    std::vector<uint32_t> order;
    std::vector<bool> is_begun(files.size());
    const std::function<void(uint32_t)> add = [&](uint32_t i) {
        if (is_begun[i]) return;
        is_begun[i] = true;
        for (const CheckFile::Imported& imported : files[i].imported) add(imported.file); // of at most 256 files
        order.push_back(i);
    };
    for (uint32_t i = 0; i < files.size(); ++i) add(i);
    return order;
}

} // namespace haptel::lang
