#include "tools/figures/bench_math.h"

#include <fmt/format.h>

namespace haptel::tools {
namespace {

std::string columns(const bench::MathFormat& format)
{
    return fmt::format("  {:>6.2f} {:>6.2f} {:>7.2f} {:>7.2f} {:>7.2f} {:>7.1f}", format.error, format.library_error,
                       format.alone_ns.median, format.lanes_ns.median, format.library_ns.median,
                       format.library_ns.median / format.lanes_ns.median);
}

std::string cells(const bench::MathFormat& format)
{
    return fmt::format(",{},{},{},{},{}", format.error, format.library_error, format.alone_ns.median,
                       format.lanes_ns.median, format.library_ns.median);
}

Json object(const bench::MathFormat& format)
{
    const auto times = [](const bench::Times& of) { return Json{{"median", of.median}, {"p99", of.p99}}; };
    return {{"error_ulp", format.error},
            {"library_error_ulp", format.library_error},
            {"alone_ns", times(format.alone_ns)},
            {"lanes_ns", times(format.lanes_ns)},
            {"library_ns", times(format.library_ns)}};
}

} // namespace

std::string to_table(const std::vector<bench::MathRow>& rows)
{
    std::string text = fmt::format("{:<6} {:>8}  {:^45}  {:^45}\n", "", "", "f64", "f32");
    text += fmt::format("{:<6} {:>8}", "", "promised");
    for (int format = 0; format < 2; ++format)
        text += fmt::format("  {:>6} {:>6} {:>7} {:>7} {:>7} {:>7}", "ulp", "C ulp", "ns", "lanes", "C ns", "C/lanes");
    text += "\n";
    for (const bench::MathRow& row : rows)
        text += fmt::format("{:<6} {:>8}{}{}\n", row.function, row.promised, columns(row.f64), columns(row.f32));
    return text +
           fmt::format("ulp: largest error over the whole range; ns: of one value alone, and of one of {} in lanes; "
                       "C: the C library's\n",
                       rows.empty() ? 0 : rows[0].lanes);
}

std::string to_csv(const std::vector<bench::MathRow>& rows)
{
    std::string text = "function,lanes,promised_ulp";
    for (const char* format : {"f64", "f32"})
        for (const char* what : {"error_ulp", "library_error_ulp", "alone_ns", "lanes_ns", "library_ns"})
            text += fmt::format(",{}_{}", format, what);
    text += "\n";
    for (const bench::MathRow& row : rows)
        text += fmt::format("{},{},{}{}{}\n", row.function, row.lanes, row.promised, cells(row.f64), cells(row.f32));
    return text;
}

Json to_json(const bench::MathRow& row)
{
    return {{"function", row.function},
            {"lanes", row.lanes},
            {"promised_ulp", row.promised},
            {"f64", object(row.f64)},
            {"f32", object(row.f32)}};
}

} // namespace haptel::tools
