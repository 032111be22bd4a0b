#include "lang/ir/cost.h"

#include <algorithm>
#include <map>

namespace haptel::ir {
namespace {

// Along each axis: 9 for the place in a pair of mirrored tiles, 19 for four cubic weights, 4 texels. Then 16 reads, and
// a product and a sum for each of them and for each of four rows.
constexpr uint64_t of_spline = 2 * (9 + 19 + 4) + 16 + 2 * (16 + 4);

uint64_t plus(uint64_t a, uint64_t b)
{
    uint64_t sum = 0;
    return __builtin_add_overflow(a, b, &sum) ? UINT64_MAX : sum;
}

uint64_t times(uint64_t a, uint64_t b)
{
    uint64_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? UINT64_MAX : product;
}

// Without what it calls and what is in its blocks.
uint64_t own_cost(const Instruction& made)
{
    if (auto* operation = std::get_if<Operation>(&made.kind)) return operation->op == Op::spline ? of_spline : 1;
    if (auto* loop = std::get_if<For>(&made.kind)) return plus(loop->trip_max, 1);
    const bool is_constant =
        std::holds_alternative<RealConstant>(made.kind) || std::holds_alternative<WordConstant>(made.kind);
    return is_constant ? 0 : 1;
}

// `functions`: what a call of each takes, of those before this one.
uint64_t cost(const Block& block, const std::vector<uint64_t>& functions)
{
    uint64_t sum = 0;
    for (const Instruction& made : block.instructions) {
        sum = plus(sum, own_cost(made));
        if (auto* call = std::get_if<Call>(&made.kind)) sum = plus(sum, functions[call->function]);
        if (auto* loop = std::get_if<For>(&made.kind))
            sum = plus(sum, times(cost(loop->body[0], functions), loop->trip_max));
        if (auto* choice = std::get_if<If>(&made.kind))
            sum = plus(sum, std::max(cost(choice->arms[0], functions), cost(choice->arms[1], functions)));
    }
    return sum;
}

// What one call of a function spends, block by block.
struct Spending {
    const Module& module;
    const std::vector<uint64_t> costs; // by function
    std::vector<uint64_t> runs;        // likewise: how often what this function calls is run
    std::map<Span, uint64_t> places = {};

    void block(const Block& source, uint64_t often)
    {
        if (often == 0) return;
        for (const Instruction& made : source.instructions) {
            uint64_t here = own_cost(made);
            if (auto* call = std::get_if<Call>(&made.kind)) {
                if (module.functions[call->function].is_library)
                    here = plus(here, costs[call->function]);
                else
                    runs[call->function] = plus(runs[call->function], often);
            }
            if (here > 0) {
                uint64_t& place = places[made.span];
                place = plus(place, times(here, often));
            }
            if (auto* loop = std::get_if<For>(&made.kind)) block(loop->body[0], times(often, loop->trip_max));
            if (auto* choice = std::get_if<If>(&made.kind))
                block(choice->arms[cost(choice->arms[1], costs) > cost(choice->arms[0], costs)], often);
        }
    }
};

// Whether `function`, or what it calls, holds each function of the module up to it: itself included.
std::vector<bool> reached_from(const Module& module, uint32_t function)
{
    std::vector<bool> reached(size_t{function} + 1, false);
    reached.back() = true;
    for (size_t i = reached.size(); i-- > 0;) // callees stand before their callers
        if (reached[i])
            for_each_instruction(module.functions[i].body, [&](const Instruction& made) {
                if (auto* call = std::get_if<Call>(&made.kind)) reached[call->function] = true;
            });
    return reached;
}

} // namespace

size_t instructions_reached(const Module& module, uint32_t function)
{
    const std::vector<bool> reached = reached_from(module, function);
    size_t sum = 0;
    for (size_t i = 0; i < reached.size(); ++i)
        if (reached[i]) for_each_instruction(module.functions[i].body, [&](const Instruction&) { ++sum; });
    return sum;
}

std::vector<uint64_t> operations_max(const Module& module, const std::vector<bool>& wanted)
{
    std::vector<uint64_t> known(wanted.size(), 0);
    for (size_t i = 0; i < known.size(); ++i)
        if (wanted[i]) known[i] = cost(module.functions[i].body, known);
    return known;
}

uint64_t operations_max(const Module& module, uint32_t function)
{
    return operations_max(module, reached_from(module, function)).back();
}

std::vector<SpanCost> cost_by_span(const Module& module, uint32_t function)
{
    Spending spending{module, operations_max(module, reached_from(module, function)),
                      std::vector<uint64_t>(size_t{function} + 1, 0)};
    spending.runs[function] = 1;
    for (size_t i = spending.runs.size(); i-- > 0;) // callers first: by then it is known how often one runs
        spending.block(module.functions[i].body, spending.runs[i]);
    std::vector<SpanCost> costs;
    for (const auto& [span, count] : spending.places) costs.push_back({span, count});
    return costs;
}

} // namespace haptel::ir
