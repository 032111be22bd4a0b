#include "tools/check/check_cost.h"

#include "lang/ir/cost.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace haptel::tools {
namespace {

struct LineCost {
    uint32_t file = 0, line = 1;
    uint64_t operations = 0;
};

std::vector<LineCost> cost_by_line(const CheckedTexture& checked)
{
    const lang::SourceSet& sources = checked.program->sources;
    std::map<std::pair<uint32_t, uint32_t>, uint64_t> lines;
    for (const ir::SpanCost& cost : ir::cost_by_span(checked.program->module, checked.texture->height_gradient))
        lines[{cost.span.file, sources.position(cost.span.file, cost.span.begin).line}] += cost.operations;
    std::vector<LineCost> costs;
    for (const auto& [place, operations] : lines) costs.push_back({place.first, place.second, operations});
    return costs;
}

} // namespace

Json cost_json(const CheckedTexture& checked)
{
    Json lines = Json::array();
    for (const LineCost& cost : cost_by_line(checked))
        lines.push_back({{"file", checked.program->sources.file(cost.file).name},
                         {"line", cost.line},
                         {"operations", cost.operations}});
    return lines;
}

std::string cost_text(const CheckedTexture& checked)
{
    const lang::SourceSet& sources = checked.program->sources;
    std::vector<LineCost> costs = cost_by_line(checked);
    uint64_t all = 0;
    for (const LineCost& cost : costs) all += cost.operations;
    std::stable_sort(costs.begin(), costs.end(),
                     [](const LineCost& a, const LineCost& b) { return a.operations > b.operations; });
    std::string text;
    for (const LineCost& cost : costs)
        text +=
            fmt::format("  {:>9}  {:>3.0f} %  {}:{:<4} {}\n", cost.operations,
                        100.0 * static_cast<double>(cost.operations) / static_cast<double>(all),
                        sources.file(cost.file).name, cost.line, lang::printable(sources.line(cost.file, cost.line)));
    return text;
}

} // namespace haptel::tools
