// Forward differentiation of IR functions: sparse (a zero tangent does not exist), closed under itself.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace haptel::ir {

// How one parameter of a function depends on one of the directions of differentiation.
enum class Seed : uint8_t {
    none,  // not at all
    unit,  // it is that direction: tangent 1
    given, // tangent passed as a further argument
};

// seeds[parameter][direction]; all rows have the same length, the number of directions.
using Seeds = std::vector<std::vector<Seed>>;

std::string pattern_of(const Seeds& seeds); // "1..,.t.": a letter per parameter and direction, for names

struct Derivative {
    uint32_t function = UINT32_MAX; // in the same module; memoised: equal request, equal index
    // The function's parameters: those of the original, then every `given` tangent by parameter, then direction.
    // Its results: those of the original, bit for bit, then the tangents that exist by result, then direction:
    std::vector<std::vector<bool>> exists; // [result of the original][direction]; false: tangent is zero
};

// Owns the memo; keep one per module for as long as functions are being added.
class Differentiator {
public:
    explicit Differentiator(Module& module);
    ~Differentiator();

    Derivative derivative(uint32_t function, const Seeds& seeds);

    // Partial derivatives with respect to the first non-function argument (first_argument_size parameters): unit seeds.
    Derivative jacobian(uint32_t function);

    // From Texture::body: makes `height` and `height_gradient`, with the tests of results that ir.h promises. The
    // gradient is with respect to p: tangents of n and uv are n_dp and uv_dp. A body that asks for derivatives with
    // respect to p is replaced by one that holds their values.
    void make_entries(Texture& texture);

private:
    struct Memo;
    Module& module;
    std::unique_ptr<Memo> memo;
};

} // namespace haptel::ir
