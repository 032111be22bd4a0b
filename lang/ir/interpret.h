// The slow, plain evaluator: the oracle that every other engine is compared with.
//
// Over double it gives the same bits as f64 code (elementary functions are the C library's in both, for now); over Quad
// it is the truth to about 34 digits, with branches and cells decided at that precision.
#pragma once

#include "lang/abi.h"
#include "lang/ir/ir.h"

#include <span>
#include <variant>
#include <vector>

namespace haptel::ir {

// Real numbers of one evaluation: T is double or Quad (quad.h). Integers and booleans are the same for all.
template <typename T>
using Scalar = std::variant<T, uint32_t, bool>; // real; i32 and u32 as bits; boolean

// What an entry reads. Parameter values by index in Texture::parameters.
template <typename T>
struct EntryInputs {
    T input[input_count] = {};
    std::vector<Scalar<T>> parameters;
};

// Results of a function for these arguments. `inputs` may be null for functions that are not entries.
template <typename T>
std::vector<Scalar<T>> interpret(const Module& module, uint32_t function, std::span<const Scalar<T>> arguments,
                                 const EntryInputs<T>* inputs);

} // namespace haptel::ir
