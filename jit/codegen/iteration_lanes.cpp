#include "jit/codegen/iteration_lanes.h"

#include "lang/ir/dataflow.h"

#include <algorithm>
#include <optional>

namespace haptel::jit {

namespace {

using ir::Op;

constexpr uint32_t iterations_least = 3; // fewer are not worth a register
constexpr int depth_most = 1000;         // of a chain of additions
constexpr uint32_t work_least = 20;      // operations: less is not worth splitting a loop for

std::optional<Op> operation(const ir::Instruction* made)
{
    const auto* found = made ? std::get_if<ir::Operation>(&made->kind) : nullptr;
    return found ? std::optional(found->op) : std::nullopt;
}

class LoopSearch {
public:
    LoopSearch(const ir::Function& of, const std::vector<bool>& varying)
        : function(of), varies(varying), makers(of.value_types.size()), counts(of.value_types.size())
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
    LaneLoops found;

    void search(const ir::Block& from)
    {
        for (const ir::Instruction& made : from.instructions) {
            const auto* loop = std::get_if<ir::For>(&made.kind);
            if (loop && loop->trip_max >= iterations_least && goes_in_lanes(made, loop->body[0]))
                found.emplace(loop, std::move(lane_loop));
            else
                for (const ir::Block& inner : ir::blocks_of(made)) search(inner);
        }
    }

private:
    const ir::Function& function;
    const std::vector<bool>& varies;
    // By value: what it is made by, and how often it is used.
    std::vector<const ir::Instruction*> makers;
    std::vector<uint32_t> counts;
    // Of the loop at hand; what changes from one iteration to the next, by value.
    LaneLoop lane_loop;
    std::vector<bool> changes;

    bool goes_in_lanes(const ir::Instruction& loop, const ir::Block& body)
    {
        lane_loop = {};
        mark(body);
        bool sums_something = false, is_all_known = true;
        for (size_t i = 0; i < loop.results.size(); ++i) {
            const ir::Value parameter = body.parameters[i + 1], yield = body.yields[i];
            // What follows from the iteration's number is not known after the last.
            std::optional<Carried> carried;
            if (counts[loop.results[i].index] == 0) carried = known(parameter, yield);
            const bool adds = !carried && is_sum(parameter, yield);
            sums_something = sums_something || adds;
            is_all_known = is_all_known && (carried || adds);
            lane_loop.carried.push_back(carried.value_or(Carried{adds ? Carried::Kind::sum : Carried::Kind::serial}));
        }
        return is_all_known ? sums_something : is_worth_splitting(body);
    }
    void mark(const ir::Block& body)
    {
        changes.assign(function.value_types.size(), false);
        for (ir::Value parameter : body.parameters) changes[parameter.index] = true;
        for (const ir::Instruction& inside : body.instructions) {
            const bool is_fixed =
                ir::blocks_of(inside).empty() &&
                std::ranges::none_of(inside.operands, [&](ir::Value used) { return changes[used.index]; });
            if (is_fixed) lane_loop.fixed.push_back(&inside);
            for (ir::Value result : inside.results) changes[result.index] = !is_fixed;
        }
    }
    // From the iteration's number alone.
    std::optional<Carried> known(ir::Value parameter, ir::Value yield)
    {
        using enum Carried::Kind;
        if (yield == parameter) return Carried{kept};
        if (!changes[yield.index]) return Carried{replaced, yield};
        const ir::Instruction* maker = makers[yield.index];
        const std::optional<Op> op = operation(maker);
        if (!op || maker->operands.size() != 2) return {};
        const bool is_first = maker->operands[0] == parameter, is_second = maker->operands[1] == parameter;
        const ir::Value by = maker->operands[is_first ? 1 : 0];
        if ((!is_first && !is_second) || changes[by.index] || varies[by.index]) return {};
        if (op == Op::add || op == Op::iadd) return Carried{step, by};
        if (op == Op::mul || op == Op::imul) return Carried{factor, by};
        if (is_first && (op == Op::sub || op == Op::isub)) return Carried{back, by};
        return {};
    }
    bool is_sum(ir::Value parameter, ir::Value yield)
    {
        uint32_t accounted = 0;
        return function.type(parameter) == ir::Type::real && adds_to(parameter, yield, accounted, 0) &&
               accounted == counts[parameter.index];
    }
    bool is_worth_splitting(const ir::Block& body)
    {
        lane_loop.waits.assign(changes.size(), false);
        for (size_t i = 0; i < lane_loop.carried.size(); ++i) {
            Carried& one = lane_loop.carried[i];
            if (one.kind == Carried::Kind::sum) one.kind = Carried::Kind::serial; // in the order of the others
            lane_loop.waits[body.parameters[i + 1].index] = one.kind == Carried::Kind::serial;
        }
        for (const ir::Instruction& inside : body.instructions)
            if (std::ranges::count(lane_loop.fixed, &inside) == 0) sort(inside, lane_loop.side_by_side);
        uint32_t work = 0;
        for (const ir::Instruction* apart : lane_loop.side_by_side) work += work_of(*apart);
        return work >= work_least;
    }
    bool does_wait(const std::vector<ir::Value>& values) const
    {
        return std::ranges::any_of(values, [&](ir::Value value) { return lane_loop.waits[value.index]; });
    }
    // Marks what waits, and says whether the instruction does; what does not joins `free`.
    bool sort(const ir::Instruction& inside, std::vector<const ir::Instruction*>& free)
    {
        bool waits = does_wait(inside.operands);
        std::vector<const ir::Instruction*> free_inside;
        for (const ir::Block& block : ir::blocks_of(inside)) {
            for (const ir::Instruction& in_block : block.instructions) waits |= sort(in_block, free_inside);
            waits |= does_wait(block.yields);
        }
        if (const auto* loop = std::get_if<ir::For>(&inside.kind); loop && waits) {
            mark_all(loop->body[0]);
            free_inside.clear();
        }
        for (ir::Value result : inside.results) lane_loop.waits[result.index] = waits;
        if (!waits) free_inside = {&inside};
        free.insert(free.end(), free_inside.begin(), free_inside.end());
        return waits;
    }
    void mark_all(const ir::Block& block)
    {
        for (ir::Value parameter : block.parameters) lane_loop.waits[parameter.index] = true;
        for (const ir::Instruction& inside : block.instructions) {
            for (ir::Value result : inside.results) lane_loop.waits[result.index] = true;
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
        const ir::Instruction* maker = makers[value.index];
        if (!maker || counts[value.index] != 1 || depth > depth_most) return false;
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

// Nothing that varies is ever taken back.
class Variance {
public:
    explicit Variance(const ir::Function& of, const std::vector<bool>& parameters)
        : varies(of.value_types.size()), is_one(of.value_types.size()), function(of)
    {
        for (size_t i = 0; i < parameters.size(); ++i) varies[function.parameters[i].index] = parameters[i];
    }
    std::vector<bool> varies;
    std::vector<bool> is_one; // whatever it is made from

    static constexpr uint32_t rounds_max = UINT32_MAX;

    bool set(ir::Value value)
    {
        if (varies[value.index] || is_one[value.index]) return false;
        return varies[value.index] = true;
    }
    bool flow(ir::Value from, ir::Value to) { return varies[from.index] && set(to); }
    void steer(ir::Value condition, ir::Value result) { flow(condition, result); }
    void assume(ir::Value) {}
    void visit(const ir::Instruction& made)
    {
        for (ir::Value operand : made.operands)
            for (ir::Value result : made.results) flow(operand, result);
    }
    std::vector<bool> found()
    {
        ir::Dataflow(*this).forwards(function.body);
        return std::move(varies);
    }

private:
    const ir::Function& function;
};

} // namespace

LaneLoops lane_loops(const ir::Function& function, const std::vector<bool>& varies)
{
    LoopSearch loops(function, varies);
    loops.search(function.body);
    return std::move(loops.found);
}

std::vector<bool> varying_values(const ir::Function& function, const std::vector<bool>& parameters)
{
    Variance variance(function, parameters);
    ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
        const auto* read = std::get_if<ir::ReadInput>(&made.kind);
        if (read && read->input < ir::Input::center_x) variance.set(made.results[0]);
    });
    return variance.found();
}

// The results of a loop in lanes are one for all iterations, and so is what waits for them.
std::vector<bool> varying_iterations(const ir::Function& function, const std::vector<bool>& parameters,
                                     const LaneLoops& loops, bool ordered)
{
    Variance variance(function, parameters);
    ir::for_each_instruction(function.body, [&](const ir::Instruction& made) {
        const auto* loop = std::get_if<ir::For>(&made.kind);
        const auto found = loop ? loops.find(loop) : loops.end();
        if (found == loops.end() || found->second.is_ordered != ordered) return;
        const LaneLoop& in_lanes = found->second;
        for (size_t i = 0; i < in_lanes.waits.size(); ++i)
            if (in_lanes.waits[i]) variance.is_one[i] = true;
        for (ir::Value result : made.results) variance.is_one[result.index] = true;
        const std::vector<ir::Value>& values = loop->body[0].parameters;
        variance.set(values[0]);
        for (size_t i = 0; i < in_lanes.carried.size(); ++i) {
            if (in_lanes.carried[i].kind != Carried::Kind::kept) variance.set(values[i + 1]);
            variance.is_one[values[i + 1].index] = true; // as it is now
        }
    });
    return variance.found();
}

} // namespace haptel::jit
