#include "tools/figures/bench_skip.h"

#include <fmt/format.h>

namespace haptel::tools {

std::string to_table(const std::vector<bench::SkipRow>& rows)
{
    std::string text = fmt::format("{:<26} {:<11} {:>9} {:>9} {:>11} {:>9} {:>9} {:>10} {:>10}\n", "scene", "left out",
                                   "tick ns", "p99", "without ns", "p99", "x faster", "counted", "dF max N");
    for (const bench::SkipRow& row : rows)
        text +=
            fmt::format("{:<26} {:<11} {:>9.0f} {:>9.0f} {:>11.0f} {:>9.0f} {:>9.2f} {:>10.2f} {:>10.2g}\n", row.scene,
                        row.skip, row.with_ns.median, row.with_ns.p99, row.without_ns.median, row.without_ns.p99,
                        row.without_ns.median / row.with_ns.median, row.counted, row.force_difference_max_n);
    return text +
           "tick: with it left out; without: the same stroke with it computed; counted: per tick, as in the report of\n"
           "haptel explore (of all: free space, and mapping); dF: the largest difference between the forces of both\n";
}

std::string to_csv(const std::vector<bench::SkipRow>& rows)
{
    std::string text =
        "scene,skip,with_ns,with_ns_p99,without_ns,without_ns_p99,counted_per_tick,force_difference_max_n\n";
    for (const bench::SkipRow& row : rows)
        text += fmt::format("\"{}\",{},{},{},{},{},{},{}\n", row.scene, row.skip, row.with_ns.median, row.with_ns.p99,
                            row.without_ns.median, row.without_ns.p99, row.counted, row.force_difference_max_n);
    return text;
}

Json to_json(const bench::SkipRow& row)
{
    return {{"scene", row.scene},
            {"skip", row.skip},
            {"with_ns", row.with_ns.median},
            {"without_ns", row.without_ns.median},
            {"with_ns_p99", row.with_ns.p99},
            {"without_ns_p99", row.without_ns.p99},
            {"counted_per_tick", row.counted},
            {"force_difference_max_n", row.force_difference_max_n}};
}

} // namespace haptel::tools
