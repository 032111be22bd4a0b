// What ops.def says of each operation, as data: for the printer, the parser, the verifier and every table-driven test.
#pragma once

#include "lang/ir/ir.h"

#include <optional>
#include <span>
#include <string_view>

namespace haptel::ir {

// How smooth an operation is by itself: no kink; continuous with kinks; with jumps.
enum class Continuity : uint8_t { smooth, kink, jump };

struct OpInfo {
    Op op;
    std::string_view name;
    uint32_t arity;
    std::string_view operands; // one letter each: r real, i i32, u u32, b boolean, m image, * any one type
    char result;               // likewise
    Continuity continuity;
    bool reducing; // folds its argument into one period or cell
    std::string_view meaning;
};

const OpInfo& op_info(Op op);
std::span<const OpInfo> all_ops();
std::optional<Op> op_named(std::string_view name);

std::string_view to_string(Type type);             // "real", "i32", "u32", "bool", "image"
std::string_view to_string(Input input);           // "p_x"
std::string_view to_string(Smoothness smoothness); // "unknown", "jump", "C0", "C1", "C2", "smooth"
std::optional<Smoothness> smoothness_named(std::string_view name);

// Type of the operation's result, or nothing if number or types of the operands do not fit its signature.
std::optional<Type> result_type(Op op, std::span<const Type> operands);

} // namespace haptel::ir
