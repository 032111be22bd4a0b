// Where functions ask how fast something moves with the surface point p, wherever they are called from (`stretch`, and
// so `footprint_in`): what the answers are made of.
//
// Inside of what is measured other measurements count as constants: the footprint of a warp that is band-limited itself
// does not ask how its fade moves. Otherwise a warp in a loop would need derivatives of every order.
#pragma once

#include "lang/ir/derive/activity.h"
#include "lang/ir/ir.h"

#include <vector>

namespace haptel::ir {

struct PointUse {
    bool asks = false;            // directly or in what it calls
    std::vector<bool> parameters; // whose tangents the answers are made of
};

// Of all functions of a module, worked out as they are asked for.
class PointUses {
public:
    explicit PointUses(const Module& whole) : dependences(whole, PointDerivatives::resolved), module(whole) {}
    const PointUse& of(uint32_t function);
    // By value: is its tangent part of an answer, or of a result's tangent where those are wanted?
    std::vector<bool> needed(const Function& function, bool tangents_of_results);

    Dependences dependences;

private:
    const Module& module;
    std::vector<PointUse> uses; // by function
};

// Removes the functions that still ask: nothing that is run calls them.
void remove_unresolved(Module& module);

} // namespace haptel::ir
