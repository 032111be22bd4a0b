// Types in the words of messages: how to get from one to another, and what a value of one is written as.
#pragma once

#include "lang/syntax/ast.h"
#include "lang/syntax/type.h"

#include <cstdint>
#include <string>

namespace haptel::lang {

// How to get from one type to the other by hand; `text` is the expression as written, `operand` the same in parentheses
// if it needs them.
std::string conversion_hint(Type from, Type to, const std::string& text, const std::string& operand);
// What to write where the operator does not take these two.
std::string operator_hint(ast::BinaryOp op, Type left, Type right);

// ".x", "[2]", "[0][1]", ".id.x": which part of a variable a bit stands for.
std::string part_name(Type type, uint32_t part);

std::string zero_of(Type type);        // as it is written: "vec2(0.0)"
std::string constructor_of(Type type); // of a struct: "Cell(id, d)"

} // namespace haptel::lang
