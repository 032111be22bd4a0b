#include "tests/jit/codegen/random_program.h"

#include "lang/abi/abi.h"
#include "lang/ir/builder.h"
#include "lang/ir/op_info.h"

#include <random>

namespace haptel::test {

namespace {

using ir::Type;
using ir::Value;

class Writer {
public:
    Writer(ir::Module& to, std::mt19937_64& source, std::string name) : module(to), random(source), builder(to, name) {}

    uint32_t function()
    {
        for (Type type : {Type::real, Type::real, Type::i32}) put(builder.parameter(type));
        statements(12, 0);
        const Value results[] = {pick(Type::real), pick(Type::real)};
        return builder.finish(results);
    }

    uint32_t entry()
    {
        for (ir::Input input : {ir::Input::p_x, ir::Input::p_y, ir::Input::p_z, ir::Input::n_x})
            put(builder.input(input));
        statements(30, 0);
        const Value results[] = {pick(Type::real), pick(Type::u32)};
        return builder.finish(results);
    }

private:
    ir::Module& module;
    std::mt19937_64& random;
    ir::Builder builder;
    std::vector<Value> scope;

    uint64_t below(uint64_t limit) { return random() % limit; }
    void put(Value value) { scope.push_back(value); }

    // A value of the type in scope, the newest more often; a constant if there is none.
    Value pick(Type type)
    {
        for (int attempt = 0; attempt < 40 && !scope.empty(); ++attempt) {
            const size_t back = std::min(below(scope.size()), below(scope.size()));
            const Value value = scope[scope.size() - 1 - back];
            if (builder.type(value) == type) return value;
        }
        switch (type) {
        case Type::real: return builder.real(std::uniform_real_distribution<double>(-4, 4)(random));
        case Type::i32: return builder.i32(static_cast<int32_t>(below(64)) - 16);
        case Type::u32: return builder.u32(static_cast<uint32_t>(below(1000)));
        case Type::boolean: return builder.boolean(below(2) == 0);
        case Type::image: break;
        }
        return {};
    }

    Type any_type() { return static_cast<Type>(below(4)); }

    void statements(int count, int depth)
    {
        for (int i = 0; i < count; ++i) {
            const uint64_t choice = below(20);
            if (choice == 0 && depth < 3)
                branch(depth);
            else if (choice == 1 && depth < 2)
                loop(depth);
            else if (choice == 2 && !module.functions.empty())
                call();
            else if (choice == 3)
                put(builder.table(static_cast<uint32_t>(below(2)), builder.clamp_index(pick(Type::i32), 7)));
            else
                operation();
        }
    }

    void operation()
    {
        const ir::OpInfo& op = ir::all_ops()[below(ir::all_ops().size())];
        if (op.operands[0] == 'm') return; // images have no constants
        const Type any = any_type();
        std::vector<Value> operands;
        for (char letter : op.operands)
            operands.push_back(pick(letter == 'r'   ? Type::real
                                    : letter == 'i' ? Type::i32
                                    : letter == 'u' ? Type::u32
                                    : letter == 'b' ? Type::boolean
                                                    : any));
        put(builder.operation(op.op, operands));
    }

    std::vector<Value> yields(const std::vector<Type>& types)
    {
        std::vector<Value> values;
        for (Type type : types) values.push_back(pick(type));
        return values;
    }

    std::vector<Value> block(int statement_count, int depth, const std::vector<Type>& types)
    {
        const size_t outer = scope.size();
        statements(statement_count, depth);
        std::vector<Value> values = yields(types);
        scope.resize(outer);
        return values;
    }

    void branch(int depth)
    {
        const std::vector<Type> types = {any_type(), Type::real};
        const auto arm = [&] { return block(6, depth + 1, types); };
        for (Value result : builder.if_else(pick(Type::boolean), arm, arm)) put(result);
    }

    void loop(int depth)
    {
        const std::vector<Type> types = {Type::real, any_type(), Type::real};
        const std::vector<Value> initial = yields(types);
        const Value trips = builder.operation(ir::Op::imin, {pick(Type::i32), builder.i32(5)});
        const size_t outer = scope.size();
        const auto results = builder.for_loop(trips, 5, initial, [&](Value iteration, std::span<const Value> carried) {
            put(iteration);
            for (Value value : carried) put(value);
            std::vector<Value> next = block(6, depth + 1, types);
            scope.resize(outer);
            return next;
        });
        for (Value result : results) put(result);
    }

    void call()
    {
        const Value arguments[] = {pick(Type::real), pick(Type::real), pick(Type::i32)};
        const auto callee = static_cast<uint32_t>(below(module.functions.size()));
        for (Value result : builder.call(callee, arguments)) put(result);
    }
};

} // namespace

ir::Module random_program(uint64_t seed)
{
    std::mt19937_64 random(seed);
    ir::Module module;
    ir::Table reals{"reals", Type::real, {0.5, -1, 2, 1e-3, -0.0, 7, 3}, {}};
    ir::Table words{"words", Type::i32, {}, {1, 2, 0xffffffffu, 4, 0x80000000u, 6, 100}};
    module.tables = {reals, words};
    for (int i = 0; i < 3; ++i) Writer(module, random, "function " + std::to_string(i)).function();
    ir::Texture texture;
    texture.name = "random";
    texture.block_size = sizeof(haptel_block_head);
    texture.height = Writer(module, random, "entry").entry();
    module.textures.push_back(texture);
    return module;
}

} // namespace haptel::test
