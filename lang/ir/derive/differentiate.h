// Forward differentiation of IR functions: sparse (a zero tangent does not exist), closed under itself.
//
// Derivatives with respect to the point become values on the way: once a texture's body is whole, the answers are
// known, and each function that asks is made anew for its caller's tangents along p. The entries are made from the
// result, so that their gradient is exact, second derivatives of a warp included.
#pragma once

#include "lang/ir/derive/activity.h"
#include "lang/ir/derive/point_derivative.h"
#include "lang/ir/ir.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace haptel::ir {

constexpr size_t axes = 3; // directions of an entry's gradient: p_x, p_y, p_z

// How one parameter of a function depends on one of the directions of differentiation.
enum class Seed : uint8_t {
    none,  // not at all
    unit,  // it is that direction: tangent 1
    given, // tangent passed as a further argument
};

// seeds[parameter][direction]; all rows have the same length, the number of directions.
using Seeds = std::vector<std::vector<Seed>>;

struct Derivative {
    uint32_t function = UINT32_MAX; // in the same module; memoised: equal request, equal index
    // The function's parameters: those of the original, then every `given` tangent by parameter, then direction.
    // Its results: those of the original, bit for bit, then the tangents that exist by result, then direction:
    std::vector<std::vector<bool>> exists; // [result of the original][direction]; false: tangent is zero
};

struct DerivativeRequest {
    uint32_t function;
    Seeds seeds; // where derivatives with respect to the point are resolved: by the axes of p
    PointDerivatives point_derivatives = PointDerivatives::vary;
    bool tangents_wanted = true; // false: the function's values alone
    auto operator<=>(const DerivativeRequest&) const = default;
};

// How the derivative of a callee is had at a call.
struct CallPlan {
    bool by_jacobian = false; // with respect to the `columns`, and the chain rule; else the tangents are passed on
    std::vector<size_t> columns = {}; // active arguments that a result depends on
    DerivativeRequest request = {};   // of the callee
};

// Owns the memo; keep one per module for as long as functions are being added.
class Differentiator {
public:
    explicit Differentiator(Module& whole) : module(whole), dependences(whole), point_uses(whole) {}

    Derivative derivative(const DerivativeRequest& request);
    Derivative derivative(uint32_t function, const Seeds& seeds) { return derivative({function, seeds}); }

    // Partial derivatives with respect to the first non-function argument (first_argument_size parameters): unit seeds.
    Derivative jacobian(uint32_t function);

    // From Texture::body: makes `height` and `height_gradient`, with the tests of results that ir.h promises. The
    // gradient is with respect to p: tangents of n and uv are n_dp and uv_dp. A body that asks for derivatives with
    // respect to p is replaced by one that holds their values.
    void make_entries(Texture& texture);

    // An entry like height_gradient of a texture without outputs, whose gradient is with respect to real parameters of
    // the texture, by their index, at most as many as there are axes. After make_entries().
    uint32_t parameter_gradient(const Texture& texture, std::span<const uint32_t> parameters);

    // Nothing where no result has a tangent, else the way that needs fewer directions inside the callee. The chain rule
    // at the call is no way for a callee that asks for derivatives with respect to the point: there it matters how the
    // tangents themselves move.
    std::optional<CallPlan> plan(const Instruction& call, const Activity& activity, PointDerivatives point_derivatives);

private:
    Module& module;
    Dependences dependences;
    PointUses point_uses;
    std::map<DerivativeRequest, Derivative> memo;

    enum class By : uint8_t { nothing, point, parameters };
    uint32_t entry(const Texture& texture, By by, const std::string& name, std::span<const uint32_t> parameters = {});
};

} // namespace haptel::ir
