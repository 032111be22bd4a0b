#include "tools/figures/bench_scale.h"

#include "tools/figures/bench_times.h"

#include <fmt/format.h>

namespace haptel::tools {
namespace {

std::string in_words(const bench::ScaleRow& row)
{
    const std::string probe =
        row.probe_radius_m > 0 ? fmt::format("ball {:g} mm", 1e3 * row.probe_radius_m) : row.probe;
    return row.friction ? probe : probe + ", slippery";
}

} // namespace

std::string to_table(const bench::Scale& scale)
{
    std::string text =
        fmt::format("{:<10} {:<19} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "grows", "probe",
                    "triangles", "objects", "contacts", "tick ns", "p99", "p99.9", "once", "x median", "x p99");
    for (const bench::ScaleRow& row : scale.rows)
        text +=
            fmt::format("{:<10} {:<19} {:>9} {:>8} {:>9.2f} {:>9.0f} {:>9.0f} {:>9.0f} {:>9.0f} {:>9.2f} {:>9.2f}\n",
                        row.axis, in_words(row), row.triangles, row.objects, row.contacts, row.tick_ns.median,
                        row.tick_ns.p99, row.tick_ns.p999, row.once_ns.p999, row.growth_median, row.growth_p99);
    text += fmt::format("{:<30} {:>9} {:>8} {:>13} {:>9} {:>15}\n", "surface", "triangles", "build ms", "ns a triangle",
                        "x", "bytes a triangle");
    for (const bench::BuildRow& row : scale.builds)
        text += fmt::format("{:<30} {:>9} {:>8.1f} {:>13.0f} {:>9.2f} {:>15.0f}\n", "", row.triangles, row.build_ms,
                            row.ns_per_triangle, row.growth, row.bytes_per_triangle);
    return text +
           "tick ns: the same ticks run several times, each tick's least time; once: p99.9 of the first run alone\n"
           "contacts: objects touched, mean over the ticks; x: over the first row of what grows and that probe\n"
           "ball: its radius; the objects' is 50 mm\n";
}

std::string to_csv(const bench::Scale& scale)
{
    std::string text = "axis,probe,probe_radius_m,friction,triangles,objects,contacts,tick_ns,tick_ns_p99,tick_ns_p999,"
                       "once_ns,once_ns_p99,once_ns_p999,growth,growth_p99,"
                       "build_ms,ns_per_triangle,bytes_per_triangle\n";
    for (const bench::ScaleRow& row : scale.rows)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},,,\n", row.axis, row.probe,
                            row.probe_radius_m, row.friction, row.triangles, row.objects, row.contacts,
                            row.tick_ns.median, row.tick_ns.p99, row.tick_ns.p999, row.once_ns.median, row.once_ns.p99,
                            row.once_ns.p999, row.growth_median, row.growth_p99);
    for (const bench::BuildRow& row : scale.builds)
        text += fmt::format("build,,,,{},1,,,,,,,,{},,{},{},{}\n", row.triangles, row.growth, row.build_ms,
                            row.ns_per_triangle, row.bytes_per_triangle);
    return text;
}

Json to_json(const bench::ScaleRow& row)
{
    return {{"axis", row.axis},
            {"probe", row.probe},
            {"probe_radius_m", row.probe_radius_m > 0 ? Json(row.probe_radius_m) : Json()},
            {"friction", row.friction},
            {"triangles", row.triangles},
            {"objects", row.objects},
            {"contacts", row.contacts},
            {"tick_ns", to_json(row.tick_ns)},
            {"once_ns", to_json(row.once_ns)},
            {"growth", {{"median", row.growth_median}, {"p99", row.growth_p99}}}};
}

Json to_json(const bench::BuildRow& row)
{
    return {{"triangles", row.triangles},
            {"build_ms", row.build_ms},
            {"ns_per_triangle", row.ns_per_triangle},
            {"bytes_per_triangle", row.bytes_per_triangle > 0 ? Json(row.bytes_per_triangle) : Json()},
            {"growth", row.growth}};
}

} // namespace haptel::tools
