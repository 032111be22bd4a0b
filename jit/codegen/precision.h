// In which precision a value is computed.
//
// The rule of `mixed`: what may be large and reaches the argument of a reducing operation (floor, fract, mod, sin ...)
// or becomes an integer is f64, because there the digits behind the point count and the ones before it do not: a
// coordinate of 1e7 cells keeps its place within the cell. Everything else is f32. What is the same for all points is
// f64 always.
#pragma once

#include "lang/ir/ir.h"

#include <cstdint>
#include <vector>

namespace haptel::jit {

enum class Precision : uint8_t { f64, mixed, f32 };

class PrecisionPlan {
public:
    PrecisionPlan(const ir::Module& module, Precision precision);

    const ir::Module& module;
    const Precision precision;

    // By ir::Value::index of one function: reals that are f64 where they vary. `wide_results` tells which results the
    // caller wants so.
    std::vector<bool> wide_values(uint32_t function, const std::vector<bool>& wide_results) const;

    // Where a value goes: bit 0 to where it must be f64, bit 1 + i to result i (results beyond 62 share a bit).
    using Sinks = uint64_t;
    struct Summary {
        std::vector<Sinks> sinks;          // by ir::Value::index
        std::vector<double> result_bounds; // |result| at most
    };

private:
    std::vector<Summary> functions; // empty but for `mixed`
};

} // namespace haptel::jit
