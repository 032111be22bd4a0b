// The derivative of every operation: one page, in derivative_rules.cpp.
#pragma once

#include "lang/ir/builder.h"

#include <optional>
#include <span>

namespace haptel::ir {

// Derivative of a value in one direction; absent: zero.
using Tangent = std::optional<Value>;

// False where the derivative is zero for every operand (steps, detach) or the result is no real number.
bool has_derivative(Op op);

// Tangent of result = op(operands), made in `builder`, from those of the operands.
Tangent differentiate(Builder& builder, Op op, std::span<const Value> operands, Value result,
                      std::span<const Tangent> tangents);

} // namespace haptel::ir
