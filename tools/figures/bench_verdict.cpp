#include "tools/figures/bench_verdict.h"

#include "bench/accuracy_verdict.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace haptel::tools {

using bench::AccuracyRow;

const char* mode_of(const AccuracyRow& row)
{
    return row.is_batch ? "batch" : "point";
}

std::string step_of(const AccuracyRow& row)
{
    if (row.step == 0) return "";
    return fmt::format("{:.0e}{}", row.step, row.is_best_step ? " (best)" : "");
}

namespace {

// "mixed" or "mixed, iterations": which variant of ours.
std::string variant_of(const AccuracyRow* ours)
{
    if (!ours) return "none";
    return ours->precision + (ours->lane_form == "iterations" ? ", iterations" : "");
}

Json name_of(const AccuracyRow& row)
{
    return {{"texture", row.texture}, {"mode", mode_of(row)},
            {"method", row.method},   {"precision", row.precision},
            {"level", row.level},     {"step_wavelengths", row.step == 0 ? Json(nullptr) : Json(row.step)}};
}

Json name_or_null(const AccuracyRow* ours)
{
    return ours ? Json({{"precision", ours->precision}, {"lane_form", ours->lane_form}}) : Json(nullptr);
}

} // namespace

std::string verdict_text(const std::vector<AccuracyRow>& rows)
{
    using namespace bench;
    std::string misses;
    std::map<double, std::pair<int, int>> counts; // by distance: how many hold, of how many
    for (const Alternative& one : alternatives(rows)) {
        ++counts[one.wavelengths].second;
        if (one.holds) {
            ++counts[one.wavelengths].first;
            continue;
        }
        misses += fmt::format("  {} {} {} {} for {}{}{} within {:g} wavelengths ({:.1f} ns, error {:.1e}): ",
                              one.plain->texture, mode_of(*one.plain), one.plain->method, one.plain->precision,
                              one.plain->level, one.plain->step == 0 ? "" : " step ", step_of(*one.plain),
                              one.wavelengths, one.plain->median_ns, one.error);
        misses += one.close_enough ? fmt::format("{} takes {:.2f} times as long\n", variant_of(one.close_enough),
                                                 one.close_enough->median_ns / one.plain->median_ns)
                                   : "none of ours is as close\n";
    }
    std::string text = fmt::format("For every plain C++ way a variant of ours at most {} times its time and {} times "
                                   "its error, or {}:\n",
                                   time_factor_max, error_factor_max, error_always_fine);
    for (const auto& [wavelengths, count] : counts)
        text += fmt::format("  within {:g} wavelengths: {} of {}\n", wavelengths, count.first, count.second);
    text += misses;
    text += "Plain central differences at their best step over our fastest of no larger error, smallest of their "
            "orders and precisions:\n";
    std::map<std::string, double> least;
    for (const DifferenceRatio& one : difference_ratios(rows)) {
        const auto [place, is_new] =
            least.try_emplace(one.plain->texture + ", " + mode_of(*one.plain), one.times_as_slow());
        place->second = std::min(place->second, one.times_as_slow());
    }
    for (const auto& [name, ratio] : least) text += fmt::format("  {}: {:.1f} times as slow\n", name, ratio);
    return text;
}

Json alternatives_json(const std::vector<AccuracyRow>& rows)
{
    Json all = Json::array();
    for (const bench::Alternative& one : bench::alternatives(rows)) {
        Json json = name_of(*one.plain);
        json["wavelengths"] = one.wavelengths;
        json["gradient_error_max"] = finite_or_null(one.error);
        json["holds"] = name_or_null(one.holds);
        json["close_enough"] = name_or_null(one.close_enough);
        json["times_as_fast"] = one.close_enough ? Json(one.times_as_fast()) : Json(nullptr);
        all.push_back(std::move(json));
    }
    return all;
}

Json differences_json(const std::vector<AccuracyRow>& rows)
{
    Json all = Json::array();
    for (const bench::DifferenceRatio& one : bench::difference_ratios(rows)) {
        Json json = name_of(*one.plain);
        json["ours"] = name_or_null(one.ours);
        json["times_as_slow"] = one.ours ? Json(one.times_as_slow()) : Json(nullptr);
        all.push_back(std::move(json));
    }
    return all;
}

} // namespace haptel::tools
