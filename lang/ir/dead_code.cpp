#include "lang/ir/dead_code.h"

#include <algorithm>

namespace haptel::ir {
namespace {

class Marker {
public:
    // Without `parameters` a call needs all of its operands.
    explicit Marker(const Function& whole, const ParametersNeeded* parameters = nullptr)
        : needed(whole.value_types.size(), false), parameters_needed(parameters)
    {
    }
    std::vector<bool> needed; // by Value::index

    void need(Value value) { needed[value.index] = true; }
    void need(const std::vector<Value>& values)
    {
        for (Value value : values) need(value);
    }
    bool is_needed(Value value) const { return needed[value.index]; }
    bool is_needed(const Instruction& instruction) const
    {
        return std::any_of(instruction.results.begin(), instruction.results.end(),
                           [&](Value value) { return is_needed(value); });
    }

    // From the last instruction back: a block's uses are all seen before their makers.
    void mark(const Block& block)
    {
        for (auto instruction = block.instructions.rbegin(); instruction != block.instructions.rend(); ++instruction) {
            if (!is_needed(*instruction)) continue;
            if (auto* choice = std::get_if<If>(&instruction->kind)) {
                need(instruction->operands);
                for (const Block& arm : choice->arms) {
                    for (size_t i = 0; i < arm.yields.size(); ++i)
                        if (needed[instruction->results[i].index]) need(arm.yields[i]);
                    mark(arm);
                }
            } else if (auto* loop = std::get_if<For>(&instruction->kind)) {
                mark_loop(*instruction, loop->body[0]);
            } else if (auto* call = std::get_if<Call>(&instruction->kind); call && parameters_needed) {
                mark_call(*instruction, *call);
            } else {
                need(instruction->operands);
            }
        }
    }

private:
    const ParametersNeeded* const parameters_needed;

    void mark_call(const Instruction& made, const Call& call)
    {
        std::vector<bool> results;
        for (Value result : made.results) results.push_back(is_needed(result));
        const std::vector<bool> parameters = (*parameters_needed)(call.function, results);
        for (size_t i = 0; i < made.operands.size(); ++i)
            if (parameters[i]) need(made.operands[i]);
    }

    // A carried value is needed if its result is, or if the next iteration of a needed one reads it: a round of marking
    // for each that is found late. After a few rounds everything is kept, so that long chains cost no quadratic time.
    void mark_loop(const Instruction& made, const Block& body)
    {
        need(made.operands[0]);
        for (int round = 0;; ++round) {
            bool changed = false;
            for (size_t i = 0; i < made.results.size(); ++i) {
                Value result = made.results[i], carried = body.parameters[i + 1];
                bool wanted = needed[result.index] || needed[carried.index] || round == rounds_max;
                if (wanted && !(needed[carried.index] && needed[body.yields[i].index] && needed[result.index]))
                    changed = true;
                if (!wanted) continue;
                need(result);
                need(carried);
                need(body.yields[i]);
                need(made.operands[i + 1]);
            }
            if (!changed) return;
            mark(body);
        }
    }
    static constexpr int rounds_max = 8;
};

class Remover {
public:
    explicit Remover(Function& whole) : function(whole), marker(whole) {}

    void run()
    {
        marker.need(function.body.yields);
        marker.mark(function.body);
        sweep(function.body);
        number();
    }

private:
    Function& function;
    Marker marker;

    template <typename Keep>
    static void filter(std::vector<Value>& values, size_t first, const Keep& keep)
    {
        size_t kept = first;
        for (size_t i = first; i < values.size(); ++i)
            if (keep(i - first)) values[kept++] = values[i];
        values.resize(kept);
    }

    void sweep(Block& block)
    {
        std::erase_if(block.instructions, [&](const Instruction& made) { return !marker.is_needed(made); });
        for (Instruction& made : block.instructions) {
            auto* choice = std::get_if<If>(&made.kind);
            auto* loop = std::get_if<For>(&made.kind);
            if (!choice && !loop) continue;
            const std::vector<Value> results = made.results;
            auto keep = [&](size_t i) { return marker.is_needed(results[i]); };
            filter(made.results, 0, keep);
            if (loop) filter(made.operands, 1, keep);
            for (Block& inner : choice ? choice->arms : loop->body) {
                if (loop) filter(inner.parameters, 1, keep);
                filter(inner.yields, 0, keep);
                sweep(inner);
            }
        }
    }

    // Every use follows its definition in this order, so that one walk renames both.
    void number()
    {
        std::vector<Value> renamed(function.value_types.size());
        std::vector<Type> types;
        auto define = [&](std::vector<Value>& values) {
            for (Value& value : values) {
                types.push_back(function.value_types[value.index]);
                renamed[value.index] = {static_cast<uint32_t>(types.size() - 1)};
                value = renamed[value.index];
            }
        };
        define(function.parameters);
        rename(function.body, renamed, define);
        function.value_types = std::move(types);
    }

    template <typename Define>
    static void rename(Block& block, const std::vector<Value>& renamed, const Define& define)
    {
        auto use = [&](std::vector<Value>& values) {
            for (Value& value : values) value = renamed[value.index];
        };
        define(block.parameters);
        for (Instruction& made : block.instructions) {
            use(made.operands);
            define(made.results);
            if (auto* choice = std::get_if<If>(&made.kind))
                for (Block& arm : choice->arms) rename(arm, renamed, define);
            if (auto* loop = std::get_if<For>(&made.kind)) rename(loop->body[0], renamed, define);
        }
        use(block.yields);
    }
};

} // namespace

std::vector<bool> needed_values(const Function& function, const std::vector<bool>& results,
                                const ParametersNeeded& parameters)
{
    Marker marker(function, &parameters);
    for (size_t i = 0; i < results.size(); ++i)
        if (results[i]) marker.need(function.body.yields[i]);
    marker.mark(function.body);
    return std::move(marker.needed);
}

void remove_dead_code(Function& function)
{
    Remover(function).run();
}

} // namespace haptel::ir
