#include "tools/figures/bench_tick.h"

#include "tools/figures/bench_times.h"

#include <algorithm>
#include <fmt/format.h>

namespace haptel::tools {
namespace {

struct Pair {
    const bench::TickRow *first, *last;
};

// Of each scene the smallest and the largest mesh, and the fewest and the most objects.
std::vector<Pair> pairs(const std::vector<bench::TickRow>& rows)
{
    std::vector<Pair> found;
    for (const bench::TickRow& row : rows) {
        Pair pair{&row, &row}, objects{&row, &row};
        for (const bench::TickRow& other : rows) {
            if (other.scene != row.scene) continue;
            if (other.objects == row.objects && other.triangles > pair.last->triangles) pair.last = &other;
            if (other.objects == row.objects && other.triangles < pair.first->triangles) pair.first = &other;
            if (other.triangles == row.triangles && other.objects > objects.last->objects) objects.last = &other;
            if (other.triangles == row.triangles && other.objects < objects.first->objects) objects.first = &other;
        }
        for (const Pair& made : {pair, objects})
            if (made.first == &row && made.last != &row) found.push_back(made);
    }
    return found;
}

} // namespace

std::string to_table(const std::vector<bench::TickRow>& rows)
{
    std::string text =
        fmt::format("{:<22} {:>9} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8}\n",
                    "scene", "triangles", "objects", "contact", "tick ns", "p99", "p99.9", "once", "ahead ns",
                    "tree ns", "ratio", "queries", "touched", "p99", "stepped");
    for (const bench::TickRow& row : rows)
        text +=
            fmt::format("{:<22} {:>9} {:>7} {:>7.1f}% {:>8.0f} {:>8.0f} {:>8.0f} {:>8.0f} {:>9.0f} {:>9.0f} {:>8.2f} "
                        "{:>8.0f} {:>8.0f} {:>8.0f} {:>8.0f}\n",
                        row.scene, row.triangles, row.objects, 100 * row.contact, row.tick_ns.median, row.tick_ns.p99,
                        row.tick_ns.p999, row.once_ns.p999, row.ahead_ns.median, row.tree_ns.median,
                        row.tick_ns.median / row.tree_ns.median, row.queries.median, row.triangles_touched.median,
                        row.triangles_touched.p99, row.triangles_stepped.p99);
    return text +
           "tick ns: the same ticks run several times, each tick's least time; once: p99.9 of the first run alone\n"
           "ahead: after each tick, the faces around the proxy brought into the cache for the next\n"
           "tree: one walk through the tree of boxes for the hand's way in the tick; queries: such walks in a tick;\n"
           "touched: triangles that the servo reads for a tick, the ones ahead included; stepped: at p99, those "
           "without\n"
           "the ones ahead: delivered by trees, and stepped on by proxies until the force was sent\n"
           "the time of reading the clock is subtracted from all times\n";
}

std::string to_csv(const std::vector<bench::TickRow>& rows)
{
    std::string text = "scene,triangles,objects,contact,tick_ns,tick_ns_p99,tick_ns_p999,"
                       "once_ns,once_ns_p99,once_ns_p999,ahead_ns,tree_ns,queries,queries_p99,"
                       "triangles_touched,triangles_touched_p99,triangles_stepped_p99\n";
    for (const bench::TickRow& row : rows)
        text += fmt::format("\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.scene, row.triangles,
                            row.objects, row.contact, row.tick_ns.median, row.tick_ns.p99, row.tick_ns.p999,
                            row.once_ns.median, row.once_ns.p99, row.once_ns.p999, row.ahead_ns.median,
                            row.tree_ns.median, row.queries.median, row.queries.p99, row.triangles_touched.median,
                            row.triangles_touched.p99, row.triangles_stepped.p99);
    return text;
}

// Of the tree of boxes its walks are counted, the nodes that these visit are not: a promised field that nobody knows is
// null.
Json to_json(const bench::TickRow& row)
{
    return {{"scene", row.scene},
            {"triangles", row.triangles},
            {"objects", row.objects},
            {"contact", row.contact},
            {"tick_ns", to_json(row.tick_ns)},
            {"once_ns", to_json(row.once_ns)},
            {"ahead_ns", to_json(row.ahead_ns)},
            {"tree_ns", to_json(row.tree_ns)},
            {"nodes", nullptr},
            {"queries", to_json(row.queries)},
            {"triangles_touched", to_json(row.triangles_touched)},
            {"triangles_stepped", to_json(row.triangles_stepped)}};
}

std::string growth_table(const std::vector<bench::TickRow>& rows)
{
    std::string text = fmt::format("{:<22} {:>22} {:>14} {:>9} {:>9} {:>12} {:>12}\n", "growth", "triangles", "objects",
                                   "median", "p99", "touched p99", "stepped p99");
    for (const auto& [first, last] : pairs(rows)) {
        const bench::Growth by = bench::growth(*first, *last);
        text += fmt::format("{:<22} {:>22} {:>14} {:>8.2f}x {:>8.2f}x {:>11.2f}x {:>11.2f}x\n", first->scene,
                            fmt::format("{} to {}", first->triangles, last->triangles),
                            fmt::format("{} to {}", first->objects, last->objects), by.median, by.p99, by.touched_p99,
                            by.stepped_p99);
    }
    return text;
}

Json growth_json(const std::vector<bench::TickRow>& rows)
{
    Json all = Json::array();
    for (const auto& [first, last] : pairs(rows)) {
        const bench::Growth by = bench::growth(*first, *last);
        all.push_back({{"scene", first->scene},
                       {"triangles", {first->triangles, last->triangles}},
                       {"objects", {first->objects, last->objects}},
                       {"median", by.median},
                       {"p99", by.p99},
                       {"touched_p99", by.touched_p99},
                       {"stepped_p99", by.stepped_p99}});
    }
    return all;
}

} // namespace haptel::tools
