// One evaluation of a function, with results by their types.
#pragma once

#include "lang/ir/run/interpret.h"

#include <variant>

namespace haptel::ir {

template <typename T>
using Scalar = std::variant<T, uint32_t, bool>; // real; i32 and u32 as bits; boolean

template <typename T>
std::vector<Scalar<T>> interpret(const Module& module, uint32_t function, std::span<const Scalar<T>> arguments,
                                 const EntryInputs<T>* inputs)
{
    std::vector<Slot<T>> slots;
    for (const Scalar<T>& argument : arguments) {
        Slot<T>& slot = slots.emplace_back();
        if (auto* real = std::get_if<T>(&argument)) slot.real = *real;
        if (auto* word = std::get_if<uint32_t>(&argument)) slot.bits = *word;
        if (auto* truth = std::get_if<bool>(&argument)) slot.bits = *truth;
    }
    Interpreter<T> interpreter(module);
    const std::span<const Slot<T>> made = interpreter.run(function, slots, inputs);
    const Function& called = module.functions[function];
    std::vector<Scalar<T>> results;
    for (size_t i = 0; i < made.size(); ++i) {
        const Type type = called.type(called.body.yields[i]);
        if (type == Type::real)
            results.emplace_back(made[i].real);
        else if (type == Type::boolean)
            results.emplace_back(made[i].bits != 0);
        else
            results.emplace_back(made[i].bits);
    }
    return results;
}

} // namespace haptel::ir
