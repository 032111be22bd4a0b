#include "tests/lang/ir/ir_random.h"

#include "lang/ir/op_info.h"

#include <limits>
#include <random>

namespace ir_test {
namespace {

constexpr double special[] = {0.0,
                              -0.0,
                              1.0,
                              -1.0,
                              2.0,
                              0.5,
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::denorm_min(),
                              std::numeric_limits<double>::max(),
                              1e-200};
constexpr uint32_t special_words[] = {0, 1, 2, 31, 32, 0x7fffffff, 0x80000000, 0xffffffff};

// Bounded, and with bounded slopes: compositions stay moderate.
constexpr Op tame_ops[] = {Op::add,   Op::sub,   Op::mul,     Op::neg,     Op::min,    Op::max,  Op::abs,
                           Op::sin,   Op::cos,   Op::sinturn, Op::costurn, Op::tanh,   Op::atan, Op::asinh,
                           Op::fract, Op::floor, Op::length2, Op::length3, Op::select, Op::lt,   Op::le};

class Generator {
public:
    Generator(uint32_t seed, Flavour kind) : random(seed), flavour(kind) {}

    Module run()
    {
        module.tables.push_back({"R", Type::real, {0.25, -1.5, 0.75, 2}, {}});
        module.tables.push_back({"I", Type::i32, {}, {3, 0xffffffff, 7}});
        const uint32_t count = 1 + below(3);
        for (uint32_t i = 0; i < count; ++i) function("f" + std::to_string(i));
        return std::move(module);
    }

private:
    std::mt19937 random;
    Flavour flavour;
    Module module;
    Function made;
    std::vector<Value> visible;

    uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random() % limit); }
    bool is_tame() const { return flavour == Flavour::tame; }

    Value fresh(Type type)
    {
        made.value_types.push_back(type);
        return {static_cast<uint32_t>(made.value_types.size() - 1)};
    }
    Value add(Block& block, Kind kind, std::vector<Value> operands, Type type)
    {
        Value result = fresh(type);
        block.instructions.push_back({std::move(kind), std::move(operands), {result}, {}});
        visible.push_back(result);
        return result;
    }
    Value constant(Block& block, Type type)
    {
        switch (type) {
        case Type::real:
            return add(block, RealConstant{is_tame() ? 0.125 * below(17) - 1 : special[below(std::size(special))]}, {},
                       type);
        case Type::boolean: return add(block, WordConstant{below(2)}, {}, type);
        case Type::i32:
        case Type::u32: return add(block, WordConstant{special_words[below(std::size(special_words))]}, {}, type);
        case Type::image: break;
        }
        return {};
    }
    Value pick(Block& block, Type type)
    {
        for (int attempt = 0; attempt < 12; ++attempt) {
            // recent values more often, so that expressions grow deep
            auto count = static_cast<uint32_t>(visible.size());
            Value value = visible[count - 1 - below(attempt % 2 ? count : std::min(count, 6u))];
            if (made.type(value) == type) return value;
        }
        return constant(block, type);
    }
    static Type type_of(char letter)
    {
        return letter == 'r' ? Type::real : letter == 'i' ? Type::i32 : letter == 'u' ? Type::u32 : Type::boolean;
    }

    void operation(Block& block)
    {
        const OpInfo& info = is_tame() ? op_info(tame_ops[below(std::size(tame_ops))])
                                       : all_ops()[below(static_cast<uint32_t>(all_ops().size()))];
        if (info.operands[0] == 'm') return; // images have no constants
        Type any = is_tame() ? Type::real : static_cast<Type>(below(4));
        std::vector<Value> operands;
        for (char letter : info.operands) operands.push_back(pick(block, letter == '*' ? any : type_of(letter)));
        add(block, Operation{info.op}, std::move(operands), info.result == '*' ? any : type_of(info.result));
    }

    void table_read(Block& block)
    {
        const auto table = below(2);
        Value zero = add(block, WordConstant{0}, {}, Type::i32);
        Value last = add(block, WordConstant{module.tables[table].size() - 1}, {}, Type::i32);
        Value low = add(block, Operation{Op::imax}, {pick(block, Type::i32), zero}, Type::i32);
        Value index = add(block, Operation{Op::imin}, {low, last}, Type::i32);
        add(block, ReadTable{table}, {index}, module.tables[table].element);
    }

    void call(Block& block)
    {
        if (module.functions.empty()) return;
        const auto which = below(static_cast<uint32_t>(module.functions.size()));
        const Function& callee = module.functions[which];
        Instruction instruction{Call{which}, {}, {}, {}};
        for (Value parameter : callee.parameters) instruction.operands.push_back(pick(block, callee.type(parameter)));
        for (Value result : callee.body.yields) instruction.results.push_back(fresh(callee.type(result)));
        visible.insert(visible.end(), instruction.results.begin(), instruction.results.end());
        block.instructions.push_back(std::move(instruction));
    }

    std::vector<Type> carried_types()
    {
        std::vector<Type> types{Type::real};
        while (below(2)) types.push_back(is_tame() ? Type::real : static_cast<Type>(below(4)));
        return types;
    }

    Block inner(const std::vector<Type>& types, std::vector<Value> parameters, uint32_t depth)
    {
        Block block;
        block.parameters = std::move(parameters);
        const size_t outside = visible.size();
        visible.insert(visible.end(), block.parameters.begin(), block.parameters.end());
        statements(block, 4, depth + 1);
        for (Type type : types) block.yields.push_back(pick(block, type));
        visible.resize(outside);
        return block;
    }

    void choice(Block& block, uint32_t depth)
    {
        std::vector<Type> types = carried_types();
        Instruction instruction{If{}, {pick(block, Type::boolean)}, {}, {}};
        If arms;
        for (int i = 0; i < 2; ++i) arms.arms.push_back(inner(types, {}, depth));
        instruction.kind = std::move(arms);
        for (Type type : types) instruction.results.push_back(fresh(type));
        visible.insert(visible.end(), instruction.results.begin(), instruction.results.end());
        block.instructions.push_back(std::move(instruction));
    }

    void loop(Block& block, uint32_t depth)
    {
        std::vector<Type> types = carried_types();
        const uint32_t most = below(4);
        Value limit = add(block, WordConstant{most}, {}, Type::i32);
        Value trips = add(block, Operation{Op::imin}, {pick(block, Type::i32), limit}, Type::i32);
        Instruction instruction{For{most, {}}, {below(2) ? trips : limit}, {}, {}};
        std::vector<Value> parameters{fresh(Type::i32)};
        for (Type type : types) {
            instruction.operands.push_back(pick(block, type));
            parameters.push_back(fresh(type));
        }
        For body{most, {}};
        body.body.push_back(inner(types, std::move(parameters), depth));
        instruction.kind = std::move(body);
        for (Type type : types) instruction.results.push_back(fresh(type));
        visible.insert(visible.end(), instruction.results.begin(), instruction.results.end());
        block.instructions.push_back(std::move(instruction));
    }

    void statements(Block& block, uint32_t count, uint32_t depth)
    {
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t kind = below(20);
            if (kind == 0 && depth < 3)
                choice(block, depth);
            else if (kind == 1 && depth < 3)
                loop(block, depth);
            else if (kind == 2)
                call(block);
            else if (kind == 3)
                table_read(block);
            else
                operation(block);
        }
    }

    void function(std::string name)
    {
        made = {};
        visible.clear();
        made.name = std::move(name);
        made.first_argument_size = 3;
        for (Type type : {Type::real, Type::real, Type::real, Type::i32, Type::u32, Type::boolean})
            made.parameters.push_back(fresh(type));
        visible = made.parameters;
        statements(made.body, 14, 0);
        std::vector<Type> results{Type::real, Type::real};
        if (!is_tame()) results.push_back(Type::i32);
        for (Type type : results) made.body.yields.push_back(pick(made.body, type));
        module.functions.push_back(std::move(made));
    }
};

} // namespace

Module random_module(uint32_t seed, Flavour flavour)
{
    return Generator(seed, flavour).run();
}

std::vector<Slot<double>> random_arguments(const Function& function, uint32_t seed, Flavour flavour)
{
    std::mt19937 random(seed);
    auto below = [&](size_t limit) { return static_cast<size_t>(random() % limit); };
    std::vector<Slot<double>> arguments;
    for (Value parameter : function.parameters) {
        Slot<double> slot;
        switch (function.type(parameter)) {
        case Type::real:
            slot.real = flavour == Flavour::wild && below(2) ? special[below(std::size(special))]
                                                             : std::uniform_real_distribution(-1.5, 1.5)(random);
            break;
        case Type::i32:
        case Type::u32:
            slot.bits = below(2) ? special_words[below(std::size(special_words))] : static_cast<uint32_t>(below(9));
            break;
        case Type::boolean: slot.bits = static_cast<uint32_t>(below(2)); break;
        case Type::image: break;
        }
        arguments.push_back(slot);
    }
    return arguments;
}

} // namespace ir_test
