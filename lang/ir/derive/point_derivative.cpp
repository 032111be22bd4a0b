#include "lang/ir/derive/point_derivative.h"

#include "lang/ir/dataflow.h"
#include "lang/ir/derive/derivative_rules.h"

namespace haptel::ir {
namespace {

// Backwards, from what is asked for to what it is made of.
class Need {
public:
    Need(const Function& source, PointUses& of_callees, bool results)
        : is_needed(source.value_types.size()), function(source), callees(of_callees)
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
            const PointUse& use = callees.of(call->function);
            const Dependence& depends = callees.dependences.of(call->function);
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
    PointUses& callees;

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

const PointUse& PointUses::of(uint32_t function)
{
    // In order of index, so that callees are known: no recursion.
    for (auto next = static_cast<uint32_t>(uses.size()); next <= function; ++next) {
        const Function& source = module.functions[next];
        const Need need(source, *this, false);
        PointUse use{need.asks, {}};
        for (Value parameter : source.parameters) use.parameters.push_back(need.is_needed[parameter.index]);
        uses.push_back(std::move(use));
    }
    return uses[function];
}

std::vector<bool> PointUses::needed(const Function& function, bool tangents_of_results)
{
    return Need(function, *this, tangents_of_results).is_needed;
}

void remove_unresolved(Module& module)
{
    std::vector<uint32_t> moved; // by old index; UINT32_MAX: removed
    uint32_t kept = 0;
    for (Function& function : module.functions) {
        bool asks = false;
        for_each_instruction(function.body, [&](Instruction& made) {
            asks |= std::holds_alternative<PointDerivative>(made.kind);
            auto* call = std::get_if<Call>(&made.kind);
            if (!call) return;
            call->function = moved[call->function];
            asks |= call->function == UINT32_MAX;
        });
        moved.push_back(asks ? UINT32_MAX : kept);
        if (asks) continue;
        if (kept + 1 != moved.size()) module.functions[kept] = std::move(function);
        ++kept;
    }
    module.functions.resize(kept);
    for (Texture& texture : module.textures)
        for (uint32_t* entry : {&texture.body, &texture.height, &texture.height_gradient})
            if (*entry != UINT32_MAX) *entry = moved[*entry];
}

} // namespace haptel::ir
