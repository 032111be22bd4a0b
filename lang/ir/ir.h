// The middle of the compiler: structured SSA over scalars, in functions.
//
// There are no vectors (split on lowering), no branches (only `if` and `for` regions that yield values), no memory and
// no side effects; every program ends. What is here is what every evaluator must understand: interpreter, intervals,
// differentiation, LLVM, later C and GLSL. Invariants: verify.h; construction: builder.h.
#pragma once

#include "lang/text/source.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace haptel::ir {

using lang::Span;

enum class Type : uint8_t { real, i32, u32, boolean, image };

enum class Op : uint8_t {
#define OP(name, ...) name,
#include "lang/ir/ops.def"
};

// Index of a value in its function; dense. Values are made by instructions, by function parameters and by block
// parameters.
struct Value {
    uint32_t index = UINT32_MAX;
    bool operator==(const Value&) const = default;
};

// What a texture's entry may read of the point and of the block's head. Scalars, in the order of haptel_point and
// haptel_block_head; only entry functions hold `input` and `parameter` instructions: other functions get values passed.
enum class Input : uint8_t {
#define INPUT(name) name,
#include "lang/ir/inputs.def"
};
constexpr uint32_t input_count = static_cast<uint32_t>(Input::footprint) + 1;

struct Block;

// The kinds of instruction. `Operation` covers all of ops.def; the others give the program its structure.
struct Operation {
    Op op;
};
struct RealConstant {
    double value;
}; // any bits, NaN and -0 included
struct WordConstant {
    uint32_t bits;
}; // i32, u32 or boolean (0 or 1), by the result's type
struct ReadInput {
    Input input;
}; // entry functions only
struct ReadParameter {
    uint32_t parameter;
}; // index into Texture::parameters; entry functions only
struct ReadTable {
    uint32_t table;
}; // operand 0: i32 index, which the front end has clamped or proven in range
struct Call {
    uint32_t function;
}; // operands: arguments; results: the callee's results
// Derivative of operand 0 with respect to p along an axis. Not of what values are made of, but of where the program is
// used: gone once a texture has entries (differentiate.h), and never in a final program.
struct PointDerivative {
    uint32_t axis; // 0, 1, 2
};
// operand 0: condition. Blocks: then, else; both yield one value per result.
struct If {
    std::vector<Block> arms;
};
// operand 0: i32 trip count (below 0 counts as 0; above `trip_max` cannot be, `verify` insists that it is a proven
// bound or clamped); operands 1..n: initial carried values. Block parameters: i32 iteration from 0, then the carried
// values; it yields the next carried values. Results: the carried values after the last iteration.
struct For {
    uint32_t trip_max;
    std::vector<Block> body; /* exactly one */
};

using Kind = std::variant<Operation, RealConstant, WordConstant, ReadInput, ReadParameter, ReadTable, Call,
                          PointDerivative, If, For>;

struct Instruction {
    Kind kind;
    std::vector<Value> operands;
    std::vector<Value> results; // one, except for Call, If and For
    Span span;                  // innermost user code, for cost and diagnostics
};

struct Block {
    std::vector<Value> parameters;
    std::vector<Instruction> instructions;
    std::vector<Value> yields; // of a function body: the function's results
};

// The two arms of an `if`, the body of a loop, nothing of another instruction.
template <typename Made> // Instruction, const or not
auto blocks_of(Made& made) -> std::span<std::conditional_t<std::is_const_v<Made>, const Block, Block>>
{
    if (auto* choice = std::get_if<If>(&made.kind)) return choice->arms;
    if (auto* loop = std::get_if<For>(&made.kind)) return loop->body;
    return {};
}

// Of the block and of all blocks in it, each before what is in it.
template <typename Blocks, typename Visit>
void for_each_instruction(Blocks& block, const Visit& visit)
{
    for (auto& made : block.instructions) {
        visit(made);
        for (auto& inner : blocks_of(made)) for_each_instruction(inner, visit);
    }
}

// How smooth a value is as a function of what it is made from, the rougher the less; a composition is as smooth as its
// roughest part. The derivative of a c1 function is c0, and so on.
enum class Continuity : uint8_t { unknown, jump, c0, c1, c2, smooth };
Continuity lowered(Continuity continuity); // of the derivative

// Proven or declared properties of one result of a function; norms with respect to its first non-function argument,
// all other arguments within their ranges. Absent: unknown. Slope and curvature are of the pieces between jumps and,
// the curvature, kinks: of what lies on two pieces they say something only where the class does.
struct Facts {
    std::optional<double> value_minimum, value_maximum;
    std::optional<double> slope, curvature;
    std::optional<Continuity> continuity;
    bool proven = false; // the standard library's; others print as `declared`
    Span span = {};      // where they are declared
};

struct Function {
    std::string name; // unique in its module; readable: "fbm(vec3,int)", "fbm<perlin>(...)", "d noise"
    std::vector<Value> parameters;
    uint32_t first_argument_size = 0; // number of leading parameters that make up the first non-function argument
    std::vector<Type> value_types;    // by Value::index
    Block body;
    std::vector<Facts> facts; // by result; of those beyond its end nothing is known
    bool is_library = false;  // no user's code: what happens inside is told of the call
    Type type(Value value) const { return value_types[value.index]; }
};

// Of integers, inclusive: i32 as signed, u32 as unsigned, booleans as 0 and 1.
struct IntRange {
    int64_t minimum, maximum;
    bool is_constant() const { return minimum == maximum; }
    bool within(int64_t low, int64_t high) const { return low <= minimum && maximum <= high; }
    bool operator==(const IntRange&) const = default;
};

// Constant table. Cells of int and uint tables are stored as their bits.
struct Table {
    std::string name;
    Type element = Type::real;
    std::vector<double> reals;
    std::vector<uint32_t> words;
    std::optional<IntRange> range =
        {}; // of the words: found by the builder at the first read, known to it at all others
    uint32_t size() const { return static_cast<uint32_t>(element == Type::real ? reals.size() : words.size()); }
};

// A parameter as the block holds it. Numbers are SI; `offset` in bytes from the start of the block.
struct Parameter {
    std::string name, unit, doc;
    Type type = Type::real;
    double value = 0, minimum = 0, maximum = 0; // minimum == -inf, maximum == +inf where the author gave no range
    uint32_t offset = 0;
    Span span = {};
    std::vector<std::string> choices = {}; // names of the values 0 .. maximum of an i32; empty: it has none
};

// A texture and its entry functions. An entry has no parameters; it reads inputs and block.
//   height:           results (height_m: real, faults: u32)
//   height_gradient:  results (height_m, gx, gy, gz: real, faults: u32, then a real per bit of `writes`, then the
//                     faults of the height alone: u32), height bit-equal to that of `height`
// Both test their results: no entry returns a value that is not finite (see HAPTEL_FAULT_*).
struct Texture {
    std::string name, doc;
    std::vector<Parameter> parameters;
    uint32_t block_size = 0;
    uint32_t reads = 0, writes = 0; // HAPTEL_READS_*, HAPTEL_WRITES_*
    uint32_t body = UINT32_MAX;     // entry function of real results: the height as written, before the tests; outputs
    uint32_t height = UINT32_MAX;
    uint32_t height_gradient = UINT32_MAX;
    Span span;
    std::vector<Span> output_spans; // where each of `writes` is declared, by bit; empty in IR without a source
};

struct Module {
    std::vector<Function> functions; // callees before callers: a call refers to a smaller index
    std::vector<Table> tables;
    std::vector<Texture> textures;
};

} // namespace haptel::ir
