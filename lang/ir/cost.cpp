#include "lang/ir/cost.h"

#include "lang/ir/extent.h"

#include <algorithm>
#include <map>
#include <tuple>

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

struct BySource {
    bool operator()(const Span& a, const Span& b) const
    {
        return std::tie(a.file, a.begin, a.end) < std::tie(b.file, b.begin, b.end);
    }
};

// Callers first: how often a function runs is known when its body is looked at.
class Spending {
public:
    Spending(const Module& whole, uint32_t function)
        : module(whole), costs(operations_max(whole, reached_from(whole, function))), runs(costs.size(), 0)
    {
        runs[function] = 1;
        for (size_t i = runs.size(); i-- > 0;) spend(module.functions[i].body, runs[i]);
    }
    std::map<Span, uint64_t, BySource> places;

private:
    const Module& module;
    const std::vector<uint64_t> costs; // by function
    std::vector<uint64_t> runs;        // likewise

    void spend(const Block& block, uint64_t often)
    {
        if (often == 0) return;
        for (const Instruction& made : block.instructions) {
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
            if (auto* loop = std::get_if<For>(&made.kind)) spend(loop->body[0], times(often, loop->trip_max));
            if (auto* choice = std::get_if<If>(&made.kind))
                spend(choice->arms[cost(choice->arms[1], costs) > cost(choice->arms[0], costs)], often);
        }
    }
};

} // namespace

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
    std::vector<SpanCost> costs;
    for (const auto& [span, count] : Spending(module, function).places) costs.push_back({span, count});
    return costs;
}

} // namespace haptel::ir
