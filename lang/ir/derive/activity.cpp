#include "lang/ir/derive/activity.h"

#include "lang/ir/dataflow.h"
#include "lang/ir/derive/derivative_rules.h"

namespace haptel::ir {
namespace {

// Forwards: what is made of something active may be active itself.
struct Propagation {
    const Function& function;
    Dependences& callees;
    InputActivity input_is_active;
    Activity& activity;
    std::span<const uint32_t> of_texture;

    static constexpr uint32_t rounds_max = 8;

    bool flow(Value from, Value to)
    {
        bool is_new = false;
        for (size_t d = 0; is_real(from) && is_real(to) && d < activity.directions(); ++d)
            if (activity(from, d)) is_new |= activity.set(to, d);
        return is_new;
    }
    void steer(Value, Value) {}
    void assume(Value carried)
    {
        for (size_t d = 0; is_real(carried) && d < activity.directions(); ++d) activity.set(carried, d);
    }
    void visit(const Instruction& made)
    {
        if (const auto* operation = std::get_if<Operation>(&made.kind)) {
            if (has_derivative(operation->op))
                for (Value operand : made.operands) flow(operand, made.results[0]);
        } else if (const auto* read = std::get_if<ReadInput>(&made.kind)) {
            for (size_t d = 0; d < activity.directions(); ++d)
                if (input_is_active && input_is_active(read->input, d)) activity.set(made.results[0], d);
        } else if (const auto* parameter = std::get_if<ReadParameter>(&made.kind)) {
            for (size_t d = 0; d < of_texture.size(); ++d)
                if (of_texture[d] == parameter->parameter && is_real(made.results[0])) activity.set(made.results[0], d);
        } else if (const auto* call = std::get_if<Call>(&made.kind)) {
            const Dependence& depends = callees.of(call->function);
            for (size_t r = 0; r < made.results.size(); ++r)
                for (size_t p = 0; p < made.operands.size(); ++p)
                    if (depends[r][p]) flow(made.operands[p], made.results[r]);
        } else if (std::holds_alternative<PointDerivative>(made.kind)) {
            if (callees.point_derivatives == PointDerivatives::vary) flow(made.operands[0], made.results[0]);
        }
    }
    bool is_real(Value value) const { return function.type(value) == Type::real; }
};

} // namespace

bool Activity::any(Value value) const
{
    for (size_t d = 0; d < width; ++d)
        if ((*this)(value, d)) return true;
    return false;
}

bool Activity::set(Value value, size_t direction)
{
    auto bit = bits[value.index * width + direction];
    if (bit) return false;
    bit = true;
    return true;
}

void Activity::clear(Value value)
{
    for (size_t d = 0; d < width; ++d) bits[value.index * width + d] = false;
}

const Dependence& Dependences::of(uint32_t function)
{
    // In order of index, so that callees are known: no recursion.
    for (auto next = static_cast<uint32_t>(known.size()); next <= function; ++next) {
        const Function& source = module.functions[next];
        Activity activity(source.value_types.size(), source.parameters.size());
        for (size_t p = 0; p < source.parameters.size(); ++p)
            if (source.type(source.parameters[p]) == Type::real) activity.set(source.parameters[p], p);
        propagate(source, *this, nullptr, activity);
        Dependence depends;
        for (Value result : source.body.yields) {
            std::vector<bool>& row = depends.emplace_back();
            for (size_t p = 0; p < source.parameters.size(); ++p) row.push_back(activity(result, p));
        }
        known.push_back(std::move(depends));
    }
    return known[function];
}

void propagate(const Function& function, Dependences& callees, InputActivity input_is_active, Activity& activity,
               std::span<const uint32_t> of_texture)
{
    Propagation analysis{function, callees, input_is_active, activity, of_texture};
    Dataflow(analysis).forwards(function.body);
}

} // namespace haptel::ir
