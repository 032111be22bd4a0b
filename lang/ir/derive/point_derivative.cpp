#include "lang/ir/derive/point_derivative.h"

#include <algorithm>
#include <functional>

namespace haptel::ir {
namespace {

// Walks a function backwards, from what is asked for to what it is made of.
class Need {
public:
    using UseOf = std::function<const PointUse&(uint32_t)>;

    Need(const Function& source, Dependences& dependences, UseOf use_of_callee)
        : function(source), callees(dependences), use_of(std::move(use_of_callee)), is_needed(source.value_types.size())
    {
    }

    bool asks = false;

    std::vector<bool> run(bool results)
    {
        if (results) need(function.body.yields);
        // Loops hand needs on to their own end: walk until nothing is new, and after a few walks need all they carry.
        for (int walk = 0;; ++walk) {
            changed = false;
            everything_carried = walk >= 8;
            block(function.body);
            if (!changed) return std::move(is_needed);
        }
    }

private:
    const Function& function;
    Dependences& callees;
    const UseOf use_of;
    std::vector<bool> is_needed; // by Value::index
    bool changed = false, everything_carried = false;

    void need(Value value)
    {
        if (is_needed[value.index] || function.type(value) != Type::real) return;
        is_needed[value.index] = changed = true;
    }
    void need(const std::vector<Value>& values)
    {
        for (Value value : values) need(value);
    }

    void block(const Block& source)
    {
        for (auto made = source.instructions.rbegin(); made != source.instructions.rend(); ++made)
            std::visit([&](const auto& kind) { visit(*made, kind); }, made->kind);
    }

    void visit(const Instruction& made, const Operation& operation)
    {
        if (is_needed[made.results[0].index] && has_derivative(operation.op)) need(made.operands);
    }
    void visit(const Instruction&, const RealConstant&) {}
    void visit(const Instruction&, const IntConstant&) {}
    void visit(const Instruction&, const BoolConstant&) {}
    void visit(const Instruction&, const ReadInput&) {}
    void visit(const Instruction&, const ReadParameter&) {}
    void visit(const Instruction&, const ReadTable&) {}
    void visit(const Instruction& made, const Call& call)
    {
        const PointUse& use = use_of(call.function);
        const Dependence& depends = callees.of(call.function);
        asks |= use.asks;
        for (size_t p = 0; p < made.operands.size(); ++p) {
            bool is_wanted = use.parameters[p];
            for (size_t r = 0; r < made.results.size(); ++r)
                is_wanted |= depends[r][p] && is_needed[made.results[r].index];
            if (is_wanted) need(made.operands[p]);
        }
    }
    void visit(const Instruction& made, const PointDerivative&)
    {
        asks = true;
        need(made.operands);
    }
    void visit(const Instruction& made, const If& choice)
    {
        for (const Block& arm : choice.arms) {
            for (size_t i = 0; i < made.results.size(); ++i)
                if (is_needed[made.results[i].index]) need(arm.yields[i]);
            block(arm);
        }
    }
    void visit(const Instruction& made, const For& loop)
    {
        const Block& body = loop.body[0];
        for (size_t i = 0; i < made.results.size(); ++i) {
            const Value carried = body.parameters[i + 1];
            if (!is_needed[made.results[i].index] && !is_needed[carried.index] && !everything_carried) continue;
            need(carried);
            need(body.yields[i]);
            need(made.operands[i + 1]);
        }
        block(body);
    }
};

} // namespace

PointDerivativeResolver::PointDerivativeResolver(Module& whole, Differentiator& owner)
    : module(whole), differentiator(owner), dependences(whole, PointDerivatives::constant)
{
}

const PointUse& PointDerivativeResolver::use_of(uint32_t function)
{
    // In order of index, so that callees are known: no recursion.
    for (auto next = static_cast<uint32_t>(uses.size()); next <= function; ++next) {
        const Function& source = module.functions[next];
        Need need(source, dependences, [this](uint32_t callee) -> const PointUse& { return uses[callee]; });
        const std::vector<bool> values = need.run(false);
        PointUse use;
        use.asks = need.asks;
        for (Value parameter : source.parameters) use.parameters.push_back(values[parameter.index]);
        uses.push_back(std::move(use));
    }
    return uses[function];
}

std::vector<bool> PointDerivativeResolver::needed(const Function& function, bool tangents_of_results)
{
    Need need(function, dependences, [this](uint32_t callee) -> const PointUse& { return use_of(callee); });
    return need.run(tangents_of_results);
}

uint32_t PointDerivativeResolver::resolved_entry(uint32_t entry)
{
    return use_of(entry).asks ? resolved(entry, {}, false).function : entry;
}

Derivative PointDerivativeResolver::resolved(uint32_t function, const Seeds& seeds, bool tangents_of_results)
{
    const Key key{function, seeds, tangents_of_results};
    if (auto known = memo.find(key); known != memo.end()) return known->second;

    const Function source = module.functions[function]; // a copy: the module grows meanwhile
    Activity reached(source.value_types.size(), axes), activity = reached;
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < axes; ++d)
            if (seeds[p][d] == Seed::given) reached.set(source.parameters[p], d);
    propagate(source, dependences, input_is_active, reached);
    const std::vector<bool> is_needed = needed(source, tangents_of_results);
    for (uint32_t value = 0; value < is_needed.size(); ++value)
        if (is_needed[value]) activity.add({value}, reached);

    DerivativeEmitter emitter(source, activity, *this);
    emitter.prepare(source.body);
    Builder builder(module, std::string(tangents_of_results ? "d " : "") + "resolved " + source.name +
                                (seeds.empty() ? "" : " [" + pattern_of(seeds) + "]"));
    builder.function().first_argument_size = source.first_argument_size;
    builder.function().is_library = source.is_library;
    builder.function().facts = source.facts; // its first result is the original's
    for (Value parameter : source.parameters) emitter.set_primal(parameter, builder.parameter(source.type(parameter)));
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < axes; ++d)
            if (seeds[p][d] == Seed::given)
                emitter.set_tangent(builder, source.parameters[p], d, builder.parameter(Type::real));
    emitter.emit(builder, source.body);

    Derivative made;
    std::vector<Value> results;
    for (Value result : source.body.yields) results.push_back(emitter.primal(result));
    for (Value result : source.body.yields) {
        std::vector<bool>& row = made.exists.emplace_back(axes, false);
        for (size_t d = 0; tangents_of_results && d < axes; ++d) {
            const Tangent& tangent = emitter.tangent(result, d);
            row[d] = tangent.has_value();
            if (tangent) results.push_back(*tangent);
        }
    }
    made.function = builder.finish(results);
    return memo.emplace(key, made).first->second;
}

CallPlan PointDerivativeResolver::plan(const Instruction& call, const Activity& activity)
{
    const uint32_t callee = std::get<Call>(call.kind).function;
    const PointUse& use = use_of(callee);
    const Dependence& depends = dependences.of(callee);
    if (!use.asks) return plan_call(call, depends, activity, false);
    CallPlan plan;
    plan.how = CallPlan::How::tangents;
    auto is_active = [&](Value result) { return activity.any(result); };
    plan.tangents_of_results = std::any_of(call.results.begin(), call.results.end(), is_active);
    plan.seeds.assign(call.operands.size(), std::vector<Seed>(axes, Seed::none));
    for (size_t p = 0; p < call.operands.size(); ++p) {
        bool is_needed = use.parameters[p];
        for (size_t r = 0; plan.tangents_of_results && r < call.results.size(); ++r) is_needed |= depends[r][p];
        for (size_t d = 0; is_needed && d < axes; ++d)
            if (activity(call.operands[p], d)) plan.seeds[p][d] = Seed::given;
    }
    return plan;
}

Derivative PointDerivativeResolver::derivative(uint32_t callee, const CallPlan& plan)
{
    if (!use_of(callee).asks) return differentiator.derivative(callee, plan.seeds);
    return resolved(callee, plan.seeds, plan.tangents_of_results);
}

void remove_unresolved(Module& module)
{
    std::vector<uint32_t> moved; // by old index; UINT32_MAX: removed
    auto asks = [&](auto&& self, Block& block) -> bool {
        for (Instruction& made : block.instructions) {
            if (std::holds_alternative<PointDerivative>(made.kind)) return true;
            if (auto* call = std::get_if<Call>(&made.kind)) {
                call->function = moved[call->function];
                if (call->function == UINT32_MAX) return true;
            }
            if (auto* choice = std::get_if<If>(&made.kind))
                for (Block& arm : choice->arms)
                    if (self(self, arm)) return true;
            if (auto* loop = std::get_if<For>(&made.kind); loop && self(self, loop->body[0])) return true;
        }
        return false;
    };
    uint32_t kept = 0;
    for (Function& function : module.functions) {
        moved.push_back(asks(asks, function.body) ? UINT32_MAX : kept);
        if (moved.back() == UINT32_MAX) continue;
        if (kept + 1 != moved.size()) module.functions[kept] = std::move(function);
        ++kept;
    }
    module.functions.resize(kept);
    for (Texture& texture : module.textures)
        for (uint32_t* entry : {&texture.body, &texture.height, &texture.height_gradient})
            if (*entry != UINT32_MAX) *entry = moved[*entry];
}

} // namespace haptel::ir
