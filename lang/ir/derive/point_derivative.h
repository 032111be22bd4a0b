// Derivatives with respect to the point become values.
//
// A function may ask how fast something moves with the surface point p, wherever it is called from (`stretch`, and so
// `footprint_in`). Once a texture's body is whole, the answers are known: this pass makes each function anew for its
// caller's tangents along p and puts them in place. The entries are made from the result, so that their gradient is
// exact, second derivatives of a warp included.
//
// Inside of what is measured other measurements count as constants: the footprint of a warp that is band-limited itself
// does not ask how its fade moves. Otherwise a warp in a loop would need derivatives of every order.
#pragma once

#include "lang/ir/derive/activity.h"
#include "lang/ir/derive/derivative_emitter.h"
#include "lang/ir/ir.h"

#include <map>
#include <tuple>
#include <vector>

namespace haptel::ir {

// Where a function asks for derivatives with respect to the point, directly or in what it calls.
struct PointUse {
    bool asks = false;
    std::vector<bool> parameters; // whose tangents the answers are made of
};

class PointDerivativeResolver final : Callees {
public:
    PointDerivativeResolver(Module& module, Differentiator& differentiator);

    // An entry function that computes the same without asking; the same function if it does not ask.
    uint32_t resolved_entry(uint32_t entry);
    bool asks(uint32_t function) { return use_of(function).asks; }

private:
    Module& module;
    Differentiator& differentiator;
    Dependences dependences;
    std::vector<PointUse> uses; // by function
    using Key = std::tuple<uint32_t, Seeds, bool>;
    std::map<Key, Derivative> memo;

    const PointUse& use_of(uint32_t function);
    // By value: is its tangent part of an answer, or of a result's tangent where those are wanted?
    std::vector<bool> needed(const Function& function, bool tangents_of_results);
    Derivative resolved(uint32_t function, const Seeds& seeds, bool tangents_of_results);

    CallPlan plan(const Instruction& call, const Activity& activity) override;
    Derivative derivative(uint32_t callee, const CallPlan& plan) override;
    bool resolves_point_derivatives() const override { return true; }
};

// Removes the functions that still ask: nothing that is run calls them.
void remove_unresolved(Module& module);

} // namespace haptel::ir
