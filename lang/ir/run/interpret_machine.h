// Body of the interpreter, for any real type: included by one source file per type (double, Quad) and by nobody else.
#pragma once

#include "lang/ir/op_info.h"
#include "lang/ir/run/interpret.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace haptel::ir {

// The discrete part of what an operation decides, as a number: equal for two inputs that lie on one smooth piece.
template <typename T>
uint64_t decision(Op op, const Slot<T>& result, const Slot<T>& a, const Slot<T>& b)
{
    using std::floor;
    auto cell = [](const T& whole) { return std::bit_cast<uint64_t>(static_cast<double>(whole)); };
    auto side = [](const T& left, const T& right) -> uint64_t { return left < right ? 1 : right < left ? 2 : 3; };
    switch (traits(op).decides) {
    case Decision::nothing: return 0;
    case Decision::order: return side(a.real, b.real);
    case Decision::side: return side(a.real, T(0));
    case Decision::whole: return cell(result.real);
    case Decision::cell: return cell(T(floor(a.real)));
    case Decision::cell_of_quotient: return cell(T(floor(T(a.real / b.real))));
    case Decision::tip: return side(result.real, T(0));
    case Decision::quadrant: return side(a.real, T(0)) * 4 + side(b.real, T(0));
    case Decision::truth: return result.bits;
    }
    return 0;
}

// One call of a function: its values, by Value::index. Those of what it calls lie behind them.
template <typename T>
struct Interpreter<T>::Frame {
    Interpreter& machine;
    const Function& function;
    Slot<T>* const slots;

    void run(const Block& block)
    {
        for (const Instruction& made : block.instructions)
            std::visit([&](const auto& kind) { run(made, kind); }, made.kind);
    }

private:
    Slot<T>& slot(Value value) { return slots[value.index]; }
    void copy(std::span<const Value> to, std::span<const Value> from)
    {
        for (size_t i = 0; i < to.size(); ++i) slot(to[i]) = slot(from[i]);
    }

    void run(const Instruction& made, const Operation& operation)
    {
        const Slot<T>* in[4] = {slots, slots, slots, slots}; // those that it does not take: any
        for (size_t i = 0; i < made.operands.size(); ++i) in[i] = &slot(made.operands[i]);
        Slot<T>& result = slot(made.results[0]);
        if (machine.rounded && machine.rounded->contains(&made)) {
            Slot<T> near[4] = {*in[0], *in[1], *in[2], *in[3]};
            for (Slot<T>& operand : near) operand.real = T(static_cast<double>(operand.real));
            execute(operation.op, result, near[0], near[1], near[2], near[3]);
            result.real = T(static_cast<double>(result.real));
        } else {
            execute(operation.op, result, *in[0], *in[1], *in[2], *in[3]);
        }
        if (!machine.watching) return;
        machine.digest = (machine.digest ^ decision(operation.op, result, *in[0], *in[1])) * 0x9E3779B97F4A7C15u;
        machine.digest ^= machine.digest >> 29;
    }
    void run(const Instruction& made, const RealConstant& constant) { slot(made.results[0]).real = T(constant.value); }
    void run(const Instruction& made, const WordConstant& constant) { slot(made.results[0]).bits = constant.bits; }
    void run(const Instruction& made, const ReadInput& read)
    {
        slot(made.results[0]).real = machine.entry_inputs->input[static_cast<size_t>(read.input)];
    }
    void run(const Instruction& made, const ReadParameter& read)
    {
        slot(made.results[0]) = machine.entry_inputs->parameters[read.parameter];
    }
    void run(const Instruction& made, const ReadTable& read)
    {
        const Table& cells = machine.module.tables[read.table];
        const auto index = static_cast<int32_t>(slot(made.operands[0]).bits);
        const auto at = static_cast<size_t>(std::clamp<int64_t>(index, 0, int64_t{cells.size()} - 1));
        if (cells.element == Type::real)
            slot(made.results[0]).real = T(cells.reals[at]);
        else
            slot(made.results[0]).bits = cells.words[at];
    }
    void run(const Instruction& made, const Call& call)
    {
        const Function& callee = machine.module.functions[call.function];
        Frame inner{machine, callee, slots + function.value_types.size()};
        for (size_t i = 0; i < made.operands.size(); ++i) inner.slot(callee.parameters[i]) = slot(made.operands[i]);
        inner.run(callee.body);
        for (size_t i = 0; i < made.results.size(); ++i) slot(made.results[i]) = inner.slot(callee.body.yields[i]);
    }
    void run(const Instruction& made, const PointDerivative&) // in no program that passes `verify`
    {
        slot(made.results[0]).real = T(std::numeric_limits<double>::quiet_NaN());
    }
    void run(const Instruction& made, const If& choice)
    {
        const Block& arm = choice.arms[slot(made.operands[0]).bits ? 0 : 1];
        run(arm);
        copy(made.results, arm.yields);
    }
    // The results hold the carried values between iterations: yields may name the body's parameters in any order.
    void run(const Instruction& made, const For& loop)
    {
        const Block& body = loop.body[0];
        const auto trips = static_cast<int32_t>(slot(made.operands[0]).bits);
        copy(made.results, std::span(made.operands).subspan(1));
        for (int32_t trip = 0; trip < trips; ++trip) {
            slot(body.parameters[0]).bits = static_cast<uint32_t>(trip);
            copy(std::span(body.parameters).subspan(1), made.results);
            run(body);
            copy(made.results, body.yields);
        }
    }
};

template <typename T>
Interpreter<T>::Interpreter(const Module& whole) : module(whole)
{
    for (const Function& function : module.functions) {
        size_t below = 0;
        for_each_instruction(function.body, [&](const Instruction& made) {
            if (auto* call = std::get_if<Call>(&made.kind)) below = std::max(below, depths[call->function]);
        });
        depths.push_back(function.value_types.size() + below);
    }
}

template <typename T>
std::span<const Slot<T>> Interpreter<T>::run(uint32_t entry, std::span<const Slot<T>> arguments,
                                             const EntryInputs<T>* inputs)
{
    const Function& function = module.functions[entry];
    if (slots.size() < depths[entry]) slots.resize(depths[entry]);
    entry_inputs = inputs;
    digest = 0;
    Frame frame{*this, function, slots.data()};
    for (size_t i = 0; i < function.parameters.size(); ++i) slots[function.parameters[i].index] = arguments[i];
    frame.run(function.body);
    results.clear();
    for (Value yield : function.body.yields) results.push_back(slots[yield.index]);
    return results;
}

} // namespace haptel::ir
