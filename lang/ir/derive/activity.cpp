#include "lang/ir/derive/activity.h"

#include "lang/ir/derive/derivative_rules.h"

namespace haptel::ir {
namespace {

class Propagation {
public:
    Propagation(const Function& source, Dependences& dependences, InputActivity inputs, Activity& result)
        : function(source), callees(dependences), input_is_active(inputs), activity(result)
    {
    }

    // Loops hand activity back to their own start: walk until nothing is new. Long chains of carried values would take
    // a walk per link, so that after a few every carried real counts as active, which is safe.
    void run()
    {
        for (int walk = 0;; ++walk) {
            changed = false;
            everything_carried = walk >= 8;
            block(function.body);
            if (!changed) return;
        }
    }

private:
    const Function& function;
    Dependences& callees;
    InputActivity input_is_active;
    Activity& activity;
    bool changed = false, everything_carried = false;

    bool is_real(Value value) const { return function.type(value) == Type::real; }
    void flow(Value from, Value to)
    {
        if (is_real(from) && is_real(to)) changed |= activity.add(to, from);
    }

    void block(const Block& source)
    {
        for (const Instruction& made : source.instructions)
            std::visit([&](const auto& kind) { visit(made, kind); }, made.kind);
    }

    void visit(const Instruction& made, const Operation& operation)
    {
        if (!has_derivative(operation.op)) return;
        for (Value operand : made.operands) flow(operand, made.results[0]);
    }
    void visit(const Instruction&, const RealConstant&) {}
    void visit(const Instruction&, const IntConstant&) {}
    void visit(const Instruction&, const BoolConstant&) {}
    void visit(const Instruction&, const ReadParameter&) {}
    void visit(const Instruction&, const ReadTable&) {}
    void visit(const Instruction& made, const ReadInput& read)
    {
        for (size_t d = 0; d < activity.directions(); ++d)
            if (input_is_active && input_is_active(read.input, d)) changed |= activity.set(made.results[0], d);
    }
    void visit(const Instruction& made, const Call& call)
    {
        const Dependence& depends = callees.of(call.function);
        for (size_t r = 0; r < made.results.size(); ++r)
            for (size_t p = 0; p < made.operands.size(); ++p)
                if (depends[r][p]) flow(made.operands[p], made.results[r]);
    }
    void visit(const Instruction& made, const PointDerivative&)
    {
        if (callees.point_derivatives == PointDerivatives::vary) flow(made.operands[0], made.results[0]);
    }
    void visit(const Instruction& made, const If& choice)
    {
        for (const Block& arm : choice.arms) {
            block(arm);
            for (size_t i = 0; i < made.results.size(); ++i) flow(arm.yields[i], made.results[i]);
        }
    }
    void visit(const Instruction& made, const For& loop)
    {
        const Block& body = loop.body[0];
        for (size_t i = 0; i < made.results.size(); ++i) {
            flow(made.operands[i + 1], body.parameters[i + 1]);
            for (size_t d = 0; everything_carried && is_real(made.results[i]) && d < activity.directions(); ++d)
                changed |= activity.set(body.parameters[i + 1], d);
        }
        block(body);
        for (size_t i = 0; i < made.results.size(); ++i) {
            flow(body.yields[i], body.parameters[i + 1]);
            flow(body.parameters[i + 1], made.results[i]);
        }
    }
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

bool Activity::add(Value value, Value from)
{
    bool is_new = false;
    for (size_t d = 0; d < width; ++d)
        if ((*this)(from, d)) is_new |= set(value, d);
    return is_new;
}

void Activity::add(Value value, const Activity& other)
{
    for (size_t d = 0; d < width; ++d)
        if (other(value, d)) set(value, d);
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

void propagate(const Function& function, Dependences& callees, InputActivity input_is_active, Activity& activity)
{
    Propagation(function, callees, input_is_active, activity).run();
}

} // namespace haptel::ir
