// The built-in functions: what they are called, what they take, how they are lowered. The list is builtins.def.
#pragma once

#include "lang/ir/op_info.h"
#include "lang/syntax/resolution.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::lang {

enum class BuiltinId : uint8_t {
#define OPERATION(id, ...) id,
#define COMPOSED(id, ...) id,
#include "lang/program/builtins.def"
#undef OPERATION
#undef COMPOSED
};

struct Builtin {
    BuiltinId id;
    std::string_view name;
    std::string_view dimensions; // what it makes of those of its arguments: "a^1/2(a)"
    std::optional<ir::Op> op;    // applied component by component; nothing: composed of several
    std::string_view doc;
};

// One signature with its generic letters filled in.
struct BuiltinOverload {
    const Builtin* builtin = nullptr;
    Type result;
    std::vector<ParameterInfo> parameters;
};

std::span<const Builtin> all_builtins();

// Every overload of that name, in the order of builtins.def; empty: no built-in has it.
std::span<const BuiltinOverload> builtin_overloads(std::string_view name);

// Names, for "did you mean".
const std::vector<std::string_view>& builtin_names();

} // namespace haptel::lang
