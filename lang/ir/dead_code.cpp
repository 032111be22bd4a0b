#include "lang/ir/dead_code.h"

#include "lang/ir/dataflow.h"

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

    static constexpr uint32_t rounds_max = 8;

    bool need(Value value)
    {
        const bool is_new = !needed[value.index];
        needed[value.index] = true;
        return is_new;
    }
    bool is_needed(Value value) const { return needed[value.index]; }
    bool is_needed(const Instruction& instruction) const
    {
        return std::any_of(instruction.results.begin(), instruction.results.end(),
                           [&](Value value) { return is_needed(value); });
    }

    bool flow(Value from, Value to) { return is_needed(from) && need(to); }
    void steer(Value condition, Value result) { flow(result, condition); }
    void assume(Value carried) { need(carried); }
    void visit(const Instruction& made)
    {
        if (!is_needed(made)) return;
        std::vector<bool> used(made.operands.size(), true);
        if (const auto* call = std::get_if<Call>(&made.kind); call && parameters_needed) {
            std::vector<bool> results;
            for (Value result : made.results) results.push_back(is_needed(result));
            used = (*parameters_needed)(call->function, results);
        }
        for (size_t i = 0; i < made.operands.size(); ++i)
            if (used[i]) need(made.operands[i]);
    }

private:
    const ParametersNeeded* const parameters_needed;
};

class Remover {
public:
    explicit Remover(Function& whole) : function(whole), marker(whole) {}

    void run()
    {
        for (Value result : function.body.yields) marker.need(result);
        Dataflow(marker).backwards(function.body);
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
            if (blocks_of(made).empty()) continue;
            const bool is_loop = std::holds_alternative<For>(made.kind);
            const std::vector<Value> results = made.results;
            auto keep = [&](size_t i) { return marker.is_needed(results[i]); };
            filter(made.results, 0, keep);
            if (is_loop) filter(made.operands, 1, keep);
            for (Block& inner : blocks_of(made)) {
                if (is_loop) filter(inner.parameters, 1, keep);
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
            for (Block& inner : blocks_of(made)) rename(inner, renamed, define);
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
    Dataflow(marker).backwards(function.body);
    return std::move(marker.needed);
}

void remove_dead_code(Function& function)
{
    Remover(function).run();
}

} // namespace haptel::ir
