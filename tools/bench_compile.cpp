#include "tools/bench_compile.h"

#include <fmt/format.h>

namespace haptel::tools {
namespace {

Json times_of(const bench::Times& times)
{
    return {{"median", times.median}, {"p99", times.p99}};
}

} // namespace

Json to_json(const bench::CompileRow& row)
{
    const bool has_code = row.first_ms > 0;
    return {{"texture", row.texture},
            {"lines", row.lines},
            {"front_end_ms", times_of(row.front_end)},
            {"first_ms", has_code ? Json(row.first_ms) : Json(nullptr)},
            {"warm_ms", has_code ? times_of(row.warm) : Json(nullptr)},
            {"cached_ms", nullptr}}; // null: there is no cache on disk
}

std::string to_table(const std::vector<bench::CompileRow>& rows)
{
    std::string text = fmt::format("{:<10} {:>6}  {:>21}  {:>9}  {:>21}\n", "texture", "lines", "front end ms (p99)",
                                   "first ms", "to code again ms (p99)");
    for (const bench::CompileRow& row : rows) {
        text += fmt::format("{:<10} {:>6}  {:>12.2f} ({:>6.2f})", row.texture, row.lines, row.front_end.median,
                            row.front_end.p99);
        if (row.first_ms > 0)
            text += fmt::format("  {:>9.1f}  {:>12.1f} ({:>6.1f})", row.first_ms, row.warm.median, row.warm.p99);
        text += "\n";
    }
    return text + fmt::format("time per line, longest over shortest: {:.2f}\n", bench::growth(rows));
}

} // namespace haptel::tools
