// Values of constant expressions. There is no second evaluator: the expression is lowered into a function of its own
// and interpreted.
#pragma once

#include "lang/syntax/ast.h"

#include <optional>
#include <vector>

namespace haptel::lang {

// The first part of a checked expression that is not constant: null if all is. Constant are literals, constants, and
// operators, constructors and built-in functions of them.
const ast::Expression* first_not_constant(const ast::Expression& expression);

// The components of a checked constant expression, converted to `type` (a scalar or vector).
std::vector<ConstantPart> evaluate_constant(const ast::Expression& expression, Type type);

// As a number: reals as they are, integers by the sign of `type`, false 0 and true 1.
double as_number(const ConstantPart& part, Type type);

} // namespace haptel::lang
