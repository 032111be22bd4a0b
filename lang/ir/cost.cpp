#include "lang/ir/cost.h"

#include "lang/ir/op_cost.h"

#include <map>
#include <optional>
#include <tuple>

namespace haptel::ir {
namespace {

struct BySource {
    bool operator()(const Span& a, const Span& b) const
    {
        return std::tie(a.file, a.begin, a.end) < std::tie(b.file, b.begin, b.end);
    }
};

struct Spent {
    std::map<Span, uint64_t, BySource> places;
    uint64_t all = 0;

    void add(Span span, uint64_t count)
    {
        if (count == 0) return;
        uint64_t& here = places[span];
        here = plus(here, count);
        all = plus(all, count);
    }
    void add(const Spent& other, uint64_t often = 1)
    {
        for (const auto& [span, count] : other.places) add(span, times(count, often));
    }
};

class Counter {
public:
    explicit Counter(const Module& whole) : module(whole), known(whole.functions.size()) {}

    const Spent& of(uint32_t function)
    {
        if (!known[function]) known[function] = of(module.functions[function].body);
        return *known[function];
    }

private:
    const Module& module;
    std::vector<std::optional<Spent>> known; // by function

    Spent of(const Block& block)
    {
        Spent spent;
        for (const Instruction& made : block.instructions)
            std::visit([&](const auto& kind) { count(spent, made, kind); }, made.kind);
        return spent;
    }

    template <typename Other>
    void count(Spent& spent, const Instruction& made, const Other&)
    {
        spent.add(made.span, 1);
    }
    void count(Spent& spent, const Instruction& made, const Operation& operation)
    {
        spent.add(made.span, operations_of(operation.op));
    }
    void count(Spent&, const Instruction&, const RealConstant&) {}
    void count(Spent&, const Instruction&, const IntConstant&) {}
    void count(Spent&, const Instruction&, const BoolConstant&) {}
    void count(Spent& spent, const Instruction& made, const Call& call)
    {
        spent.add(made.span, 1);
        const Spent& inside = of(call.function);
        if (module.functions[call.function].is_library)
            spent.add(made.span, inside.all);
        else
            spent.add(inside);
    }
    void count(Spent& spent, const Instruction& made, const If& choice)
    {
        spent.add(made.span, 1);
        Spent dearest;
        for (const Block& arm : choice.arms)
            if (Spent other = of(arm); other.all > dearest.all) dearest = std::move(other);
        spent.add(dearest);
    }
    void count(Spent& spent, const Instruction& made, const For& loop)
    {
        spent.add(made.span, plus(loop.trip_max, 1));
        spent.add(of(loop.body[0]), loop.trip_max);
    }
};

} // namespace

std::vector<SpanCost> cost_by_span(const Module& module, uint32_t function)
{
    std::vector<SpanCost> costs;
    Counter counter(module);
    for (const auto& [span, count] : counter.of(function).places) costs.push_back({span, count});
    return costs;
}

} // namespace haptel::ir
