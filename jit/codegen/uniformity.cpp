#include "jit/codegen/uniformity.h"

#include "lang/ir/dataflow.h"

namespace haptel::jit {

namespace {

// Nothing that varies is ever taken back.
class Variance {
public:
    explicit Variance(const ir::Function& of, const std::vector<bool>& parameters)
        : varies(of.value_types.size()), is_one(of.value_types.size()), function(of)
    {
        for (size_t i = 0; i < parameters.size(); ++i) varies[function.parameters[i].index] = parameters[i];
    }
    std::vector<bool> varies;
    std::vector<bool> is_one; // whatever it is made from

    static constexpr uint32_t rounds_max = UINT32_MAX;

    bool set(ir::Value value)
    {
        if (varies[value.index] || is_one[value.index]) return false;
        return varies[value.index] = true;
    }
    bool flow(ir::Value from, ir::Value to) { return varies[from.index] && set(to); }
    void steer(ir::Value condition, ir::Value result) { flow(condition, result); }
    void assume(ir::Value) {}
    void visit(const ir::Instruction& made)
    {
        for (ir::Value operand : made.operands)
            for (ir::Value result : made.results) flow(operand, result);
    }
    std::vector<bool> found()
    {
        ir::Dataflow(*this).forwards(function.body);
        return std::move(varies);
    }

private:
    const ir::Function& function;
};

} // namespace

std::vector<bool> varying_values(const ir::Function& function, const std::vector<bool>& parameters)
{
    Variance variance(function, parameters);
    ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
        const auto* read = std::get_if<ir::ReadInput>(&made.kind);
        if (read && read->input < ir::Input::center_x) variance.set(made.results[0]);
    });
    return variance.found();
}

// The results of a loop in lanes are one for all iterations, and so is what waits for them.
std::vector<bool> varying_iterations(const ir::Function& function, const std::vector<bool>& parameters,
                                     const LaneLoops& loops, bool ordered)
{
    Variance variance(function, parameters);
    ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
        const auto* loop = std::get_if<ir::For>(&made.kind);
        const auto found = loop ? loops.find(loop) : loops.end();
        if (found == loops.end() || found->second.is_ordered != ordered) return;
        const LaneLoop& in_lanes = found->second;
        for (size_t i = 0; i < in_lanes.waits.size(); ++i)
            if (in_lanes.waits[i]) variance.is_one[i] = true;
        for (ir::Value result : made.results) variance.is_one[result.index] = true;
        const std::vector<ir::Value>& values = loop->body[0].parameters;
        variance.set(values[0]);
        for (size_t i = 0; i < in_lanes.carried.size(); ++i) {
            if (in_lanes.carried[i].kind != Carried::Kind::kept) variance.set(values[i + 1]);
            variance.is_one[values[i + 1].index] = true; // as it is now
        }
    });
    return variance.found();
}

} // namespace haptel::jit
