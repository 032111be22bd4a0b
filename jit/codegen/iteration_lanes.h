// Loops whose iterations can run side by side, in the lanes of a register: the octaves of a fractal, the terms of a
// Fourier series.
//
// Best are carried values that no iteration has to wait for: a sum, to which each iteration adds something of its own;
// a factor or a step that is the same each time, so that the value is known from the iteration's number; or a value
// that stays. A sum of a sum's derivative is a sum again, and what is the same for all points has no derivative: a
// derivative hardly ever keeps a loop from being so. The height alone is judged with its gradient
// (jit/codegen/codegen.h).
//
// Where others are carried (a product, a maximum, the weights of a hybrid fractal), the loop is split: what does not
// wait for them runs side by side, then they follow one iteration after the other, in the order of a loop that is not
// split.
#pragma once

#include "lang/ir/ir.h"

#include <map>
#include <vector>

namespace haptel::jit {

// How a carried value is had.
struct Carried {
    enum class Kind : uint8_t {
        sum,      // initial + what each iteration adds
        factor,   // initial * by^i
        step,     // initial + i by
        back,     // initial - i by
        replaced, // initial, then `by`
        kept,     // initial
        serial,   // only as the iterations before have left it
    };
    Kind kind = Kind::kept;
    ir::Value by{};
};

struct LaneLoop {
    std::vector<Carried> carried;
    // Of the body: made from nothing that changes from one iteration to the next, `by` among them; in their order.
    std::vector<const ir::Instruction*> fixed;
    // Where something is serial, else empty: what waits for it, by ir::Value::index, and in their order the
    // instructions that do not, also of branches whose other instructions do.
    std::vector<bool> waits;
    std::vector<const ir::Instruction*> side_by_side;
    bool is_ordered = false; // a draft: the iterations follow one another all the same, with the bits of lanes
};
using LaneLoops = std::map<const ir::For*, LaneLoop>;

// Inputs of the point vary, what the block holds does not, and of the function's parameters those vary that
// `parameters` says; whatever rests on what varies varies itself. By ir::Value::index. The results of a call vary
// together: all of them if one argument does.
std::vector<bool> varying_values(const ir::Function& function, const std::vector<bool>& parameters);

// Those of a function; where one is in another, the outer one. `varies`: varying_values.
LaneLoops lane_loops(const ir::Function& function, const std::vector<bool>& varies);

// As varying_values, but between the iterations of one loop, for one point: of the body of each of `loops`, of the
// ordered ones or of the others, or of everything where those of the function's parameters vary.
std::vector<bool> varying_iterations(const ir::Function& function, const std::vector<bool>& parameters,
                                     const LaneLoops& loops, bool ordered);

} // namespace haptel::jit
