// A module as straight lists of steps with jumps: what the interpreter runs, so that it needs no recursion over blocks
// or calls and no allocation per step.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <vector>

namespace haptel::ir {

struct FlatStep {
    enum class Kind : uint8_t {
        operation,     // result = op(operands)
        real_constant, // result = constants[operand 0]
        word_constant, // result = bits in operand 0
        input,         // result = input number operand 0
        parameter,     // result = texture parameter number operand 0
        image,         // result = image of texture parameter number operand 0
        table,         // result = table operand 0 at index operand 1, forced into its range
        call,          // function operand 0; its arguments, then where its results go: lists[operand 1 ...]
        copy,          // result = operand 0
        jump,          // to operand 1
        jump_unless,   // to operand 1 if operand 0 is false
        loop_test,     // to operand 2 unless operand 0 < operand 1
        loop_next,     // result += 1, then to operand 1
        finish         // results of the function: lists[operand 1 ...]
    };
    Kind kind;
    Op op;
    uint32_t result;
    uint32_t operand[4];
};

struct FlatFunction {
    std::vector<FlatStep> steps;
    std::vector<double> constants;
    std::vector<uint32_t> lists;
    uint32_t slots = 0; // of its own frame
    uint32_t depth = 0; // slots of its frame and of the deepest chain of calls below it
    uint32_t calls = 0; // length of the longest chain of calls below it
};

std::vector<FlatFunction> flatten(const Module& module);

} // namespace haptel::ir
