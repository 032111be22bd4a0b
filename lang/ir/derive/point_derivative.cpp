#include "lang/ir/derive/point_derivative.h"

#include "lang/ir/dataflow.h"

#include <algorithm>
#include <functional>

namespace haptel::ir {
namespace {

// Backwards, from what is asked for to what it is made of.
class Need {
public:
    using UseOf = std::function<const PointUse&(uint32_t)>;

    Need(const Function& source, Dependences& dependences, UseOf use_of_callee, bool results)
        : is_needed(source.value_types.size()), function(source), callees(dependences), use_of(std::move(use_of_callee))
    {
        if (results) need(function.body.yields);
        Dataflow(*this).backwards(function.body);
    }

    bool asks = false;
    std::vector<bool> is_needed; // by Value::index

    static constexpr uint32_t rounds_max = 8;

    bool flow(Value from, Value to) { return is_needed[from.index] && need(to); }
    void steer(Value, Value) {}
    void assume(Value carried) { need(carried); }
    void visit(const Instruction& made)
    {
        if (const auto* operation = std::get_if<Operation>(&made.kind)) {
            if (is_needed[made.results[0].index] && has_derivative(operation->op)) need(made.operands);
        } else if (const auto* call = std::get_if<Call>(&made.kind)) {
            const PointUse& use = use_of(call->function);
            const Dependence& depends = callees.of(call->function);
            asks |= use.asks;
            for (size_t p = 0; p < made.operands.size(); ++p) {
                if (use.parameters[p]) need(made.operands[p]);
                for (size_t r = 0; r < made.results.size(); ++r)
                    if (depends[r][p]) flow(made.results[r], made.operands[p]);
            }
        } else if (std::holds_alternative<PointDerivative>(made.kind)) {
            asks = true;
            need(made.operands);
        }
    }

private:
    const Function& function;
    Dependences& callees;
    const UseOf use_of;

    bool need(Value value)
    {
        if (is_needed[value.index] || function.type(value) != Type::real) return false;
        return is_needed[value.index] = true;
    }
    void need(const std::vector<Value>& values)
    {
        for (Value value : values) need(value);
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
        const Need need(
            source, dependences, [this](uint32_t callee) -> const PointUse& { return uses[callee]; }, false);
        PointUse use;
        use.asks = need.asks;
        for (Value parameter : source.parameters) use.parameters.push_back(need.is_needed[parameter.index]);
        uses.push_back(std::move(use));
    }
    return uses[function];
}

std::vector<bool> PointDerivativeResolver::needed(const Function& function, bool tangents_of_results)
{
    const auto use = [this](uint32_t callee) -> const PointUse& { return use_of(callee); };
    return Need(function, dependences, use, tangents_of_results).is_needed;
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
    emitter.begin(builder, seeds);
    emitter.emit(builder, source.body);

    Derivative made;
    made.function = builder.finish(emitter.results(tangents_of_results, made.exists));
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
            for (Block& inner : blocks_of(made))
                if (self(self, inner)) return true;
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
