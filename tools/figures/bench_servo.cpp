#include "tools/figures/bench_servo.h"

#include <array>
#include <cstddef>
#include <fmt/format.h>

namespace haptel::tools {

namespace {

struct LateUs {
    double median, p99, p999, longest;
};

LateUs late_us(const bench::ServoRow& row)
{
    const auto& late = row.report.wake_late_ns;
    const auto us = [](uint64_t ns) { return 1e-3 * static_cast<double>(ns); };
    return {us(late.percentile(0.5)), us(late.percentile(0.99)), us(late.percentile(0.999)), us(late.maximum())};
}

double missed_per_mille(const bench::ServoRow& row)
{
    const auto missed = static_cast<double>(row.report.missed_deadlines);
    return 1000 * missed / (missed + static_cast<double>(row.report.ticks));
}

const char* others(const bench::ServoRow& row)
{
    return row.busy ? "busy" : "idle";
}

} // namespace

std::string to_table(const std::vector<bench::ServoRow>& rows)
{
    std::string text =
        fmt::format("{:<8} {:>8}  {:<17} {:<7} {:>9} {:>9} {:>9} {:>10} {:>11} {:>11}\n", "others", "rate Hz",
                    "scheduling", "granted", "late us", "p99", "p99.9", "longest", "missed o/oo", "processor %");
    for (const bench::ServoRow& row : rows) {
        const LateUs late = late_us(row);
        text += fmt::format("{:<8} {:>8.0f}  {:<17} {:<7} {:>9.1f} {:>9.1f} {:>9.1f} {:>10.0f} {:>11.2f} {:>11.1f}\n",
                            others(row), row.rate_hz, row.scheduling, row.granted ? "yes" : "no", late.median, late.p99,
                            late.p999, late.longest, missed_per_mille(row), 100 * row.report.processor_share);
    }
    return text +
           "others: what else runs, nothing or a thread on each processor; late: after the deadline the servo woke;\n"
           "missed: of a thousand deadlines; processor: the servo's share of one\n";
}

std::string to_csv(const std::vector<bench::ServoRow>& rows)
{
    std::string text =
        "others,rate_hz,scheduling,granted,late_us,late_us_p99,late_us_p999,late_us_max,missed_per_mille,"
        "processor_share\n";
    for (const bench::ServoRow& row : rows) {
        const LateUs late = late_us(row);
        text += fmt::format("{},{},\"{}\",{},{},{},{},{},{},{}\n", others(row), row.rate_hz, row.scheduling,
                            row.granted, late.median, late.p99, late.p999, late.longest, missed_per_mille(row),
                            row.report.processor_share);
    }
    return text;
}

Json to_json(const bench::ServoRow& row)
{
    const LateUs late = late_us(row);
    return {{"others", others(row)},
            {"rate_hz", row.rate_hz},
            {"scheduling", row.scheduling},
            {"granted", row.granted},
            {"ticks", row.report.ticks},
            {"missed_deadlines", row.report.missed_deadlines},
            {"late_us", {{"median", late.median}, {"p99", late.p99}, {"p999", late.p999}, {"max", late.longest}}},
            {"processor_share", row.report.processor_share},
            {"note", row.report.real_time_note}};
}

} // namespace haptel::tools
