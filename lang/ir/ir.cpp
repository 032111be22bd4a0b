#include "lang/ir/op_info.h"

#include <algorithm>
#include <type_traits>

namespace haptel::ir {
namespace {

constexpr bool are_whole(std::span<const OpInfo> rows)
{
    return std::all_of(rows.begin(), rows.end(), [](const OpInfo& row) {
        const bool is_spelled = row.arity <= 4 && row.operands.find_first_not_of("riubm*") == std::string_view::npos;
        const bool is_elementary = row.kind == OpKind::elementary || row.kind == OpKind::angular;
        const bool has_bounds = !is_elementary || (row.traits.shape != Shape::own && row.traits.ulp > 0);
        const bool is_piecewise = row.continuity != Continuity::smooth && row.operands[0] == 'r';
        return is_spelled && has_bounds && (!is_piecewise || row.traits.decides != Decision::nothing);
    });
}
static_assert(are_whole(all_ops()),
              "a row of ops.def does not say how its bounds are made, or what decides its pieces");
// Adding a function to a module must not move the blocks of the others: they are held by pointer while it is built.
static_assert(std::is_nothrow_move_constructible_v<Function>);

// By type and continuity
constexpr std::string_view type_letters = "riubm", type_names[] = {"real", "i32", "u32", "bool", "image"};
constexpr std::string_view continuity_names[] = {"unknown", "jump", "C0", "C1", "C2", "smooth"};
constexpr Continuity of_derivative[] = {Continuity::unknown, Continuity::jump, Continuity::jump,
                                        Continuity::c0,      Continuity::c1,   Continuity::smooth};

} // namespace

std::optional<Op> op_named(std::string_view name)
{
    for (const OpInfo& info : all_ops())
        if (info.name == name) return info.op;
    return std::nullopt;
}

std::string_view to_string(Type type)
{
    return type_names[static_cast<size_t>(type)];
}

std::optional<Type> result_type(Op op, std::span<const Type> operands)
{
    const OpInfo& info = op_info(op);
    if (operands.size() != info.arity) return std::nullopt;
    std::optional<Type> any;
    for (size_t i = 0; i < operands.size(); ++i) {
        if (info.operands[i] == '*') {
            if (any && *any != operands[i]) return std::nullopt;
            any = operands[i];
        } else if (info.operands[i] != type_letters[static_cast<size_t>(operands[i])]) {
            return std::nullopt;
        }
    }
    return info.result == '*' ? any : static_cast<Type>(type_letters.find(info.result));
}

std::string_view to_string(Continuity continuity)
{
    return continuity_names[static_cast<size_t>(continuity)];
}

std::optional<Continuity> continuity_named(std::string_view name)
{
    const auto found = std::find(std::begin(continuity_names), std::end(continuity_names), name);
    if (found == std::end(continuity_names)) return std::nullopt;
    return static_cast<Continuity>(found - std::begin(continuity_names));
}

Continuity lowered(Continuity continuity)
{
    return of_derivative[static_cast<size_t>(continuity)];
}

} // namespace haptel::ir
