#include "lang/ir/builder.h"

#include "lang/ir/builder_state.h"
#include "lang/ir/dead_code.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace haptel::ir {
namespace {

enum KeyKind : uint32_t {
    operation,
    real,
    integer,
    boolean_,
    input_,
    parameter_,
    table_,
    call_,
    point_derivative_,
    link
};

InstructionKey key_of(KeyKind kind, uint64_t payload, std::span<const Value> operands)
{
    InstructionKey key{kind, payload};
    for (size_t i = 0; i < operands.size(); ++i) key.operand[i] = operands[i].index;
    return key;
}

} // namespace

size_t InstructionKeyHash::operator()(const InstructionKey& key) const
{
    uint64_t hash = key.kind ^ key.payload * 0x9E3779B97F4A7C15u;
    for (uint32_t word : key.operand) hash = (hash ^ word) * 0xBF58476D1CE4E5B9u, hash ^= hash >> 31;
    return static_cast<size_t>(hash);
}

Value Builder::State::new_value(Type type, const Definition& made)
{
    function.value_types.push_back(type);
    definitions.push_back(made);
    return {static_cast<uint32_t>(definitions.size() - 1)};
}

Value Builder::State::new_value(Type type)
{
    return new_value(type, {.range = full_range(type)});
}

Value Builder::State::emit(const InstructionKey& key, Instruction instruction, std::span<const Type> types,
                           const Definition* made)
{
    auto [entry, is_new] = known.try_emplace(key, static_cast<uint32_t>(definitions.size()));
    if (!is_new) return {entry->second};
    for (Type type : types) instruction.results.push_back(made ? new_value(type, *made) : new_value(type));
    scopes.back().keys.push_back(&entry->first);
    append(std::move(instruction));
    return {entry->second};
}

Value Builder::State::single(const InstructionKey& key, Kind kind, std::span<const Value> operands, Span span,
                             Type type, const Definition* made)
{
    return emit(key, {std::move(kind), {operands.begin(), operands.end()}, {}, span}, {&type, 1}, made);
}

uint32_t Builder::State::list(std::span<const Value> values)
{
    uint32_t number = 0;
    for (Value value : values) {
        auto [entry, is_new] = known.try_emplace(key_of(KeyKind::link, number, {&value, 1}), lists + 1);
        if (is_new) {
            ++lists;
            scopes.back().keys.push_back(&entry->first);
        }
        number = entry->second;
    }
    return number;
}

void Builder::State::append(Instruction instruction)
{
    scopes.back().block.instructions.push_back(std::move(instruction));
}

void Builder::State::open()
{
    scopes.emplace_back();
}

Block Builder::State::close()
{
    for (const InstructionKey* key : scopes.back().keys) known.erase(known.find(*key));
    Block block = std::move(scopes.back().block);
    scopes.pop_back();
    return block;
}

bool Builder::State::is_operation(Value value, Op op) const
{
    return definition(value).kind == Definition::Kind::operation && definition(value).op == op;
}

bool Builder::State::is_constant(Value value) const
{
    Definition::Kind kind = definition(value).kind;
    return kind == Definition::Kind::real || kind == Definition::Kind::integer || kind == Definition::Kind::boolean;
}

Builder::Builder(Module& module, std::string name) : span{}, state(new State{module, {}, {}, {}, {}})
{
    state->function.name = std::move(name);
    state->open();
}

Builder::~Builder() = default;

Value Builder::parameter(Type type)
{
    Value value = state->new_value(type);
    state->function.parameters.push_back(value);
    return value;
}

Value Builder::real(double value)
{
    const Definition made{.kind = Definition::Kind::real, .real = value};
    return state->single(key_of(KeyKind::real, std::bit_cast<uint64_t>(value), {}), RealConstant{value}, {}, span,
                         Type::real, &made);
}

Value Builder::i32(int32_t value)
{
    const Definition made{.kind = Definition::Kind::integer, .range = {value, value}};
    const auto bits = static_cast<uint32_t>(value);
    return state->single(key_of(KeyKind::integer, bits, {}), IntConstant{bits}, {}, span, Type::i32, &made);
}

Value Builder::u32(uint32_t value)
{
    const Definition made{.kind = Definition::Kind::integer, .range = {value, value}};
    const uint64_t apart = uint64_t{1} << 32; // from the i32 of the same bits
    return state->single(key_of(KeyKind::integer, value | apart, {}), IntConstant{value}, {}, span, Type::u32, &made);
}

Value Builder::boolean(bool value)
{
    const Definition made{.kind = Definition::Kind::boolean, .range = {value, value}};
    return state->single(key_of(KeyKind::boolean_, value, {}), BoolConstant{value}, {}, span, Type::boolean, &made);
}

Value Builder::input(Input input)
{
    return state->single(key_of(KeyKind::input_, static_cast<uint32_t>(input), {}), ReadInput{input}, {}, span,
                         Type::real);
}

Value Builder::texture_parameter(uint32_t index, Type type)
{
    return state->single(key_of(KeyKind::parameter_, index, {}), ReadParameter{index}, {}, span, type);
}

Value Builder::table(uint32_t table, Value index)
{
    Table& cells = state->module.tables[table];
    if (!cells.range) cells.range = range_of_cells(cells);
    const Definition made{.range = *cells.range};
    return state->single(key_of(KeyKind::table_, table, {&index, 1}), ReadTable{table}, {&index, 1}, span,
                         cells.element, &made);
}

Value Builder::operation(Op op, std::span<const Value> operands)
{
    if (std::optional<Value> simpler = state->fold(*this, op, operands)) return *simpler;

    Type operand_types[4];
    Definition made;
    made.kind = Definition::Kind::operation;
    made.op = op;
    IntRange ranges[4];
    for (size_t i = 0; i < operands.size(); ++i) {
        operand_types[i] = type(operands[i]);
        made.operand[i] = operands[i];
        ranges[i] = state->definition(operands[i]).range;
    }
    std::optional<Type> result = result_type(op, {operand_types, operands.size()});
    assert(result && "operands do not fit the operation");
    made.range = range_of(op, *result, {ranges, operands.size()});

    Value ordered[4];
    std::copy(operands.begin(), operands.end(), ordered);
    if (traits(op).commutes && ordered[1].index < ordered[0].index) std::swap(ordered[0], ordered[1]);
    return state->single(key_of(KeyKind::operation, static_cast<uint32_t>(op), {ordered, operands.size()}),
                         Operation{op}, operands, span, *result, &made);
}

Value Builder::operation(Op op, std::initializer_list<Value> operands)
{
    return operation(op, std::span<const Value>(operands.begin(), operands.size()));
}

Value Builder::point_derivative(uint32_t axis, Value of)
{
    if (real_constant(of)) return real(0);
    return state->single(key_of(KeyKind::point_derivative_, axis, {&of, 1}), PointDerivative{axis}, {&of, 1}, span,
                         Type::real);
}

std::vector<Value> Builder::call(uint32_t function, std::span<const Value> arguments)
{
    const Function& callee = state->module.functions[function];
    std::vector<Type> types;
    for (Value result : callee.body.yields) types.push_back(callee.type(result));
    const Value list{state->list(arguments)};
    const Value first = state->emit(key_of(KeyKind::call_, function, {&list, 1}),
                                    {ir::Call{function}, {arguments.begin(), arguments.end()}, {}, span}, types);
    std::vector<Value> results;
    for (uint32_t i = 0; i < types.size(); ++i) results.push_back({first.index + i});
    return results;
}

std::vector<Value> Builder::if_else(Value condition, const Arm& then_arm, const Arm& else_arm)
{
    if (std::optional<bool> known = bool_constant(condition)) {
        // The arm that is not taken runs too, as promised, but what it makes is thrown away.
        auto dropped = [&](const Arm& arm) {
            state->open();
            arm();
            state->close();
        };
        if (!*known) dropped(then_arm);
        std::vector<Value> taken = *known ? then_arm() : else_arm();
        if (*known) dropped(else_arm);
        return taken;
    }

    auto run = [&](const Arm& arm) {
        state->open();
        std::vector<Value> yields = arm();
        Block block = state->close();
        block.yields = std::move(yields);
        return block;
    };
    Span place = span;
    Block taken = run(then_arm), other = run(else_arm);
    span = place;
    assert(taken.yields.size() == other.yields.size());

    // What both arms agree on needs no choice.
    std::vector<Value> results;
    Instruction choice{If{}, {condition}, {}, span};
    size_t kept = 0;
    for (size_t i = 0; i < taken.yields.size(); ++i) {
        Value a = taken.yields[i], b = other.yields[i];
        std::optional<Value> agreed;
        if (a == b) agreed = a;
        if (auto x = real_constant(a), y = real_constant(b);
            x && y && std::bit_cast<uint64_t>(*x) == std::bit_cast<uint64_t>(*y))
            agreed = real(*x);
        if (auto x = int_constant(a), y = int_constant(b); x && x == y)
            agreed = type(a) == Type::i32 ? i32(static_cast<int32_t>(*x)) : u32(*x);
        if (auto x = bool_constant(a), y = bool_constant(b); x && y)
            agreed = x == y ? boolean(*x) : *x ? condition : operation(Op::lnot, {condition});
        if (!agreed) {
            Definition made;
            made.range = join(state->definition(a).range, state->definition(b).range);
            agreed = state->new_value(type(a), made);
            choice.results.push_back(*agreed);
            taken.yields[kept] = a;
            other.yields[kept] = b;
            ++kept;
        }
        results.push_back(*agreed);
    }
    if (kept == 0) return results;
    taken.yields.resize(kept);
    other.yields.resize(kept);
    std::vector<Block>& arms = std::get<If>(choice.kind).arms;
    arms.push_back(std::move(taken));
    arms.push_back(std::move(other));
    state->append(std::move(choice));
    return results;
}

std::vector<Value> Builder::for_loop(Value trips, uint32_t trip_max, std::span<const Value> initial, const Body& body)
{
    const auto limit = static_cast<int32_t>(std::min<uint32_t>(trip_max, INT32_MAX));
    trips = operation(Op::imin, {trips, i32(limit)}); // folds where the range is plain
    const int64_t trips_at_most = state->definition(trips).range.maximum;
    std::vector<Value> unchanged(initial.begin(), initial.end());
    if (int_constant(trips) == 1u) return body(i32(0), unchanged);

    Span place = span;
    state->open();
    std::vector<Value>& parameters = state->scopes.back().block.parameters;
    Definition counter;
    counter.range = {0, std::max<int64_t>(trips_at_most - 1, 0)};
    parameters.push_back(state->new_value(Type::i32, counter));
    for (Value value : initial) parameters.push_back(state->new_value(type(value)));
    const std::vector<Value> given = parameters; // nested scopes may move the original
    std::vector<Value> yields = body(given[0], std::span(given).subspan(1));
    Block block = state->close();
    span = place;
    assert(yields.size() == initial.size());
    if (trips_at_most <= 0) return unchanged;

    Instruction loop{For{static_cast<uint32_t>(trips_at_most), {}}, {trips}, {}, span};
    std::vector<Value> results;
    for (size_t i = 0; i < initial.size(); ++i) {
        Definition made;
        made.range = join(state->definition(initial[i]).range, state->definition(yields[i]).range);
        loop.operands.push_back(initial[i]);
        loop.results.push_back(state->new_value(type(initial[i]), made));
        bool is_invariant = yields[i] == given[i + 1];
        results.push_back(is_invariant ? initial[i] : loop.results.back());
    }
    block.yields = std::move(yields);
    std::get<For>(loop.kind).body.push_back(std::move(block));
    state->append(std::move(loop));
    return results;
}

Value Builder::clamp_index(Value index, uint32_t size)
{
    index = operation(Op::imax, {index, i32(0)});
    return operation(Op::imin, {index, i32(static_cast<int32_t>(size) - 1)});
}

std::optional<double> Builder::real_constant(Value value) const
{
    const Definition& made = state->definition(value);
    if (made.kind != Definition::Kind::real) return std::nullopt;
    return made.real;
}

std::optional<uint32_t> Builder::int_constant(Value value) const
{
    const Definition& made = state->definition(value);
    if (made.kind != Definition::Kind::integer) return std::nullopt;
    return static_cast<uint32_t>(made.range.minimum);
}

std::optional<bool> Builder::bool_constant(Value value) const
{
    const Definition& made = state->definition(value);
    if (made.kind != Definition::Kind::boolean) return std::nullopt;
    return made.range.minimum != 0;
}

Type Builder::type(Value value) const
{
    return state->function.value_types[value.index];
}

uint32_t Builder::finish(std::span<const Value> results)
{
    state->function.body = std::move(state->scopes.back().block);
    state->function.body.yields.assign(results.begin(), results.end());
    remove_dead_code(state->function);
    state->module.functions.push_back(std::move(state->function));
    return static_cast<uint32_t>(state->module.functions.size() - 1);
}

Function& Builder::function()
{
    return state->function;
}

} // namespace haptel::ir
