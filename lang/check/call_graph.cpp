#include "lang/check/call_graph.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

namespace haptel::lang {
namespace {

constexpr uint32_t chain_max = 128;
constexpr uint32_t order_max = 4; // each order multiplies the code by the number of its directions

struct Visit {
    FunctionInfo* function;
    size_t next_mention = 0;
    bool is_begun = false, is_done = false;
};

// What a function that mentions these is, by what they are; reports chains and derivatives that are too deep.
void complete(FunctionInfo& caller, const std::vector<FunctionInfo::Mention>& mentions, Diagnostics& diagnostics)
{
    static const FunctionInfo built_in{};
    uint32_t call_depth = 1, derivative_order = 0;
    for (const FunctionInfo::Mention& mention : mentions) {
        const FunctionInfo& callee = mention.function ? *mention.function : built_in;
        const uint32_t depth = 1 + callee.call_depth;
        uint32_t order = mention.order + callee.derivative_order;
        for (const FunctionInfo* through : mention.through) order += through->derivative_order;
        if (depth > chain_max) {
            diagnostics.error(mention.span, "too-deep",
                              "functions call each other more than " + std::to_string(chain_max) + " deep here");
        } else if (order > order_max) {
            diagnostics.error(mention.span, "too-deep",
                              "derivatives of derivatives of order " + std::to_string(order) +
                                  " are taken here, expected at most " + std::to_string(order_max));
        } else {
            call_depth = std::max(call_depth, depth);
            derivative_order = std::max(derivative_order, order);
        }
        caller.reads |= callee.reads;
    }
    caller.call_depth = call_depth;
    caller.derivative_order = derivative_order;
}

void report_cycle(const std::vector<Visit*>& path, const FunctionInfo::Mention& mention, Diagnostics& diagnostics)
{
    constexpr ptrdiff_t shown = 8;
    const auto first = std::ranges::find(path, mention.function, &Visit::function);
    std::string cycle;
    for (auto visit = first; visit != path.end(); ++visit) {
        if (visit - first == shown) cycle += "... -> ";
        if (visit - first < shown || visit + 1 == path.end()) cycle += (*visit)->function->name + " -> ";
    }
    diagnostics.error(mention.span, "recursion",
                      "function '" + mention.function->name + "' ends up calling itself: " + cycle +
                          mention.function->name,
                      "every texture must end: write a for loop with a bound");
}

} // namespace

void check_call_graph(CheckedProgram& program, Diagnostics& diagnostics)
{
    std::unordered_map<const FunctionInfo*, Visit> visits;
    for (FunctionInfo& function : program.functions) visits[&function] = {&function};
    // Depth first with a stack of its own: a file may hold a chain of any length.
    std::vector<Visit*> path;
    const auto enter = [&](Visit& visit) {
        if (!std::exchange(visit.is_begun, true)) path.push_back(&visit);
    };
    for (const FunctionInfo& root : program.functions) {
        enter(visits[&root]);
        while (!path.empty()) {
            Visit& visit = *path.back();
            FunctionInfo& function = *visit.function;
            if (visit.next_mention == function.mentions.size()) {
                complete(function, function.mentions, diagnostics);
                visit.is_done = true;
                path.pop_back();
                continue;
            }
            const FunctionInfo::Mention& mention = function.mentions[visit.next_mention++];
            const auto callee = visits.find(mention.function);
            if (callee == visits.end()) continue;
            if (callee->second.is_begun && !callee->second.is_done) report_cycle(path, mention, diagnostics);
            enter(callee->second);
        }
    }
    for (const CheckedTexture& texture : program.textures) {
        FunctionInfo unused;
        complete(unused, texture.mentions, diagnostics);
    }
}

} // namespace haptel::lang
