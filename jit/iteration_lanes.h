// Loops whose iterations can run side by side, in the lanes of a register: the octaves of a fractal, the terms of a
// Fourier series.
//
// That takes carried values that no iteration has to wait for: a sum, to which each iteration adds something of its
// own; a factor or a step that is the same each time, so that the value is known from the iteration's number; or a
// value that stays. A sum of a sum's derivative is a sum again, and what is the same for all points has no derivative:
// a loop and the same loop with derivatives are always judged alike, and give the same bits.
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
    };
    Kind kind = Kind::kept;
    ir::Value by{};
};

struct LaneLoop {
    std::vector<Carried> carried;
    // Of the body: made from nothing that changes from one iteration to the next, `by` among them; in their order.
    std::vector<const ir::Instruction*> fixed;
};
using LaneLoops = std::map<const ir::For*, LaneLoop>;

// Those of a function; where one is in another, the outer one. `varies` by ir::Value::index (jit/uniformity.h).
LaneLoops lane_loops(const ir::Function& function, const std::vector<bool>& varies);

} // namespace haptel::jit
