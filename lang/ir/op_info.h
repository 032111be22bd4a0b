// What ops.def says of each operation, as data: for every stage that need not tell the operations apart by name.
#pragma once

#include "lang/ir/ir.h"

#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

namespace haptel::ir {

enum class OpKind : uint8_t { plain, discrete, elementary, angular }; // see ops.def

// On what a real result stays on one smooth piece: nothing decides; which of two operands is less; the operand's sign;
// the whole result; the cell of a or of a / b; whether the result is 0; the signs of both operands; the result's bits.
enum class Decision : uint8_t { nothing, order, side, whole, cell, cell_of_quotient, tip, quadrant, truth };

// What bounds |result| beside `least` and `most`: nothing; the operands' sizes added, multiplied; that of the first,
// the larger of the last two, the last.
enum class Growth : uint8_t { range, sum, product, first, largest, last };

// How the interval of a result is made of those of the operands: by a rule of its own; rising or falling; rising with
// |a|; a wave of that period with a crest at `crest`; the direction of (b, a), where a full turn is `period`; ...
enum class Shape : uint8_t { own, rising, falling, even, wave, angle, tangent, power };

struct Traits {
    std::string_view called = {}; // by authors, where not by its name; an expression that is no call has a space
    std::string_view instead = "blend with smoothstep(), smoothabs(), smoothmin() or smoothmax()"; // if it is too rough
    std::string_view dimensions = "1(1,1)"; // rule of an elementary function of two, as in builtins.def
    bool commutes = false;
    bool reduces = false;          // folds its argument into one period or cell, or must not round a whole number
    bool is_guarded = false;       // its derivative is 0 where it were infinite
    bool has_pole_at_ends = false; // of from .. to
    double ulp = 0;                // largest error over all operands, in units in the last place of either format
    Decision decides = Decision::nothing;
    Growth growth = Growth::range;
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity(); // results
    Shape shape = Shape::own;
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity(); // else NaN
    double period = 0, crest = 0;
};

struct OpInfo {
    Op op;
    std::string_view name;
    OpKind kind;
    uint32_t arity;
    std::string_view operands; // one letter each: r real, i i32, u u32, b boolean, m image, * any one type
    char result;               // likewise
    Continuity continuity;
    std::string_view meaning;
    Traits traits = {};
};

namespace op_table {

using enum Decision;
using enum Growth;
using enum Shape;
using std::numbers::pi;

inline constexpr std::string_view ramp = "smoothstep() makes a ramp of the step";
inline constexpr std::string_view turns = "sinturn() and wave() repeat smoothly";
inline constexpr std::string_view dot = "a length has a tip where it is 0: use dot(x, x), or sqrt(dot(x, x) + k * k)";
inline constexpr std::string_view steep = "its slope has no bound at 0: add a small constant to what it is of";

constexpr std::string_view operands_of(std::string_view signature)
{
    return signature.substr(0, signature.find('>'));
}

inline constexpr OpInfo rows[] = {
#define ROW(kind, name, signature, continuity, ...)                                                                    \
    {Op::name,                                                                                                         \
     #name,                                                                                                            \
     OpKind::kind,                                                                                                     \
     static_cast<uint32_t>(operands_of(signature).size()),                                                             \
     operands_of(signature),                                                                                           \
     std::string_view(signature).back(),                                                                               \
     Continuity::continuity,                                                                                           \
     __VA_ARGS__},
#define OP(...) ROW(plain, __VA_ARGS__)
#define DISCRETE(...) ROW(discrete, __VA_ARGS__)
#define ELEMENTARY(...) ROW(elementary, __VA_ARGS__)
#define ANGULAR(...) ROW(angular, __VA_ARGS__)
#include "lang/ir/ops.def"
#undef ROW
};

} // namespace op_table

constexpr const OpInfo& op_info(Op op)
{
    return op_table::rows[static_cast<size_t>(op)];
}
constexpr const Traits& traits(Op op)
{
    return op_info(op).traits;
}
constexpr std::span<const OpInfo> all_ops()
{
    return op_table::rows;
}
constexpr std::string_view called(Op op)
{
    return traits(op).called.empty() ? op_info(op).name : traits(op).called;
}

constexpr bool takes_angle(Op op)
{
    return op_info(op).kind == OpKind::angular;
}
constexpr bool is_elementary(Op op)
{
    return op_info(op).kind == OpKind::elementary || takes_angle(op);
}
constexpr bool is_step(Op op) // changes by whole numbers alone
{
    return traits(op).decides == Decision::whole;
}
constexpr bool is_length(Op op)
{
    return traits(op).decides == Decision::tip;
}

std::optional<Op> op_named(std::string_view name);

std::string_view to_string(Type type);             // "real", "i32", "u32", "bool", "image"
std::string_view to_string(Continuity continuity); // "unknown", "jump", "C0", "C1", "C2", "smooth"
std::optional<Continuity> continuity_named(std::string_view name);

// Type of the operation's result, or nothing if number or types of the operands do not fit its signature.
std::optional<Type> result_type(Op op, std::span<const Type> operands);

} // namespace haptel::ir
