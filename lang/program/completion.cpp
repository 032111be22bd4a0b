#include "lang/program/completion.h"

#include <algorithm>
#include <iterator>

namespace haptel::lang {

using namespace ast;

Completion completion_of(const Statement& s)
{
    if (std::holds_alternative<Return>(s.node)) return {.returns = true};
    if (std::holds_alternative<Break>(s.node)) return {.breaks = true};
    if (std::holds_alternative<Continue>(s.node)) return {.continues = true};
    if (auto scope = std::get_if<Scope>(&s.node)) return completion_of(scope->statements);
    if (auto branch = std::get_if<If>(&s.node)) {
        Completion all{.falls_through = branch->arms.back().condition != nullptr}; // no else
        for (const If::Arm& arm : branch->arms) {
            const Completion one = arm.body ? completion_of(*arm.body) : Completion{.falls_through = true};
            all.falls_through |= one.falls_through;
            all.add(one);
        }
        return all;
    }
    if (auto choice = std::get_if<Switch>(&s.node)) { // of which a break leaves no more than itself
        Completion all{.falls_through = std::ranges::none_of(choice->cases, &Switch::Case::is_default)};
        for (const Switch::Case& one : choice->cases) {
            const Completion ends = completion_of(*one.body);
            all.falls_through |= ends.falls_through || ends.breaks;
            all.returns |= ends.returns;
            all.continues |= ends.continues;
        }
        return all;
    }
    if (auto loop = std::get_if<For>(&s.node))
        return {.falls_through = true, .returns = loop->body && completion_of(*loop->body).returns};
    return {.falls_through = true};
}

Completion completion_of(std::span<const StatementPtr> statements)
{
    Completion all{.falls_through = true};
    for (const StatementPtr& s : statements) {
        if (!s) continue; // an error
        const Completion one = completion_of(*s);
        all.falls_through = one.falls_through;
        all.add(one);
        if (!all.falls_through) break;
    }
    return all;
}

std::vector<uint32_t> changed_in(std::span<const Statement* const> statements)
{
    std::vector<uint32_t> assigned, declared;
    for (const Statement* s : statements)
        for_each_in(*s, [&](const Statement& inner) {
            for (const Symbol* written : inner.written) assigned.push_back(written->slot);
            if (auto assignment = std::get_if<Assignment>(&inner.node))
                assigned.push_back(root_of(*assignment->target)->symbol->slot);
            else if (auto declaration = std::get_if<Declaration>(&inner.node))
                if (declaration->symbol->kind == SymbolKind::local) declared.push_back(declaration->symbol->slot);
        });
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
