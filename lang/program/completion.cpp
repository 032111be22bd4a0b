#include "lang/program/completion.h"

#include <algorithm>
#include <iterator>

namespace haptel::lang {

using namespace ast;

namespace {

const Symbol* assigned_symbol(const Assignment& assignment)
{
    const Expression* object = assignment.target.get();
    if (auto member = std::get_if<Member>(&object->node)) object = member->object.get();
    while (auto index = std::get_if<Index>(&object->node)) object = index->object.get();
    return std::get<NameExpression>(object->node).symbol;
}

void collect(const Statement& s, std::vector<uint32_t>& assigned, std::vector<uint32_t>& declared)
{
    const auto inner = [&](const StatementPtr& statement) {
        if (statement) collect(*statement, assigned, declared);
    };
    if (auto assignment = std::get_if<Assignment>(&s.node)) {
        assigned.push_back(assigned_symbol(*assignment)->slot);
    } else if (auto declaration = std::get_if<Declaration>(&s.node)) {
        if (declaration->symbol->kind == SymbolKind::local) declared.push_back(declaration->symbol->slot);
    } else if (auto scope = std::get_if<Scope>(&s.node)) {
        for (const StatementPtr& statement : scope->statements) inner(statement);
    } else if (auto branch = std::get_if<If>(&s.node)) {
        for (const If::Arm& arm : branch->arms) inner(arm.body);
    } else if (auto loop = std::get_if<For>(&s.node)) {
        inner(loop->init);
        inner(loop->body);
    }
}

} // namespace

Completion completion_of(const Statement& s)
{
    if (std::holds_alternative<Return>(s.node)) return {false, true, false};
    if (std::holds_alternative<Break>(s.node)) return {false, false, true};
    if (auto scope = std::get_if<Scope>(&s.node)) return completion_of(scope->statements);
    if (auto branch = std::get_if<If>(&s.node)) {
        Completion all{branch->arms.back().condition != nullptr, false, false}; // no else
        for (const If::Arm& arm : branch->arms) {
            const Completion one = arm.body ? completion_of(*arm.body) : Completion{true, false, false};
            all.falls_through |= one.falls_through;
            all.returns |= one.returns;
            all.breaks |= one.breaks;
        }
        return all;
    }
    if (auto loop = std::get_if<For>(&s.node)) return {true, loop->body && completion_of(*loop->body).returns, false};
    return {true, false, false};
}

Completion completion_of(std::span<const StatementPtr> statements)
{
    Completion all{true, false, false};
    for (const StatementPtr& s : statements) {
        if (!s) continue; // an error
        const Completion one = completion_of(*s);
        all.falls_through = one.falls_through;
        all.returns |= one.returns;
        all.breaks |= one.breaks;
        if (!all.falls_through) break;
    }
    return all;
}

std::vector<uint32_t> changed_in(std::span<const Statement* const> statements)
{
    std::vector<uint32_t> assigned, declared;
    for (const Statement* s : statements) collect(*s, assigned, declared);
    for (std::vector<uint32_t>* slots : {&assigned, &declared}) {
        std::sort(slots->begin(), slots->end());
        slots->erase(std::unique(slots->begin(), slots->end()), slots->end());
    }
    std::vector<uint32_t> changed;
    std::set_difference(assigned.begin(), assigned.end(), declared.begin(), declared.end(),
                        std::back_inserter(changed));
    return changed;
}

} // namespace haptel::lang
