#include "lang/call_graph.h"

#include <algorithm>
#include <unordered_map>

namespace haptel::lang {
namespace {

constexpr uint32_t chain_max = 128;

struct Node {
    enum class Mark : uint8_t { unseen, open, done } mark = Mark::unseen;
    uint32_t length = 1; // of the longest chain of calls that starts here
};

struct Visit {
    FunctionInfo* function;
    size_t next_mention = 0;
};

class Walk {
public:
    Walk(CheckedProgram& program, Diagnostics& sink) : diagnostics(sink)
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
            Node& callee = nodes[mention.function];
            if (callee.mark == Node::Mark::open) report_cycle(path, mention);
            if (callee.mark != Node::Mark::unseen) continue;
            callee.mark = Node::Mark::open;
            path.push_back({mutable_functions[mention.function]});
        }
    }

private:
    void close(FunctionInfo& function)
    {
        Node& node = nodes[&function];
        node.mark = Node::Mark::done;
        const FunctionInfo::Mention* longest = nullptr;
        for (const FunctionInfo::Mention& mention : function.mentions) {
            const Node& callee = nodes[mention.function];
            if (callee.mark != Node::Mark::done) continue; // part of a cycle, reported
            function.reads |= mention.function->reads;
            if (callee.length + 1 > node.length) {
                node.length = callee.length + 1;
                longest = &mention;
            }
        }
        if (node.length > chain_max) {
            diagnostics.error(longest->span, "too-deep",
                              "functions call each other more than " + std::to_string(chain_max) + " deep here");
            node.length = 1; // once is enough
        }
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
        diagnostics
            .error(mention.span, "recursion",
                   "function '" + mention.function->name + "' ends up calling itself: " + cycle +
                       mention.function->name)
            .hint = "every texture must end: write a for loop with a bound";
    }

    Diagnostics& diagnostics;
    std::unordered_map<const FunctionInfo*, FunctionInfo*> mutable_functions;
    std::unordered_map<const FunctionInfo*, Node> nodes;
};

} // namespace

void check_call_graph(CheckedProgram& program, Diagnostics& diagnostics)
{
    Walk walk(program, diagnostics);
    for (FunctionInfo& function : program.functions) walk.from(function);
}

} // namespace haptel::lang
