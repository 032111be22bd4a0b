// Values of constant expressions. There is no second evaluator: the expression is lowered into a function of its own
// and interpreted.
#pragma once

#include "lang/syntax/ast.h"

#include <memory>
#include <optional>
#include <vector>

namespace haptel::lang {

// The first part of a checked expression that is not constant: null if all is. Constant are literals, constants, and
// operators, constructors and built-in functions of them.
const ast::Expression* first_not_constant(const ast::Expression& expression);

// Of one program: what its constants read and call is made once for all of them.
class ConstantEvaluator {
public:
    ConstantEvaluator();
    // The components of a checked constant expression, converted to `type`.
    std::vector<ConstantPart> value(const ast::Expression& expression, Type type);

private:
    struct Work;
    const std::shared_ptr<Work> work;
};

// As a number: reals as they are, integers by the sign of `type`, false 0 and true 1.
double as_number(const ConstantPart& part, Type type);

} // namespace haptel::lang
