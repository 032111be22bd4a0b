// What the checker finds out about names, calls and loops. The tree (ast.h) points here; lowering reads it.
#pragma once

#include "lang/ir/int_range.h"
#include "lang/syntax/type.h"
#include "lang/text/source.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace haptel::lang {

namespace ast {
struct CallExpression;
struct Function;
struct Expression;
struct Name;
} // namespace ast

struct BuiltinOverload;
struct FunctionInfo;
struct Symbol;

// Inputs of a texture; the value is the bit number in HAPTEL_READS_*.
enum class InputName : uint8_t {
    p,
    n,
    uv,
    time,
    center,
    extent,
    footprint,
    velocity, // from here on of the contact: for outputs only
    normal_force,
    tool_radius,
    tangent,
    bitangent,
    curvature
};
constexpr uint32_t input_name_count = 13;

// One component of a constant: a real number, the bits of an int or uint, or a bool.
using ConstantPart = std::variant<double, uint32_t, bool>;

enum class SymbolKind : uint8_t {
    local,             // variable, value parameter of a function, loop counter
    constant,          // `const` whose value is known; `value` holds it
    table,             // constant table; `value` holds the cells, component after component
    texture_parameter, // `slot` is its index in the texture, that of its first component
    input,             // `input` says which
    function,          // parameter that is a function, known when its owner is lowered; `slot` counts such parameters
};

// The names of the values 0, 1, 2 ... of a texture's parameter, for where one of them is expected. Owned by
// CheckedProgram.
struct Choices {
    const std::vector<ast::Name>* names = nullptr;
    std::map<std::string_view, const Symbol*> constants = {}; // by name
};

// What a function does with its argument: read it, give it a value, or both. What it writes is a result of the call.
enum class Passing : uint8_t { in, out, inout };

// A parameter of something that can be called. Two are equal if overloads cannot be told apart by them.
struct ParameterInfo {
    Type type; // of a function: its result
    std::string name = {};
    bool is_function = false;
    std::vector<Type> signature = {}; // of a function: types of its arguments
    const Symbol* symbol = nullptr;   // inside the function that has it; null if it has no name
    Passing passing = Passing::in;
    bool is_written() const { return passing != Passing::in; }
    const ast::Expression* value = nullptr; // where a call leaves it out; null: it may not
    std::vector<ConstantPart> value_parts = {};
    std::optional<ir::IntRange> range = {}; // of a whole number, over all calls seen so far; nothing: none
    std::optional<ir::IntRange> held = {};  // that of a texture's parameter, within which it is held
    const Choices* choices = nullptr;       // of a texture's parameter; null: its values have no names
    bool operator==(const ParameterInfo& other) const
    {
        return type == other.type && is_function == other.is_function && signature == other.signature;
    }
};

// What a name stands for. Owned by CheckedProgram.
struct Symbol {
    SymbolKind kind = SymbolKind::local;
    std::string name;
    Type type; // of a function: its result
    Span span; // of the name where it was declared; empty for inputs
    uint32_t slot = 0;
    InputName input = InputName::p;
    std::optional<ir::IntRange>
        range; // constants and texture parameters; nothing: of reals, and of locals, where only flow knows
    std::vector<ConstantPart> value;       // constants and tables
    std::vector<ParameterInfo> parameters; // of a function
    const char* read_only = nullptr;       // why it cannot be assigned to, as a clause; null: it can
    bool is_parameter = false;             // of a function or texture, for messages
    bool is_read = false;
    bool is_choice = false;      // a constant that names a value of a texture's parameter
    uint64_t parts_assigned = 0; // behind its declaration, by text read so far or by a loop round it; see parts_of()
};

// A function that is called or passed: from source, built in, a parameter of the function around the call, or what a
// call with open arguments leaves, "f(_, 2.0)".
using FunctionReference = std::variant<std::monostate, const FunctionInfo*, const BuiltinOverload*, const Symbol*,
                                       const ast::CallExpression*>;

// What tells functions of the source and built-in ones apart; null: another.
inline const void* identity(const FunctionReference& reference)
{
    if (auto source = std::get_if<const FunctionInfo*>(&reference)) return *source;
    if (auto builtin = std::get_if<const BuiltinOverload*>(&reference)) return *builtin;
    return nullptr;
}

struct CallTarget {
    bool is_constructor = false; // then the expression's type says of what
    FunctionReference function;
    std::vector<FunctionReference> function_arguments; // one per argument; empty where the argument is a value
    std::vector<bool> is_open;                         // one per argument, "_"; empty: none, and this is a call
};

// A loop whose trip count is bounded: `for (int i = start; i < bound; i += step)`, or with <=, > or >=. The counter may
// be a float if all three are constant; it is then start + turn * step, and `trip_max` the number of turns.
struct LoopPlan {
    double real_start = 0, real_step = 0;
    const Symbol* counter = nullptr;
    const ast::Expression* start = nullptr;
    const ast::Expression* bound = nullptr; // not changed by the body, so it is evaluated once
    bool is_inclusive = false;              // the counter may be the bound
    int64_t step = 1;
    uint32_t trip_max = 0;
    bool runs = false;                // certainly, at least once, and there is a body
    bool difference_may_wrap = false; // bound - start does not fit into 32 bits for every value in range
};

// A function of the source.
struct FunctionInfo {
    // A function mentioned in the body, called or passed on: an edge of the call graph.
    struct Mention {
        const FunctionInfo* function = nullptr; // null: built in, or a parameter
        Span span;
        uint32_t order = 0;                            // how often grad is applied to it
        std::vector<const FunctionInfo*> through = {}; // functions it is passed to, which may differentiate it
    };

    std::string name;
    Type result;
    std::vector<ParameterInfo> parameters;
    const ast::Function* tree = nullptr;
    uint32_t file = 0;
    bool is_library = false;
    uint32_t slot_count = 0;       // local variables, parameters included
    uint32_t reads = 0;            // HAPTEL_READS_* of itself and of every function it mentions
    uint32_t call_depth = 0;       // functions in the longest chain of calls that starts here
    uint32_t derivative_order = 0; // of derivatives of derivatives that it takes, at most
    std::vector<Mention> mentions;
    bool is_valid = true;      // false: its head has errors; calls to it are not checked
    bool is_mentioned = false; // called or passed, by what is checked so far
    bool is_in_circle = false; // of functions that may call each other: see callers_first()
    bool is_texture = false;   // called by names; its outputs are 1 from the start, and may be left out
};

} // namespace haptel::lang
