// Body of the interpreter, for any real type: included by one source file per type (double, Quad) and by nobody else.
#pragma once

#include "lang/ir/run/decision.h"
#include "lang/ir/run/flat_code.h"
#include "lang/ir/run/interpret.h"

#include <algorithm>

namespace haptel::ir {

template <typename T>
Slot<T> slot_of(const Scalar<T>& scalar)
{
    Slot<T> slot;
    if (auto* real = std::get_if<T>(&scalar)) slot.real = *real;
    if (auto* word = std::get_if<uint32_t>(&scalar)) slot.bits = *word;
    if (auto* boolean = std::get_if<bool>(&scalar)) slot.bits = *boolean;
    return slot;
}

template <typename T>
struct Interpreter<T>::Machine {
    explicit Machine(const Module& whole) : module(whole), functions(flatten(whole)) {}

    struct Frame {
        const FlatFunction* function;
        uint32_t step;
        uint32_t base;
    };

    const Module& module;
    std::vector<FlatFunction> functions;
    std::vector<Slot<T>> slots;
    std::vector<Frame> frames; // callers of the running function
    std::vector<Slot<T>> results;
    bool watching = false;
    uint64_t digest = 0;

    Slot<T> table_cell(uint32_t table, Slot<T> index) const
    {
        const Table& cells = module.tables[table];
        auto last = static_cast<int64_t>(cells.size()) - 1;
        auto at = static_cast<size_t>(std::clamp<int64_t>(static_cast<int32_t>(index.bits), 0, last));
        Slot<T> cell;
        if (cells.element == Type::real)
            cell.real = T(cells.reals[at]);
        else
            cell.bits = cells.words[at];
        return cell;
    }

    void note(const FlatStep& step, const Slot<T>* frame)
    {
        uint64_t chosen = decision(step.op, frame[step.result], frame[step.operand[0]], frame[step.operand[1]]);
        digest = (digest ^ chosen) * 0x9E3779B97F4A7C15u;
        digest ^= digest >> 29;
    }

    std::span<const Slot<T>> run(uint32_t entry, std::span<const Slot<T>> arguments, const EntryInputs<T>* inputs)
    {
        const FlatFunction* function = &functions[entry];
        if (slots.size() < function->depth) slots.resize(function->depth);
        frames.clear();
        frames.reserve(function->calls);
        digest = 0;
        const std::vector<Value>& parameters = module.functions[entry].parameters;
        for (size_t i = 0; i < parameters.size(); ++i) slots[parameters[i].index] = arguments[i];

        uint32_t base = 0, next = 0;
        for (;;) {
            Slot<T>* frame = slots.data() + base;
            const FlatStep& step = function->steps[next++];
            const uint32_t* operand = step.operand;
            switch (step.kind) {
            case FlatStep::Kind::operation:
                execute(step.op, frame[step.result], frame[operand[0]], frame[operand[1]], frame[operand[2]],
                        frame[operand[3]]);
                if (watching) note(step, frame);
                break;
            case FlatStep::Kind::real_constant: frame[step.result].real = T(function->constants[operand[0]]); break;
            case FlatStep::Kind::word_constant: frame[step.result].bits = operand[0]; break;
            case FlatStep::Kind::input: frame[step.result].real = inputs->input[operand[0]]; break;
            case FlatStep::Kind::parameter: frame[step.result] = slot_of<T>(inputs->parameters[operand[0]]); break;
            case FlatStep::Kind::image:
                frame[step.result].image = operand[0] < inputs->images.size() ? inputs->images[operand[0]] : nullptr;
                break;
            case FlatStep::Kind::table: frame[step.result] = table_cell(operand[0], frame[operand[1]]); break;
            case FlatStep::Kind::copy: frame[step.result] = frame[operand[0]]; break;
            case FlatStep::Kind::jump: next = operand[1]; break;
            case FlatStep::Kind::jump_unless:
                if (!frame[operand[0]].bits) next = operand[1];
                break;
            case FlatStep::Kind::loop_test:
                if (!(static_cast<int32_t>(frame[operand[0]].bits) < static_cast<int32_t>(frame[operand[1]].bits)))
                    next = operand[2];
                break;
            case FlatStep::Kind::loop_next:
                frame[step.result].bits += 1;
                next = operand[1];
                break;
            case FlatStep::Kind::call: {
                const std::vector<Value>& formal = module.functions[operand[0]].parameters;
                const uint32_t* actual = function->lists.data() + operand[1];
                Slot<T>* callee_frame = frame + function->slots;
                for (size_t i = 0; i < formal.size(); ++i) callee_frame[formal[i].index] = frame[actual[i]];
                frames.push_back({function, next, base});
                base += function->slots;
                function = &functions[operand[0]];
                next = 0;
                break;
            }
            case FlatStep::Kind::finish: {
                const uint32_t* yields = function->lists.data() + operand[1];
                if (frames.empty()) {
                    results.resize(module.functions[entry].body.yields.size());
                    for (size_t i = 0; i < results.size(); ++i) results[i] = frame[yields[i]];
                    return results;
                }
                Frame caller = frames.back();
                frames.pop_back();
                const FlatStep& call = caller.function->steps[caller.step - 1];
                const Function& callee = module.functions[call.operand[0]];
                const uint32_t* targets = caller.function->lists.data() + call.operand[1] + callee.parameters.size();
                for (size_t i = 0; i < callee.body.yields.size(); ++i)
                    slots[caller.base + targets[i]] = frame[yields[i]];
                function = caller.function;
                next = caller.step;
                base = caller.base;
                break;
            }
            }
        }
    }
};

template <typename T>
Interpreter<T>::Interpreter(const Module& module) : machine(std::make_unique<Machine>(module))
{
}

template <typename T>
Interpreter<T>::~Interpreter() = default;

template <typename T>
std::span<const Slot<T>> Interpreter<T>::run(uint32_t function, std::span<const Slot<T>> arguments,
                                             const EntryInputs<T>* inputs)
{
    return machine->run(function, arguments, inputs);
}

template <typename T>
void Interpreter<T>::watch_decisions(bool on)
{
    machine->watching = on;
}

template <typename T>
uint64_t Interpreter<T>::decisions() const
{
    return machine->digest;
}

} // namespace haptel::ir
