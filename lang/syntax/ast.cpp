#include "lang/syntax/ast.h"

namespace haptel::lang::ast {

std::vector<const Expression*> operands_of(const Expression& e)
{
    std::vector<const Expression*> operands;
    const auto add = [&](const auto&... operand) { (operands.push_back(operand.get()), ...); };
    const auto add_all = [&](const std::vector<ExpressionPtr>& list) {
        for (const ExpressionPtr& operand : list) add(operand);
    };
    if (auto unary = std::get_if<Unary>(&e.node)) add(unary->operand);
    if (auto member = std::get_if<Member>(&e.node)) add(member->object);
    if (auto call = std::get_if<CallExpression>(&e.node)) {
        add_all(call->arguments);
        for (const auto& [name, value] : call->inputs) add(value);
    }
    if (auto grad = std::get_if<GradCall>(&e.node)) add_all(grad->arguments);
    if (auto list = std::get_if<BraceList>(&e.node)) add_all(list->elements);
    if (auto index = std::get_if<Index>(&e.node)) add(index->object, index->index);
    if (auto choice = std::get_if<Conditional>(&e.node)) add(choice->condition, choice->when_true, choice->when_false);
    if (auto chain = std::get_if<Chain>(&e.node)) {
        add(chain->first);
        for (const Chain::Link& link : chain->rest) add(link.operand);
    }
    return operands;
}

void for_each_in(const Statement& s, const std::function<void(const Statement&)>& look)
{
    look(s);
    const auto inner = [&](const StatementPtr& statement) {
        if (statement) for_each_in(*statement, look);
    };
    if (auto scope = std::get_if<Scope>(&s.node))
        for (const StatementPtr& statement : scope->statements) inner(statement);
    if (auto branch = std::get_if<If>(&s.node))
        for (const If::Arm& arm : branch->arms) inner(arm.body);
    if (auto loop = std::get_if<For>(&s.node))
        for (const StatementPtr* part : {&loop->init, &loop->step, &loop->body}) inner(*part);
    if (auto choice = std::get_if<Switch>(&s.node))
        for (const Switch::Case& one : choice->cases) inner(one.body);
}

std::vector<const Expression*> expressions_of(const Statement& s)
{
    std::vector<const Expression*> expressions;
    const auto add = [&](const ExpressionPtr& e) {
        if (e) expressions.push_back(e.get());
    };
    if (auto declaration = std::get_if<Declaration>(&s.node)) add(declaration->initializer);
    if (auto assignment = std::get_if<Assignment>(&s.node)) add(assignment->target), add(assignment->value);
    if (auto evaluated = std::get_if<ExpressionStatement>(&s.node)) add(evaluated->expression);
    if (auto loop = std::get_if<For>(&s.node)) add(loop->condition);
    if (auto left = std::get_if<Return>(&s.node)) add(left->value);
    if (auto branch = std::get_if<If>(&s.node))
        for (const If::Arm& arm : branch->arms) add(arm.condition);
    if (auto choice = std::get_if<Switch>(&s.node)) {
        add(choice->selector);
        for (const Switch::Case& one : choice->cases)
            for (const ExpressionPtr& label : one.labels) add(label);
    }
    return expressions;
}

Function head_as_function(const Texture& texture)
{
    Function made;
    made.doc = texture.doc;
    made.result.base = {"float", texture.name.span};
    made.name = texture.name;
    made.span = texture.span;
    for (const TextureParameter& parameter : texture.parameters) {
        FunctionParameter& one = made.parameters.emplace_back();
        one.type = parameter.type;
        one.name = parameter.name;
        one.passing = parameter.is_output ? Passing::out : Passing::in;
        one.span = parameter.span;
    }
    return made;
}

const Expression* whole_of(const Expression& part)
{
    if (auto member = std::get_if<Member>(&part.node)) return member->object.get();
    if (auto index = std::get_if<Index>(&part.node)) return index->object.get();
    return nullptr;
}

const NameExpression* root_of(const Expression& target)
{
    const Expression* object = &target;
    while (const Expression* whole = whole_of(*object)) object = whole;
    return std::get_if<NameExpression>(&object->node);
}

} // namespace haptel::lang::ast
