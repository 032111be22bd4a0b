#include "jit/codegen/iteration_lanes.h"

#include <algorithm>
#include <optional>

namespace haptel::jit {

namespace {

using ir::Op;

constexpr uint32_t iterations_least = 3; // fewer are not worth a register
constexpr int depth_most = 1000;         // of a chain of additions
constexpr uint32_t work_least = 20;      // operations: less is not worth splitting a loop for

// What a function's values are made by and how often they are used.
class Uses {
public:
    explicit Uses(const ir::Function& function)
        : makers(function.value_types.size()), counts(function.value_types.size())
    {
        const auto count = [&](const std::vector<ir::Value>& used) {
            for (ir::Value value : used) ++counts[value.index];
        };
        ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
            count(made.operands);
            for (ir::Value result : made.results) makers[result.index] = &made;
            for (const ir::Block& inner : ir::blocks_of(made)) count(inner.yields);
        });
        count(function.body.yields);
    }
    const ir::Instruction* maker(ir::Value value) const { return makers[value.index]; }
    uint32_t count(ir::Value value) const { return counts[value.index]; }

private:
    std::vector<const ir::Instruction*> makers;
    std::vector<uint32_t> counts;
};

std::optional<Op> operation(const ir::Instruction* made)
{
    const auto* found = made ? std::get_if<ir::Operation>(&made->kind) : nullptr;
    return found ? std::optional(found->op) : std::nullopt;
}

class Judge {
public:
    Judge(const ir::Function& of, const std::vector<bool>& varying, const Uses& of_values, const ir::Instruction& loop)
        : function(of)
        , varies(varying)
        , uses(of_values)
        , made(loop)
        , body(std::get<ir::For>(loop.kind).body[0])
        , changes(of.value_types.size())
    {
    }
    std::optional<LaneLoop> verdict()
    {
        if (std::get<ir::For>(made.kind).trip_max < iterations_least) return {};
        mark();
        bool sums_something = false, is_all_known = true;
        for (size_t i = 0; i < made.results.size(); ++i) {
            const ir::Value parameter = body.parameters[i + 1], yield = body.yields[i];
            // What follows from the iteration's number is not known after the last.
            std::optional<Carried> found;
            if (uses.count(made.results[i]) == 0) found = known(parameter, yield);
            const bool adds = !found && is_sum(parameter, yield);
            sums_something = sums_something || adds;
            is_all_known = is_all_known && (found || adds);
            found_loop.carried.push_back(found ? *found : Carried{adds ? Carried::Kind::sum : Carried::Kind::serial});
        }
        if (!is_all_known) return split();
        return sums_something ? std::optional(std::move(found_loop)) : std::nullopt;
    }

private:
    const ir::Function& function;
    const std::vector<bool>& varies;
    const Uses& uses;
    const ir::Instruction& made;
    const ir::Block& body;
    std::vector<bool> changes; // from one iteration to the next, by value
    LaneLoop found_loop;

    void mark()
    {
        for (ir::Value parameter : body.parameters) changes[parameter.index] = true;
        for (const ir::Instruction& inside : body.instructions) {
            const bool is_plain =
                !std::holds_alternative<ir::If>(inside.kind) && !std::holds_alternative<ir::For>(inside.kind);
            const bool is_fixed = is_plain && std::none_of(inside.operands.begin(), inside.operands.end(),
                                                           [&](ir::Value used) { return changes[used.index]; });
            if (is_fixed) found_loop.fixed.push_back(&inside);
            for (ir::Value result : inside.results) changes[result.index] = !is_fixed;
        }
    }
    // From the iteration's number alone.
    std::optional<Carried> known(ir::Value parameter, ir::Value yield)
    {
        using enum Carried::Kind;
        if (yield == parameter) return Carried{kept};
        if (!changes[yield.index]) return Carried{replaced, yield};
        const ir::Instruction* maker = uses.maker(yield);
        if (const std::optional<Op> op = operation(maker); op && maker->operands.size() == 2) {
            const ir::Value first = maker->operands[0], second = maker->operands[1];
            const auto is_same_for_all = [&](ir::Value by) { return !changes[by.index] && !varies[by.index]; };
            const bool is_add = op == Op::add || op == Op::iadd, is_times = op == Op::mul || op == Op::imul;
            if (first == parameter && is_same_for_all(second)) {
                if (is_add) return Carried{step, second};
                if (is_times) return Carried{factor, second};
                if (op == Op::sub || op == Op::isub) return Carried{back, second};
            }
            if (second == parameter && is_same_for_all(first)) {
                if (is_add) return Carried{step, first};
                if (is_times) return Carried{factor, first};
            }
        }
        return {};
    }
    bool is_sum(ir::Value parameter, ir::Value yield)
    {
        uint32_t accounted = 0;
        return function.type(parameter) == ir::Type::real && adds_to(parameter, yield, accounted, 0) &&
               accounted == uses.count(parameter);
    }
    std::optional<LaneLoop> split()
    {
        found_loop.waits.assign(changes.size(), false);
        for (size_t i = 0; i < found_loop.carried.size(); ++i) {
            Carried& one = found_loop.carried[i];
            if (one.kind == Carried::Kind::sum) one.kind = Carried::Kind::serial; // in the order of the others
            found_loop.waits[body.parameters[i + 1].index] = one.kind == Carried::Kind::serial;
        }
        const std::vector<const ir::Instruction*> fixed = found_loop.fixed;
        for (const ir::Instruction& inside : body.instructions)
            if (std::find(fixed.begin(), fixed.end(), &inside) == fixed.end()) sort(inside, found_loop.side_by_side);
        uint32_t work = 0;
        for (const ir::Instruction* apart : found_loop.side_by_side) work += work_of(*apart);
        return work >= work_least ? std::optional(std::move(found_loop)) : std::nullopt;
    }
    bool does_wait(const std::vector<ir::Value>& values) const
    {
        return std::any_of(values.begin(), values.end(),
                           [&](ir::Value value) { return found_loop.waits[value.index]; });
    }
    // Marks what waits; what does not joins `free`.
    void sort(const ir::Instruction& inside, std::vector<const ir::Instruction*>& free)
    {
        bool waits = does_wait(inside.operands);
        std::vector<const ir::Instruction*> free_of_arms;
        if (const auto* choice = std::get_if<ir::If>(&inside.kind))
            for (const ir::Block& arm : choice->arms) {
                const size_t count = free_of_arms.size() + arm.instructions.size();
                for (const ir::Instruction& of_arm : arm.instructions) sort(of_arm, free_of_arms);
                waits = waits || free_of_arms.size() != count || does_wait(arm.yields);
            }
        if (const auto* loop = std::get_if<ir::For>(&inside.kind)) {
            waits = waits || uses_waiting(loop->body[0]);
            if (waits) mark_all(loop->body[0]);
        }
        for (ir::Value result : inside.results) found_loop.waits[result.index] = waits;
        if (waits)
            free.insert(free.end(), free_of_arms.begin(), free_of_arms.end());
        else
            free.push_back(&inside);
    }
    bool uses_waiting(const ir::Block& block) const
    {
        const auto does = [&](const ir::Instruction& inside) {
            if (does_wait(inside.operands)) return true;
            const auto inner = ir::blocks_of(inside);
            return std::any_of(inner.begin(), inner.end(), [&](const ir::Block& in) { return uses_waiting(in); });
        };
        return does_wait(block.yields) || std::any_of(block.instructions.begin(), block.instructions.end(), does);
    }
    void mark_all(const ir::Block& block)
    {
        for (ir::Value parameter : block.parameters) found_loop.waits[parameter.index] = true;
        for (const ir::Instruction& inside : block.instructions) {
            for (ir::Value result : inside.results) found_loop.waits[result.index] = true;
            for (const ir::Block& inner : ir::blocks_of(inside)) mark_all(inner);
        }
    }
    static uint32_t work_of(const ir::Instruction& inside)
    {
        if (std::holds_alternative<ir::Call>(inside.kind) || std::holds_alternative<ir::For>(inside.kind))
            return work_least;
        uint32_t work = std::holds_alternative<ir::Operation>(inside.kind) ? 1 : 0;
        for (const ir::Block& arm : ir::blocks_of(inside))
            for (const ir::Instruction& of_arm : arm.instructions) work += work_of(of_arm);
        return work;
    }
    // Is `value` the parameter with things added to it? Counts the uses of the parameter on the way.
    bool adds_to(ir::Value parameter, ir::Value value, uint32_t& accounted, int depth)
    {
        if (value == parameter) return ++accounted, true;
        const ir::Instruction* maker = uses.maker(value);
        if (!maker || uses.count(value) != 1 || depth > depth_most) return false;
        const auto try_one = [&](ir::Value of) {
            uint32_t more = accounted;
            if (!adds_to(parameter, of, more, depth + 1)) return false;
            accounted = more;
            return true;
        };
        if (const auto* choice = std::get_if<ir::If>(&maker->kind)) {
            const auto place = std::find(maker->results.begin(), maker->results.end(), value) - maker->results.begin();
            return try_one(choice->arms[0].yields[static_cast<size_t>(place)]) &&
                   try_one(choice->arms[1].yields[static_cast<size_t>(place)]);
        }
        const std::optional<Op> op = operation(maker);
        if (op == Op::add) return try_one(maker->operands[0]) || try_one(maker->operands[1]);
        if (op == Op::sub) return try_one(maker->operands[0]);
        return op == Op::select && try_one(maker->operands[1]) && try_one(maker->operands[2]);
    }
};

void search(const ir::Function& function, const ir::Block& from, const std::vector<bool>& varies, const Uses& uses,
            LaneLoops& found)
{
    for (const ir::Instruction& made : from.instructions) {
        if (const auto* loop = std::get_if<ir::For>(&made.kind))
            if (std::optional<LaneLoop> verdict = Judge(function, varies, uses, made).verdict()) {
                found.emplace(loop, std::move(*verdict));
                continue;
            }
        for (const ir::Block& inner : ir::blocks_of(made)) search(function, inner, varies, uses, found);
    }
}

} // namespace

LaneLoops lane_loops(const ir::Function& function, const std::vector<bool>& varies)
{
    LaneLoops found;
    search(function, function.body, varies, Uses(function), found);
    return found;
}

} // namespace haptel::jit
