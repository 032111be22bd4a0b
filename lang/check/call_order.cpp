#include "lang/check/call_order.h"

#include "lang/syntax/ast.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <unordered_map>

namespace haptel::lang {

using namespace ast;

namespace {

using Names = std::set<std::string_view>;

void add_names(const Expression& e, Names& names)
{
    if (auto name = std::get_if<NameExpression>(&e.node)) names.insert(name->name);
    if (auto call = std::get_if<CallExpression>(&e.node)) names.insert(call->callee.text);
    if (auto grad = std::get_if<GradCall>(&e.node)) names.insert(grad->function.text);
    for (const Expression* operand : operands_of(e)) add_names(*operand, names);
}

Names names_in(const FunctionInfo& function)
{
    Names names;
    if (!function.tree || !function.tree->body) return names;
    for_each_in(*function.tree->body, [&](const Statement& s) {
        for (const Expression* e : expressions_of(s)) add_names(*e, names);
    });
    return names;
}

} // namespace

std::vector<FunctionInfo*> callers_first(std::deque<FunctionInfo>& functions)
{
    std::unordered_map<std::string_view, std::vector<size_t>> called; // by name
    for (size_t i = 0; i < functions.size(); ++i) called[functions[i].name].push_back(i);
    std::vector<std::vector<size_t>> callees(functions.size());
    std::vector<size_t> callers(functions.size()); // that are not in order yet
    for (size_t i = 0; i < functions.size(); ++i)
        for (const std::string_view name : names_in(functions[i]))
            if (const auto found = called.find(name); found != called.end())
                for (const size_t callee : found->second) {
                    if (callee == i) continue;
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
        if (callers[i] > 0) order.push_back(i);
    std::vector<FunctionInfo*> sorted;
    for (const size_t i : order) sorted.push_back(&functions[i]);
    return sorted;
}

} // namespace haptel::lang
