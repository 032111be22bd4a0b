#include "lang/ir/dead_code.h"

#include "lang/ir/dataflow.h"

#include <algorithm>
#include <functional>

namespace haptel::ir {
namespace {

// Of a function that is called, which parameters those of its results are made from.
using ParametersNeeded = std::function<std::vector<bool>(uint32_t function, const std::vector<bool>& results)>;

struct Marker {
    std::vector<bool> needed;                            // by Value::index
    const ParametersNeeded* parameters_needed = nullptr; // null: a call needs all of its operands

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
};

template <typename Keep>
void filter(std::vector<Value>& values, size_t first, const Keep& keep)
{
    size_t kept = first;
    for (size_t i = first; i < values.size(); ++i)
        if (keep(i - first)) values[kept++] = values[i];
    values.resize(kept);
}

// What is needed, with dense numbers: every use follows its definition, so that one walk renames both.
class Remover {
public:
    Remover(Function& whole, const Marker& needed) : function(whole), marker(needed), renamed(whole.value_types.size())
    {
        define(function.parameters);
        block(function.body);
        function.value_types = std::move(types);
    }

private:
    Function& function;
    const Marker& marker;
    std::vector<Value> renamed; // by Value::index
    std::vector<Type> types;

    void define(std::vector<Value>& values)
    {
        for (Value& value : values) {
            types.push_back(function.type(value));
            renamed[value.index] = {static_cast<uint32_t>(types.size() - 1)};
            value = renamed[value.index];
        }
    }
    void use(std::vector<Value>& values)
    {
        for (Value& value : values) value = renamed[value.index];
    }

    void block(Block& source)
    {
        define(source.parameters);
        std::erase_if(source.instructions, [&](const Instruction& made) { return !marker.is_needed(made); });
        for (Instruction& made : source.instructions) {
            if (!blocks_of(made).empty()) remove_results(made);
            use(made.operands);
            define(made.results);
            for (Block& inner : blocks_of(made)) block(inner);
        }
        use(source.yields);
    }

    void remove_results(Instruction& made)
    {
        const bool is_loop = std::holds_alternative<For>(made.kind);
        const std::vector<Value> results = made.results;
        const auto keep = [&](size_t i) { return marker.is_needed(results[i]); };
        filter(made.results, 0, keep);
        if (is_loop) filter(made.operands, 1, keep);
        for (Block& inner : blocks_of(made)) {
            if (is_loop) filter(inner.parameters, 1, keep);
            filter(inner.yields, 0, keep);
        }
    }
};

} // namespace

const std::vector<bool>& NeededValues::of(uint32_t function, const std::vector<bool>& results)
{
    std::pair key{function, results};
    if (const auto found = known.find(key); found != known.end()) return found->second;
    const ParametersNeeded parameters = [&](uint32_t callee, const std::vector<bool>& of_call) {
        const std::vector<bool>& inside = of(callee, of_call);
        std::vector<bool> needed;
        for (Value parameter : module.functions[callee].parameters) needed.push_back(inside[parameter.index]);
        return needed;
    };
    const Function& source = module.functions[function];
    Marker marker{std::vector<bool>(source.value_types.size()), &parameters};
    for (size_t i = 0; i < results.size(); ++i)
        if (results[i]) marker.need(source.body.yields[i]);
    Dataflow(marker).backwards(source.body);
    return known.emplace(std::move(key), std::move(marker.needed)).first->second;
}

void remove_dead_code(Function& function)
{
    Marker marker{std::vector<bool>(function.value_types.size())};
    for (Value result : function.body.yields) marker.need(result);
    Dataflow(marker).backwards(function.body);
    Remover(function, marker);
}

} // namespace haptel::ir
