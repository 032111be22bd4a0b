#include "lang/check/call_graph.h"

#include <algorithm>
#include <unordered_map>

namespace haptel::lang {
namespace {

constexpr uint32_t chain_max = 128;
constexpr uint32_t order_max = 4; // each order multiplies the code by the number of its directions

struct Node {
    enum class Mark : uint8_t { unseen, open, done } mark = Mark::unseen;
    CallDepth depth;
};

struct Visit {
    FunctionInfo* function;
    size_t next_mention = 0;
};

class Walk {
public:
    Walk(CheckedProgram& program, const CallDepths& of_others, Diagnostics& sink) : known(of_others), diagnostics(sink)
    {
        for (FunctionInfo& function : program.functions) {
            mutable_functions[&function] = &function;
            nodes[&function];
        }
    }

    // Depth first with a stack of its own: a file may hold a chain of any length.
    void from(FunctionInfo& root)
    {
        if (nodes[&root].mark != Node::Mark::unseen) return;
        std::vector<Visit> path{{&root}};
        nodes[&root].mark = Node::Mark::open;
        while (!path.empty()) {
            Visit& visit = path.back();
            if (visit.next_mention == visit.function->mentions.size()) {
                close(*visit.function);
                path.pop_back();
                continue;
            }
            const FunctionInfo::Mention& mention = visit.function->mentions[visit.next_mention++];
            const auto own = nodes.find(mention.function);
            if (own == nodes.end()) continue;
            Node& callee = own->second;
            if (callee.mark == Node::Mark::open) report_cycle(path, mention);
            if (callee.mark != Node::Mark::unseen) continue;
            callee.mark = Node::Mark::open;
            path.push_back({mutable_functions[mention.function]});
        }
    }

    // Reports chains and derivatives that are too deep.
    void measure(const std::vector<FunctionInfo::Mention>& mentions, CallDepth& depth)
    {
        for (const FunctionInfo::Mention& mention : mentions) {
            const uint32_t length = 1 + depth_of(mention.function).length;
            const uint32_t order = mention.order + depth_of(mention.function).order + depth_of(mention.through).order;
            if (length > chain_max) {
                diagnostics.error(mention.span, "too-deep",
                                  "functions call each other more than " + std::to_string(chain_max) + " deep here");
            } else if (order > order_max) {
                diagnostics.error(mention.span, "too-deep",
                                  "derivatives of derivatives of order " + std::to_string(order) +
                                      " are taken here, expected at most " + std::to_string(order_max));
            } else {
                depth.length = std::max(depth.length, length);
                depth.order = std::max(depth.order, order);
            }
        }
    }

    CallDepths depths() const
    {
        CallDepths all;
        for (const auto& [function, node] : nodes)
            if (node.mark == Node::Mark::done) all.emplace(function, node.depth);
        return all;
    }

private:
    // Of what is built in, and of what is part of a cycle, which has been reported: nothing.
    CallDepth depth_of(const FunctionInfo* function)
    {
        if (const auto own = nodes.find(function); own != nodes.end() && own->second.mark == Node::Mark::done)
            return own->second.depth;
        const auto other = known.find(function);
        return other != known.end() ? other->second : CallDepth{0, 0};
    }

    void close(FunctionInfo& function)
    {
        CallDepth depth;
        measure(function.mentions, depth);
        nodes[&function] = {Node::Mark::done, depth};
        for (const FunctionInfo::Mention& mention : function.mentions)
            if (mention.function) function.reads |= mention.function->reads;
    }

    void report_cycle(const std::vector<Visit>& path, const FunctionInfo::Mention& mention)
    {
        auto first =
            std::find_if(path.begin(), path.end(), [&](const Visit& v) { return v.function == mention.function; });
        constexpr ptrdiff_t shown = 8;
        std::string cycle;
        for (auto visit = first; visit != path.end(); ++visit) {
            if (visit - first == shown) cycle += "... -> ";
            if (visit - first < shown || visit + 1 == path.end()) cycle += visit->function->name + " -> ";
        }
        diagnostics.error(mention.span, "recursion",
                          "function '" + mention.function->name + "' ends up calling itself: " + cycle +
                              mention.function->name,
                          "every texture must end: write a for loop with a bound");
    }

    const CallDepths& known;
    Diagnostics& diagnostics;
    std::unordered_map<const FunctionInfo*, FunctionInfo*> mutable_functions;
    std::unordered_map<const FunctionInfo*, Node> nodes;
};

} // namespace

CallDepths check_call_graph(CheckedProgram& program, const CallDepths& known, Diagnostics& diagnostics)
{
    Walk walk(program, known, diagnostics);
    for (FunctionInfo& function : program.functions) walk.from(function);
    for (const CheckedTexture& texture : program.textures) {
        CallDepth unused;
        walk.measure(texture.mentions, unused);
    }
    return walk.depths();
}

} // namespace haptel::lang
