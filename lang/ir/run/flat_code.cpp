#include "lang/ir/run/flat_code.h"

#include <algorithm>
#include <limits>

namespace haptel::ir {
namespace {

using Kind = FlatStep::Kind;

class Flattener {
public:
    Flattener(const Module& whole, const std::vector<FlatFunction>& earlier, const Function& source)
        : module(whole), done(earlier), function(source)
    {
    }

    FlatFunction run()
    {
        flat.slots = static_cast<uint32_t>(function.value_types.size());
        block(function.body);
        step({Kind::finish, {}, 0, {0, list(function.body.yields), 0, 0}});
        flat.depth = flat.slots + deepest_callee;
        flat.calls = longest_chain;
        return std::move(flat);
    }

private:
    const Module& module;
    const std::vector<FlatFunction>& done;
    const Function& function;
    FlatFunction flat;
    uint32_t deepest_callee = 0, longest_chain = 0;

    uint32_t here() const { return static_cast<uint32_t>(flat.steps.size()); }

    uint32_t step(FlatStep made)
    {
        flat.steps.push_back(made);
        return here() - 1;
    }

    uint32_t list(const std::vector<Value>& values)
    {
        auto start = static_cast<uint32_t>(flat.lists.size());
        for (Value value : values) flat.lists.push_back(value.index);
        return start;
    }

    void copy(const std::vector<Value>& to, size_t first, const std::vector<Value>& from, size_t from_first)
    {
        for (size_t i = 0; first + i < to.size(); ++i)
            step({Kind::copy, {}, to[first + i].index, {from[from_first + i].index, 0, 0, 0}});
    }

    void block(const Block& source)
    {
        for (const Instruction& instruction : source.instructions)
            std::visit([&](const auto& kind) { lower(instruction, kind); }, instruction.kind);
    }

    void lower(const Instruction& made, const Operation& operation)
    {
        FlatStep flat_step{Kind::operation, operation.op, made.results[0].index, {0, 0, 0, 0}};
        for (size_t i = 0; i < made.operands.size(); ++i) flat_step.operand[i] = made.operands[i].index;
        step(flat_step);
    }
    void lower(const Instruction& made, const RealConstant& constant)
    {
        flat.constants.push_back(constant.value);
        step({Kind::real_constant,
              {},
              made.results[0].index,
              {static_cast<uint32_t>(flat.constants.size() - 1), 0, 0, 0}});
    }
    void lower(const Instruction& made, const IntConstant& constant)
    {
        step({Kind::word_constant, {}, made.results[0].index, {constant.bits, 0, 0, 0}});
    }
    void lower(const Instruction& made, const BoolConstant& constant)
    {
        step({Kind::word_constant, {}, made.results[0].index, {constant.value, 0, 0, 0}});
    }
    void lower(const Instruction& made, const ReadInput& read)
    {
        step({Kind::input, {}, made.results[0].index, {static_cast<uint32_t>(read.input), 0, 0, 0}});
    }
    void lower(const Instruction& made, const ReadParameter& read)
    {
        const bool is_image = function.type(made.results[0]) == Type::image;
        step({is_image ? Kind::image : Kind::parameter, {}, made.results[0].index, {read.parameter, 0, 0, 0}});
    }
    void lower(const Instruction& made, const ReadTable& read)
    {
        step({Kind::table, {}, made.results[0].index, {read.table, made.operands[0].index, 0, 0}});
    }
    void lower(const Instruction& made, const Call& call)
    {
        uint32_t lists = list(made.operands);
        list(made.results);
        step({Kind::call, {}, 0, {call.function, lists, 0, 0}});
        deepest_callee = std::max(deepest_callee, done[call.function].depth);
        longest_chain = std::max(longest_chain, done[call.function].calls + 1);
    }
    void lower(const Instruction& made, const PointDerivative&) // in no program that passes `verify`
    {
        lower(made, RealConstant{std::numeric_limits<double>::quiet_NaN()});
    }
    void lower(const Instruction& made, const If& choice)
    {
        uint32_t test = step({Kind::jump_unless, {}, 0, {made.operands[0].index, 0, 0, 0}});
        block(choice.arms[0]);
        copy(made.results, 0, choice.arms[0].yields, 0);
        uint32_t leave = step({Kind::jump, {}, 0, {0, 0, 0, 0}});
        flat.steps[test].operand[1] = here();
        block(choice.arms[1]);
        copy(made.results, 0, choice.arms[1].yields, 0);
        flat.steps[leave].operand[1] = here();
    }
    // The results hold the carried values between iterations: yields may name the body's parameters in any order.
    void lower(const Instruction& made, const For& loop)
    {
        const Block& body = loop.body[0];
        uint32_t counter = body.parameters[0].index;
        copy(made.results, 0, made.operands, 1);
        step({Kind::word_constant, {}, counter, {0, 0, 0, 0}});
        uint32_t test = step({Kind::loop_test, {}, 0, {counter, made.operands[0].index, 0, 0}});
        copy(body.parameters, 1, made.results, 0);
        block(body);
        copy(made.results, 0, body.yields, 0);
        step({Kind::loop_next, {}, counter, {0, test, 0, 0}});
        flat.steps[test].operand[2] = here();
    }
};

} // namespace

std::vector<FlatFunction> flatten(const Module& module)
{
    std::vector<FlatFunction> flat;
    flat.reserve(module.functions.size());
    for (const Function& function : module.functions) flat.push_back(Flattener(module, flat, function).run());
    return flat;
}

} // namespace haptel::ir
