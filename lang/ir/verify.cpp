#include "lang/ir/verify.h"

#include "lang/abi/outputs.h"
#include "lang/ir/cost.h"
#include "lang/ir/int_range.h"
#include "lang/ir/op_info.h"

#include <algorithm>

namespace haptel::ir {
namespace {

// What the check of a function needs to know of the rest of its module.
struct Surroundings {
    const Module& module;
    std::vector<IntRange> cells;        // by table
    std::vector<const Texture*> owners; // by function: whose entry it is; null: of none
    std::vector<uint32_t> depths;       // of the functions checked so far: blocks and calls inside each other
};

// Walks one function in execution order; stops at the first problem.
class FunctionCheck {
public:
    FunctionCheck(const Surroundings& around, uint32_t which)
        : known(around)
        , index(which)
        , texture(around.owners[which])
        , function(around.module.functions[which])
        , visible(function.value_types.size(), false)
        , was_defined(function.value_types.size(), false)
        , ranges(function.value_types.size(), {0, 0})
    {
        if (function.first_argument_size > function.parameters.size())
            fail("the first argument has more parts than there are parameters");
        for (Value parameter : function.parameters) define(parameter);
        if (!function.body.parameters.empty()) fail("a function body has block parameters");
        block(function.body, 0);
    }

    std::string problem;
    uint32_t deepest = 0; // blocks and calls inside each other

private:
    const Surroundings& known;
    const uint32_t index;
    const Texture* const texture; // whose entry this is; null: of none
    const Function& function;
    std::vector<bool> visible, was_defined; // by Value::index
    std::vector<IntRange> ranges;

    void fail(std::string what)
    {
        if (problem.empty()) problem = "function \"" + function.name + "\": " + std::move(what);
    }

    void define(Value value, std::optional<IntRange> range = {})
    {
        if (value.index >= visible.size()) return fail("a value is out of range");
        if (was_defined[value.index]) return fail("a value is defined twice");
        was_defined[value.index] = visible[value.index] = true;
        ranges[value.index] = range.value_or(full_range(function.type(value)));
    }
    IntRange range(Value value) const { return ranges[value.index]; }

    bool are_visible(const std::vector<Value>& values)
    {
        const auto is_visible = [&](Value value) { return value.index < visible.size() && visible[value.index]; };
        const bool all = std::ranges::all_of(values, is_visible);
        if (!all) fail("a value is used where it is not defined");
        return all;
    }
    bool have_types(std::span<const Value> values, std::span<const Type> types) const
    {
        return std::ranges::equal(values, types, {}, [&](Value value) { return function.type(value); });
    }
    bool have_types_of(std::span<const Value> values, std::span<const Value> others, const Function& of) const
    {
        return std::ranges::equal(
            values, others, {}, [&](Value value) { return function.type(value); },
            [&](Value other) { return of.type(other); });
    }

    void descend(uint32_t depth)
    {
        deepest = std::max(deepest, depth);
        if (depth > nesting_max) fail("blocks and calls nest deeper than " + std::to_string(nesting_max));
    }

    void block(const Block& source, uint32_t depth)
    {
        descend(depth);
        for (const Instruction& made : source.instructions) {
            if (!problem.empty() || !are_visible(made.operands)) return;
            for (Value result : made.results)
                if (result.index >= visible.size()) return fail("a value is out of range");
            std::visit([&](const auto& kind) { check(made, kind, depth); }, made.kind);
        }
        if (!problem.empty() || !are_visible(source.yields)) return;
        if (depth > 0) // what the block made is not seen outside of it
            for (const Instruction& made : source.instructions)
                for (Value result : made.results) visible[result.index] = false;
    }

    // An instruction with that one result.
    void simple(const Instruction& made, std::string_view what, std::span<const Type> operands, Type result,
                std::optional<IntRange> range = {})
    {
        if (!have_types(made.operands, operands) || !have_types(made.results, {&result, 1}))
            return fail(std::string(what) + " has operands or results of a wrong type or number");
        define(made.results[0], range);
    }

    void check(const Instruction& made, const Operation& operation, uint32_t)
    {
        if (static_cast<size_t>(operation.op) >= all_ops().size()) return fail("unknown operation");
        const OpInfo& info = op_info(operation.op);
        Type types[4];
        IntRange operand_ranges[4];
        const size_t count = std::min<size_t>(made.operands.size(), info.arity);
        for (size_t i = 0; i < count; ++i) {
            types[i] = function.type(made.operands[i]);
            operand_ranges[i] = range(made.operands[i]);
        }
        const std::optional<Type> type = result_type(operation.op, {types, count});
        if (!type) return fail("operands of a wrong type or number for " + std::string(info.name));
        simple(made, info.name, {types, count}, *type, range_of(operation.op, *type, {operand_ranges, count}));
    }
    void check(const Instruction& made, const RealConstant&, uint32_t) { simple(made, "a constant", {}, Type::real); }
    void check(const Instruction& made, const WordConstant& constant, uint32_t)
    {
        const Type type = made.results.size() == 1 ? function.type(made.results[0]) : Type::real;
        const IntRange value = constant_range(type, constant.bits), full = full_range(type);
        if (type == Type::real || type == Type::image || !value.within(full.minimum, full.maximum))
            return fail("a constant is none of its type");
        simple(made, "a constant", {}, type, value);
    }
    void check(const Instruction& made, const ReadInput& read, uint32_t)
    {
        if (!texture) return fail("an input is read outside of an entry");
        if (static_cast<uint32_t>(read.input) >= input_count) return fail("unknown input");
        simple(made, "an input", {}, Type::real);
    }
    void check(const Instruction& made, const ReadParameter& read, uint32_t)
    {
        if (!texture) return fail("a texture parameter is read outside of an entry");
        if (read.parameter >= texture->parameters.size()) return fail("unknown texture parameter");
        simple(made, "a parameter", {}, texture->parameters[read.parameter].type);
    }
    void check(const Instruction& made, const ReadTable& read, uint32_t)
    {
        if (read.table >= known.module.tables.size()) return fail("unknown table");
        const Table& table = known.module.tables[read.table];
        constexpr Type index_type[] = {Type::i32};
        simple(made, "a table cell", index_type, table.element, known.cells[read.table]);
        if (problem.empty() && !range(made.operands[0]).within(0, int64_t{table.size()} - 1))
            fail("an index of table \"" + table.name + "\" is neither constant nor clamped");
    }
    void check(const Instruction& made, const Call& call, uint32_t depth)
    {
        if (call.function >= index) return fail("a call goes forward, or to itself");
        if (known.owners[call.function]) return fail("an entry is called");
        const Function& callee = known.module.functions[call.function];
        if (!have_types_of(made.operands, callee.parameters, callee) ||
            !have_types_of(made.results, callee.body.yields, callee))
            return fail("arguments or results of a wrong type or number for \"" + callee.name + "\"");
        for (Value result : made.results) define(result);
        descend(depth + 1 + known.depths[call.function]);
    }
    void check(const Instruction&, const PointDerivative&, uint32_t)
    {
        fail("a derivative with respect to the point was not resolved");
    }
    void check(const Instruction& made, const If& choice, uint32_t depth)
    {
        constexpr Type condition[] = {Type::boolean};
        if (choice.arms.size() != 2) return fail("an if has not two arms");
        if (!have_types(made.operands, condition)) return fail("the condition of an if is not one boolean");
        for (const Block& arm : choice.arms) {
            if (!arm.parameters.empty()) return fail("an arm of an if has parameters");
            block(arm, depth + 1);
            if (problem.empty() && !have_types_of(arm.yields, made.results, function))
                fail("an arm of an if yields values that do not fit its results");
            if (!problem.empty()) return;
        }
        for (size_t i = 0; i < made.results.size(); ++i)
            define(made.results[i], join(range(choice.arms[0].yields[i]), range(choice.arms[1].yields[i])));
    }
    void check(const Instruction& made, const For& loop, uint32_t depth)
    {
        if (loop.body.size() != 1) return fail("a loop has not one body");
        const Block& body = loop.body[0];
        if (made.operands.empty() || function.type(made.operands[0]) != Type::i32)
            return fail("the trip count of a loop is not i32");
        if (range(made.operands[0]).maximum > int64_t{loop.trip_max})
            return fail("a trip count may exceed its bound " + std::to_string(loop.trip_max));
        for (Value parameter : body.parameters) define(parameter);
        if (!problem.empty()) return;
        if (!have_types_of(made.operands, body.parameters, function)) // the count's type is that of the iteration
            return fail("a loop's parameters do not fit what it carries");
        ranges[body.parameters[0].index] = {0, std::max<int64_t>(int64_t{loop.trip_max} - 1, 0)};
        block(body, depth + 1);
        if (!problem.empty()) return;
        const auto initial = std::span(made.operands).subspan(1);
        if (!have_types_of(body.yields, initial, function) || !have_types_of(made.results, initial, function))
            return fail("a loop yields values, or has results, that do not fit what it carries");
        for (Value parameter : body.parameters) visible[parameter.index] = false;
        for (size_t i = 0; i < made.results.size(); ++i)
            define(made.results[i], join(range(initial[i]), range(body.yields[i])));
    }
};

std::string check(const Table& table)
{
    const bool is_real = table.element == Type::real;
    if (table.element == Type::boolean || (is_real ? table.reals.empty() : table.words.empty()) ||
        !(is_real ? table.words.empty() : table.reals.empty()) || table.size() > INT32_MAX)
        return "table \"" + table.name + "\" has no cells or cells of a wrong kind";
    return "";
}

// The block is the caller's memory: what an entry reads there must lie inside, where the parameter's type lies.
std::string check_block(const Texture& texture)
{
    for (const Parameter& parameter : texture.parameters) {
        const uint32_t size = parameter.type == Type::real ? 8 : 4;
        if (parameter.offset < sizeof(haptel_block_head) || parameter.offset % size != 0 ||
            uint64_t{parameter.offset} + size > texture.block_size)
            return "texture \"" + texture.name + "\": parameter \"" + parameter.name + "\" lies outside of the block";
    }
    return "";
}

std::string check_entry(const Module& module, const Texture& texture, uint32_t index, const std::vector<Type>& results)
{
    const std::string where = "texture \"" + texture.name + "\": ";
    if (index >= module.functions.size()) return where + "no such entry function";
    const Function& entry = module.functions[index];
    const auto yields = [&](Value value, Type type) {
        return value.index < entry.value_types.size() && entry.type(value) == type;
    };
    const bool fits = entry.parameters.empty() && std::ranges::equal(entry.body.yields, results, yields);
    return fits ? "" : where + "entry \"" + entry.name + "\" has parameters or wrong results";
}

} // namespace

std::string verify(const Module& module)
{
    const auto count = static_cast<uint32_t>(module.functions.size());
    Surroundings known{module, {}, std::vector<const Texture*>(count, nullptr), {}};
    for (const Table& table : module.tables) {
        if (std::string problem = check(table); !problem.empty()) return problem;
        known.cells.push_back(range_of_cells(table));
    }

    for (const Texture& texture : module.textures) {
        if (std::string problem = check_block(texture); !problem.empty()) return problem;
        if (texture.writes & ~all_outputs) return "texture \"" + texture.name + "\" writes outputs that do not exist";
        const Type real = Type::real, faults = Type::u32;
        std::vector<Type> body{real}, gradient{real, real, real, real, faults};
        body.resize(body.size() + output_components(texture.writes), real);
        gradient.insert(gradient.end(), body.begin() + 1, body.end());
        gradient.push_back(faults);
        const std::pair<uint32_t, std::vector<Type>> entries[] = {
            {texture.body, body}, {texture.height, {real, faults}}, {texture.height_gradient, gradient}};
        for (const auto& [index, results] : entries) {
            if (index == UINT32_MAX) continue;
            if (std::string problem = check_entry(module, texture, index, results); !problem.empty()) return problem;
            if (known.owners[index] && known.owners[index] != &texture) return "two textures share an entry function";
            known.owners[index] = &texture;
        }
    }

    for (uint32_t i = 0; i < count; ++i) {
        FunctionCheck check(known, i);
        if (!check.problem.empty()) return check.problem;
        known.depths.push_back(check.deepest);
    }
    const std::vector<uint64_t> cost_of = operations_max(module, std::vector<bool>(count, true));
    for (uint32_t i = 0; i < count; ++i)
        if (known.owners[i] && cost_of[i] > operations_limit)
            return "texture \"" + known.owners[i]->name + "\" may need " + std::to_string(cost_of[i]) +
                   " operations per call, above " + std::to_string(operations_limit);
    return "";
}

} // namespace haptel::ir
