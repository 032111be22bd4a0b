// What is built in: functions, what they are called, what they take, how they are lowered, of the list builtins.def;
// and what a texture may read.
#pragma once

#include "lang/ir/op_info.h"
#include "lang/syntax/resolution.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::lang {

struct BuiltinInput {
    std::string_view name;
    uint8_t size;
    std::string_view unit; // SI; empty: plain numbers, or newtons
};
inline constexpr BuiltinInput builtin_inputs[input_name_count] = {
    {"p", 3, "m"},      {"n", 3, ""},          {"uv", 2, ""},          {"time", 1, "s"},        {"center", 3, "m"},
    {"extent", 3, "m"}, {"footprint", 1, "m"}, {"velocity", 3, "m/s"}, {"normal_force", 1, ""}, {"tool_radius", 1, "m"},
    {"tangent", 3, ""}, {"bitangent", 3, ""},  {"curvature", 1, "1/m"}}; // by InputName

enum class BuiltinId : uint8_t {
#define OPERATION(id, ...) id,
#define COMPOSED(id, ...) id,
#include "lang/program/builtins.def"
};

struct Builtin {
    BuiltinId id;
    std::string_view name;
    std::string_view signatures; // "g(g,f) i(i,i)"
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

// Every overload by its name, in the order of builtins.def.
using BuiltinOverloads = std::map<std::string_view, std::vector<BuiltinOverload>>;
const BuiltinOverloads& builtin_overloads();
std::span<const BuiltinOverload> builtin_overloads(std::string_view name); // empty: no built-in has it

} // namespace haptel::lang
