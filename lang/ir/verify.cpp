#include "lang/ir/verify.h"

#include "lang/abi/abi.h"
#include "lang/ir/cost.h"
#include "lang/ir/int_range.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <bit>

namespace haptel::ir {
namespace {

// Walks one function in execution order; stops at the first problem.
class FunctionCheck {
public:
    FunctionCheck(const Module& whole, const std::vector<IntRange>& of_tables, uint32_t which, const Texture* owner,
                  const std::vector<bool>& entries)
        : module(whole)
        , cells(of_tables)
        , index(which)
        , texture(owner)
        , is_entry(entries)
        , function(whole.functions[which])
        , visible(function.value_types.size(), false)
        , was_defined(function.value_types.size(), false)
        , ranges(function.value_types.size(), {0, 0})
    {
    }

    std::string run()
    {
        if (function.first_argument_size > function.parameters.size())
            fail("the first argument has more parts than there are parameters");
        for (Value parameter : function.parameters) define(parameter);
        if (!function.body.parameters.empty()) fail("a function body has block parameters");
        block(function.body, 0);
        return problem;
    }

private:
    const Module& module;
    const std::vector<IntRange>& cells; // by table
    const uint32_t index;
    const Texture* texture; // whose entry this is; null: of none
    const std::vector<bool>& is_entry;
    const Function& function;
    std::vector<bool> visible, was_defined; // by Value::index
    std::vector<IntRange> ranges;
    std::string problem;

    void fail(std::string what)
    {
        if (problem.empty()) problem = "function \"" + function.name + "\": " + std::move(what);
    }

    void define(Value value) { define(value, full_range_of(value)); }
    void define(Value value, IntRange range)
    {
        if (value.index >= visible.size()) return fail("a value is out of range");
        if (was_defined[value.index]) return fail("a value is defined twice");
        was_defined[value.index] = visible[value.index] = true;
        ranges[value.index] = range;
    }
    IntRange full_range_of(Value value) const
    {
        return value.index < function.value_types.size() ? full_range(function.type(value)) : IntRange{0, 0};
    }

    bool are_visible(const std::vector<Value>& values)
    {
        for (Value value : values)
            if (value.index >= visible.size() || !visible[value.index]) {
                fail("a value is used where it is not defined");
                return false;
            }
        return true;
    }
    bool are_typed(const std::vector<Value>& values) const
    {
        return std::all_of(values.begin(), values.end(),
                           [&](Value value) { return value.index < function.value_types.size(); });
    }
    bool have_types_of(const std::vector<Value>& values, const std::vector<Value>& others, size_t first_other = 0)
    {
        bool fit = values.size() + first_other == others.size() && are_typed(values) && are_typed(others);
        for (size_t i = 0; fit && i < values.size(); ++i)
            fit = function.type(values[i]) == function.type(others[first_other + i]);
        return fit;
    }
    IntRange range(Value value) const { return ranges[value.index]; }

    void block(const Block& source, uint32_t depth)
    {
        if (depth > nesting_max) return fail("blocks nest deeper than " + std::to_string(nesting_max));
        for (const Instruction& made : source.instructions) {
            if (!problem.empty()) return;
            if (!are_visible(made.operands)) return;
            if (!are_typed(made.results)) return fail("a value is out of range");
            std::visit([&](const auto& kind) { check(made, kind, depth); }, made.kind);
        }
        if (!problem.empty() || !are_visible(source.yields)) return;
        if (depth > 0) // what the block made is not seen outside of it
            for (const Instruction& made : source.instructions)
                for (Value result : made.results) visible[result.index] = false;
    }

    bool has_shape(const Instruction& made, size_t operands, size_t results, std::string_view what)
    {
        if (made.operands.size() == operands && made.results.size() == results) return true;
        fail(std::string(what) + " has a wrong number of operands or results");
        return false;
    }
    void result_of_type(const Instruction& made, Type type, std::string_view what, std::optional<IntRange> range = {})
    {
        if (function.type(made.results[0]) != type) return fail(std::string(what) + " has a result of a wrong type");
        define(made.results[0], range.value_or(full_range(type)));
    }

    void check(const Instruction& made, const Operation& operation, uint32_t)
    {
        if (static_cast<size_t>(operation.op) >= all_ops().size()) return fail("unknown operation");
        const OpInfo& info = op_info(operation.op);
        if (!has_shape(made, info.arity, 1, info.name)) return;
        Type types[4];
        IntRange operand_ranges[4];
        for (size_t i = 0; i < made.operands.size(); ++i) {
            types[i] = function.type(made.operands[i]);
            operand_ranges[i] = range(made.operands[i]);
        }
        std::optional<Type> type = result_type(operation.op, {types, info.arity});
        if (!type) return fail("operands of a wrong type for " + std::string(info.name));
        result_of_type(made, *type, info.name, range_of(operation.op, *type, {operand_ranges, info.arity}));
    }
    void check(const Instruction& made, const RealConstant&, uint32_t)
    {
        if (has_shape(made, 0, 1, "a constant")) result_of_type(made, Type::real, "a constant");
    }
    void check(const Instruction& made, const IntConstant& constant, uint32_t)
    {
        if (!has_shape(made, 0, 1, "a constant")) return;
        Type type = function.type(made.results[0]);
        if (type != Type::i32 && type != Type::u32) return fail("a constant has a result of a wrong type");
        int64_t value = type == Type::i32 ? int64_t{static_cast<int32_t>(constant.bits)} : int64_t{constant.bits};
        define(made.results[0], {value, value});
    }
    void check(const Instruction& made, const BoolConstant& constant, uint32_t)
    {
        if (has_shape(made, 0, 1, "a constant"))
            result_of_type(made, Type::boolean, "a constant", IntRange{constant.value, constant.value});
    }
    void check(const Instruction& made, const ReadInput& read, uint32_t)
    {
        if (!texture) return fail("an input is read outside of an entry");
        if (static_cast<uint32_t>(read.input) >= input_count) return fail("unknown input");
        if (has_shape(made, 0, 1, "an input")) result_of_type(made, Type::real, "an input");
    }
    void check(const Instruction& made, const ReadParameter& read, uint32_t)
    {
        if (!texture) return fail("a texture parameter is read outside of an entry");
        if (read.parameter >= texture->parameters.size()) return fail("unknown texture parameter");
        if (has_shape(made, 0, 1, "a parameter"))
            result_of_type(made, texture->parameters[read.parameter].type, "a parameter");
    }
    void check(const Instruction& made, const ReadTable& read, uint32_t)
    {
        if (read.table >= module.tables.size()) return fail("unknown table");
        if (!has_shape(made, 1, 1, "a table cell")) return;
        const Table& table = module.tables[read.table];
        if (function.type(made.operands[0]) != Type::i32) return fail("a table index is not i32");
        if (!range(made.operands[0]).within(0, int64_t{table.size()} - 1))
            return fail("an index of table \"" + table.name + "\" is neither constant nor clamped");
        result_of_type(made, table.element, "a table cell", cells[read.table]);
    }
    void check(const Instruction& made, const Call& call, uint32_t)
    {
        if (call.function >= index) return fail("a call goes forward, or to itself");
        if (is_entry[call.function]) return fail("an entry is called");
        const Function& callee = module.functions[call.function];
        if (!has_shape(made, callee.parameters.size(), callee.body.yields.size(), "a call")) return;
        for (size_t i = 0; i < made.operands.size(); ++i)
            if (function.type(made.operands[i]) != callee.type(callee.parameters[i]))
                return fail("an argument of a wrong type for \"" + callee.name + "\"");
        for (size_t i = 0; i < made.results.size(); ++i) {
            if (function.type(made.results[i]) != callee.type(callee.body.yields[i]))
                return fail("a call has a result of a wrong type");
            define(made.results[i]);
        }
    }
    void check(const Instruction&, const PointDerivative&, uint32_t)
    {
        fail("a derivative with respect to the point was not resolved");
    }
    void check(const Instruction& made, const If& choice, uint32_t depth)
    {
        if (choice.arms.size() != 2) return fail("an if has not two arms");
        if (made.operands.size() != 1 || function.type(made.operands[0]) != Type::boolean)
            return fail("the condition of an if is not one boolean");
        for (const Block& arm : choice.arms) {
            if (!arm.parameters.empty()) return fail("an arm of an if has parameters");
            block(arm, depth + 1);
            if (problem.empty() && !have_types_of(arm.yields, made.results))
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
        if (!have_types_of(made.results, made.operands, 1)) return fail("a loop's results do not fit what it carries");
        if (!have_types_of(made.results, body.parameters, 1) || function.type(body.parameters[0]) != Type::i32)
            return fail("a loop's parameters do not fit what it carries");
        define(body.parameters[0], {0, std::max<int64_t>(int64_t{loop.trip_max} - 1, 0)});
        for (size_t i = 1; i < body.parameters.size(); ++i) define(body.parameters[i]);
        if (!problem.empty()) return;
        block(body, depth + 1);
        if (!problem.empty()) return;
        if (!have_types_of(body.yields, made.results))
            return fail("a loop yields values that do not fit what it carries");
        for (Value parameter : body.parameters) visible[parameter.index] = false;
        for (size_t i = 0; i < made.results.size(); ++i)
            define(made.results[i], join(range(made.operands[i + 1]), range(body.yields[i])));
    }
};

uint32_t deepest_call(const Block& block, const std::vector<uint32_t>& functions)
{
    uint32_t deepest = 0;
    for_each_instruction(block, [&](const Instruction& made) {
        if (auto* call = std::get_if<Call>(&made.kind)) deepest = std::max(deepest, functions[call->function] + 1);
    });
    return deepest;
}

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

std::string check_entry(const Module& module, const Texture& texture, uint32_t index, std::vector<Type> results)
{
    if (index == UINT32_MAX) return "";
    const std::string where = "texture \"" + texture.name + "\": ";
    if (index >= module.functions.size()) return where + "no such entry function";
    const Function& entry = module.functions[index];
    bool fits = entry.parameters.empty() && entry.body.yields.size() == results.size();
    for (size_t i = 0; fits && i < results.size(); ++i) {
        Value yield = entry.body.yields[i];
        fits = yield.index < entry.value_types.size() && entry.type(yield) == results[i];
    }
    return fits ? "" : where + "entry \"" + entry.name + "\" has parameters or wrong results";
}

} // namespace

std::string verify(const Module& module)
{
    std::vector<IntRange> cells;
    for (const Table& table : module.tables) {
        if (std::string problem = check(table); !problem.empty()) return problem;
        cells.push_back(range_of_cells(table));
    }

    const size_t count = module.functions.size();
    std::vector<const Texture*> owners(count, nullptr);
    std::vector<bool> is_entry(count, false);
    for (const Texture& texture : module.textures) {
        if (std::string problem = check_block(texture); !problem.empty()) return problem;
        const Type real = Type::real, faults = Type::u32;
        if (texture.writes & ~(HAPTEL_WRITES_STIFFNESS_SCALE | HAPTEL_WRITES_FRICTION_SCALE))
            return "texture \"" + texture.name + "\" writes outputs that do not exist";
        std::pair<uint32_t, std::vector<Type>> entries[] = {
            {texture.body, {real}},
            {texture.height, {real, faults}},
            {texture.height_gradient, {real, real, real, real, faults}}};
        for (size_t with_outputs : {0, 2})
            entries[with_outputs].second.resize(
                entries[with_outputs].second.size() + static_cast<size_t>(std::popcount(texture.writes)), real);
        entries[2].second.push_back(faults);
        for (const auto& [index, results] : entries) {
            if (std::string problem = check_entry(module, texture, index, results); !problem.empty()) return problem;
            if (index == UINT32_MAX) continue;
            if (is_entry[index] && owners[index] != &texture) return "two textures share an entry function";
            owners[index] = &texture;
            is_entry[index] = true;
        }
    }

    std::vector<uint32_t> call_depth;
    for (uint32_t i = 0; i < count; ++i) {
        std::string problem = FunctionCheck(module, cells, i, owners[i], is_entry).run();
        if (!problem.empty()) return problem;
        call_depth.push_back(deepest_call(module.functions[i].body, call_depth));
        if (call_depth.back() > call_depth_max) return "calls nest deeper than " + std::to_string(call_depth_max);
    }
    const std::vector<uint64_t> cost_of = operations_max(module, std::vector<bool>(count, true));
    for (uint32_t i = 0; i < count; ++i)
        if (is_entry[i] && cost_of[i] > operations_limit)
            return "texture \"" + owners[i]->name + "\" may need " + std::to_string(cost_of[i]) +
                   " operations per call, above " + std::to_string(operations_limit);
    return "";
}

} // namespace haptel::ir
