#include "lang/ir/builder.h"

#include "lang/ir/dead_code.h"
#include "lang/ir/int_range.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace haptel::ir {
namespace {

uint64_t payload_of(const Kind& kind)
{
    const auto bits = [](const auto& of) -> uint64_t {
        if constexpr (sizeof of == sizeof(uint64_t))
            return std::bit_cast<uint64_t>(of);
        else if constexpr (sizeof of == sizeof(uint32_t))
            return std::bit_cast<uint32_t>(of);
        else if constexpr (sizeof of == sizeof(uint8_t))
            return std::bit_cast<uint8_t>(of);
        else
            return 0; // with blocks: never shared
    };
    return std::visit(bits, kind);
}

} // namespace

size_t Builder::KeyHash::operator()(const Key& key) const
{
    const uint64_t kind = key.kind << 8 | static_cast<uint64_t>(key.type);
    return std::hash<std::u32string>()(key.operands) ^
           ((kind ^ key.payload * 0x9E3779B97F4A7C15u) * 0xBF58476D1CE4E5B9u);
}

Builder::Key Builder::key_of(const Kind& kind, Type type, std::span<const Value> operands)
{
    Key key{kind.index(), type, payload_of(kind), {}};
    for (Value operand : operands) key.operands.push_back(operand.index);
    return key;
}

Value Builder::new_value(Type type, Definition made)
{
    if (!made.range) made.range = full_range(type);
    target.value_types.push_back(type);
    definitions.push_back(made);
    return {static_cast<uint32_t>(definitions.size() - 1)};
}

Value Builder::emit(const Key& key, const Kind& kind, std::span<const Value> operands, std::span<const Type> types,
                    const Definition& made)
{
    const auto [entry, is_new] = known.try_emplace(key, Value{static_cast<uint32_t>(definitions.size())});
    if (!is_new) return entry->second;
    Instruction instruction{kind, {operands.begin(), operands.end()}, {}, span};
    for (Type type : types) instruction.results.push_back(new_value(type, made));
    scopes.back().keys.push_back(&entry->first);
    scopes.back().block.instructions.push_back(std::move(instruction));
    return entry->second;
}

Block Builder::closed(const Arm& arm)
{
    scopes.emplace_back();
    std::vector<Value> yields = arm();
    for (const Key* key : scopes.back().keys) known.erase(known.find(*key));
    Block block = std::move(scopes.back().block);
    scopes.pop_back();
    block.yields = std::move(yields);
    return block;
}

Builder::Builder(Module& whole, std::string name) : module(whole), scopes(1)
{
    target.name = std::move(name);
}

Value Builder::parameter(Type type)
{
    target.parameters.push_back(new_value(type));
    return target.parameters.back();
}

Value Builder::simple(const Kind& kind, std::span<const Value> operands, Type type)
{
    Definition made;
    if (auto* real = std::get_if<RealConstant>(&kind)) {
        made.is_constant = true;
        made.real = real->value;
    } else if (auto* word = std::get_if<WordConstant>(&kind)) {
        made.is_constant = true;
        made.range = constant_range(type, word->bits);
    } else if (auto* read = std::get_if<ReadTable>(&kind)) {
        Table& cells = module.tables[read->table];
        if (!cells.range) cells.range = range_of_cells(cells);
        made.range = cells.range;
    }
    return emit(key_of(kind, type, operands), kind, operands, {&type, 1}, made);
}

Value Builder::operation(Op op, std::span<const Value> operands)
{
    if (std::optional<Value> simpler = fold(op, operands)) return *simpler;

    Type operand_types[4];
    Definition made{.op = op};
    IntRange ranges[4];
    for (size_t i = 0; i < operands.size(); ++i) {
        operand_types[i] = type(operands[i]);
        made.operand[i] = operands[i];
        ranges[i] = range(operands[i]);
    }
    std::optional<Type> result = result_type(op, {operand_types, operands.size()});
    assert(result && "operands do not fit the operation");
    made.range = range_of(op, *result, {ranges, operands.size()});

    Key key = key_of(Operation{op}, *result, operands);
    if (traits(op).commutes) std::ranges::sort(key.operands);
    return emit(key, Operation{op}, operands, {&*result, 1}, made);
}

Value Builder::point_derivative(uint32_t axis, Value of)
{
    return real_constant(of) ? real(0) : simple(PointDerivative{axis}, {&of, 1}, Type::real);
}

std::vector<Value> Builder::call(uint32_t function, std::span<const Value> arguments)
{
    const Function& callee = module.functions[function];
    std::vector<Type> types;
    for (Value result : callee.body.yields) types.push_back(callee.type(result));
    const Kind kind = Call{function};
    std::vector<Value> results;
    const Value first = emit(key_of(kind, {}, arguments), kind, arguments, types, {});
    for (uint32_t i = 0; i < types.size(); ++i) results.push_back({first.index + i});
    return results;
}

std::vector<Value> Builder::if_else(Value condition, const Arm& then_arm, const Arm& else_arm)
{
    if (const auto taken = word_constant(condition)) {
        // The arm that is not taken runs too, as promised, but what it makes is thrown away.
        if (!*taken) closed(then_arm);
        std::vector<Value> yields = *taken ? then_arm() : else_arm();
        if (*taken) closed(else_arm);
        return yields;
    }

    Span place = span;
    Block taken = closed(then_arm), other = closed(else_arm);
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
        if (auto x = word_constant(a), y = word_constant(b); x && x == y)
            agreed = word(*x, type(a));
        else if (x && y && type(a) == Type::boolean)
            agreed = *x ? condition : operation(Op::lnot, {condition});
        if (!agreed) {
            agreed = new_value(type(a), {.range = join(range(a), range(b))});
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
    scopes.back().block.instructions.push_back(std::move(choice));
    return results;
}

std::vector<Value> Builder::for_loop(Value trips, uint32_t trip_max, std::span<const Value> initial, const Body& body)
{
    const auto limit = static_cast<int32_t>(std::min<uint32_t>(trip_max, INT32_MAX));
    trips = operation(Op::imin, {trips, i32(limit)}); // folds where the range is plain
    const int64_t trips_at_most = range(trips).maximum;
    std::vector<Value> unchanged(initial.begin(), initial.end());
    if (word_constant(trips) == 1u) return body(i32(0), unchanged);

    Span place = span;
    const IntRange counter{0, std::max<int64_t>(trips_at_most - 1, 0)};
    std::vector<Value> given;
    Block block = closed([&] {
        given.push_back(new_value(Type::i32, {.range = counter}));
        for (Value value : initial) given.push_back(new_value(type(value)));
        return body(given[0], std::span(given).subspan(1));
    });
    block.parameters = given;
    span = place;
    assert(block.yields.size() == initial.size());
    if (trips_at_most <= 0) return unchanged;

    Instruction loop{For{static_cast<uint32_t>(trips_at_most), {}}, {trips}, {}, span};
    std::vector<Value> results;
    for (size_t i = 0; i < initial.size(); ++i) {
        const Value yield = block.yields[i];
        loop.operands.push_back(initial[i]);
        loop.results.push_back(new_value(type(initial[i]), {.range = join(range(initial[i]), range(yield))}));
        const bool is_invariant = yield == given[i + 1];
        results.push_back(is_invariant ? initial[i] : loop.results.back());
    }
    std::get<For>(loop.kind).body.push_back(std::move(block));
    scopes.back().block.instructions.push_back(std::move(loop));
    return results;
}

Value Builder::clamp_index(Value index, uint32_t size)
{
    index = operation(Op::imax, {index, i32(0)});
    return operation(Op::imin, {index, i32(static_cast<int32_t>(size) - 1)});
}

std::optional<double> Builder::real_constant(Value value) const
{
    if (!definition(value).is_constant || type(value) != Type::real) return std::nullopt;
    return definition(value).real;
}

std::optional<uint32_t> Builder::word_constant(Value value) const
{
    if (!definition(value).is_constant || type(value) == Type::real) return std::nullopt;
    return static_cast<uint32_t>(range(value).minimum);
}

uint32_t Builder::finish(std::span<const Value> results)
{
    target.body = std::move(scopes.back().block);
    target.body.yields.assign(results.begin(), results.end());
    remove_dead_code(target);
    module.functions.push_back(std::move(target));
    return static_cast<uint32_t>(module.functions.size() - 1);
}

} // namespace haptel::ir
