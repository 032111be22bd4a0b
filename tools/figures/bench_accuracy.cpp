#include "tools/figures/bench_accuracy.h"

#include "tools/figures/bench_verdict.h"
#include "tools/plot/plot_axes.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace haptel::tools {
namespace {

using bench::AccuracyRow;

// The rows of one texture and mode follow each other, fastest first.
std::vector<AccuracyRow> sorted(std::vector<AccuracyRow> rows)
{
    std::vector<std::string> order;
    for (const AccuracyRow& row : rows)
        if (std::find(order.begin(), order.end(), row.texture) == order.end()) order.push_back(row.texture);
    const auto key = [&](const AccuracyRow& row) {
        const auto place = std::find(order.begin(), order.end(), row.texture) - order.begin();
        return std::tuple(place, row.is_batch, row.median_ns);
    };
    std::sort(rows.begin(), rows.end(), [&](const AccuracyRow& a, const AccuracyRow& b) { return key(a) < key(b); });
    return rows;
}

// What the plain rows were compiled with, a line for each level.
std::string flags_text(const std::vector<AccuracyRow>& rows)
{
    std::map<std::string, std::string> flags;
    for (const AccuracyRow& row : rows)
        if (row.is_plain()) flags.emplace(row.level, row.flags);
    std::string text;
    for (const auto& [level, of_level] : flags) text += fmt::format("plain C++ for {}: {}\n", level, of_level);
    return text;
}

} // namespace

std::string to_table(const std::vector<bench::AccuracyRow>& rows)
{
    std::string text =
        fmt::format("{:<9} {:<5} {:<18} {:<5} {:<12} {:<10} {:>13} {:>9} {:>9} {:>8}  {:>9} {:>9} {:>9} {:>9}  {}\n",
                    "texture", "mode", "method", "prec.", "compiled for", "lanes hold", "step", "median ns", "p99 ns",
                    "h only", "height", "near", "1e3", "1e6", "frontier");
    std::string last;
    for (const AccuracyRow& row : sorted(rows)) {
        const std::string group = row.texture + mode_of(row);
        if (!last.empty() && group != last) text += "\n";
        last = group;
        text += fmt::format("{:<9} {:<5} {:<18} {:<5} {:<12} {:<10} {:>13} {:>9.1f} {:>9.1f} {:>8}  {:>9.1e} {:>9.1e} "
                            "{:>9.1e} {:>9.1e}  {}\n",
                            row.texture, mode_of(row), row.method, row.precision, row.level,
                            row.lane_form == "one" ? "" : row.lane_form, step_of(row), row.median_ns, row.p99_ns,
                            row.height_only_ns > 0 ? fmt::format("{:.1f}", row.height_only_ns) : "",
                            row.errors[0].height_max, row.errors[0].gradient_max, row.errors[1].gradient_max,
                            row.errors[2].gradient_max, row.is_on_frontier ? "*" : "");
    }
    return text +
           "near, 1e3, 1e6: largest error of the gradient over its largest value, at coordinates within 10, 1e3 "
           "and 1e6 wavelengths; height: the same of the height, near\n" +
           flags_text(rows) + verdict_text(rows);
}

std::string to_csv(const std::vector<bench::AccuracyRow>& rows)
{
    std::string text = "texture,mode,method,precision,level,lane_form,lanes,step_wavelengths,median_ns,p99_ns,height_"
                       "only_ns,wavelengths,"
                       "height_error_max,height_error_rms,gradient_error_max,gradient_error_rms,frontier\n";
    for (const AccuracyRow& row : rows)
        for (const bench::Accuracy& error : row.errors)
            text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.texture, mode_of(row),
                                row.method, row.precision, row.level, row.lane_form, row.lanes, row.step, row.median_ns,
                                row.p99_ns, row.height_only_ns, error.wavelengths, error.height_max, error.height_rms,
                                error.gradient_max, error.gradient_rms, row.is_on_frontier ? 1 : 0);
    return text;
}

Json to_json(const bench::AccuracyRow& row)
{
    Json errors = Json::array();
    for (const bench::Accuracy& error : row.errors)
        errors.push_back({{"wavelengths", error.wavelengths},
                          {"height_error_max", finite_or_null(error.height_max)},
                          {"height_error_rms", finite_or_null(error.height_rms)},
                          {"gradient_error_max", finite_or_null(error.gradient_max)},
                          {"gradient_error_rms", finite_or_null(error.gradient_rms)}});
    return {{"texture", row.texture},
            {"mode", mode_of(row)},
            {"method", row.method},
            {"precision", row.precision},
            {"level", row.level},
            {"flags", row.flags.empty() ? Json(nullptr) : Json(row.flags)},
            {"lane_form", row.lane_form},
            {"lanes", row.lanes},
            {"step_wavelengths", row.step == 0 ? Json(nullptr) : Json(row.step)},
            {"step_is_best", row.step == 0 ? Json(nullptr) : Json(row.is_best_step)},
            {"time_ns", {{"median", row.median_ns}, {"p99", row.p99_ns}}},
            {"height_only_ns", row.height_only_ns > 0 ? Json(row.height_only_ns) : Json(nullptr)},
            {"height_error_max", errors[0]["height_error_max"]},
            {"height_error_rms", errors[0]["height_error_rms"]},
            {"gradient_error_max", errors[0]["gradient_error_max"]},
            {"gradient_error_rms", errors[0]["gradient_error_rms"]},
            {"errors", errors},
            {"frontier", row.is_on_frontier}};
}

plot::Picture draw_accuracy(const std::vector<bench::AccuracyRow>& all, Shown shown, const std::string& subtitle)
{
    using namespace plot;
    constexpr double panel_width = 230, panel_height = 170;
    const std::vector<AccuracyRow> rows = sorted(all);
    std::vector<std::string> textures;
    for (const AccuracyRow& row : rows)
        if (textures.empty() || textures.back() != row.texture) textures.push_back(row.texture);
    Picture picture(80 + 2 * (panel_width + 60), 90 + static_cast<double>(textures.size()) * (panel_height + 62), 2);
    draw_title(picture,
               shown == Shown::height ? "Error of the height over time per point"
                                      : "Error of the gradient over time per point",
               "blue: Haptel, red: plain C++ and differences; squares: largest, lines down to rms   " + subtitle);
    for (const bool is_batch : {false, true})
        for (std::size_t i = 0; i < textures.size(); ++i) {
            const Rect rect{64 + (is_batch ? panel_width + 60 : 0), 74 + static_cast<double>(i) * (panel_height + 62),
                            panel_width, panel_height};
            const Axes axes{
                rect,
                {fmt::format("{}, {}: ns", textures[i], is_batch ? "many points" : "one point"), 1, 1e4, true},
                {"error", 1e-17, 10, true}};
            draw_grid(picture, axes);
            for (const AccuracyRow& row : rows) {
                if (row.texture != textures[i] || row.is_batch != is_batch) continue;
                const bool is_ours = row.method == "haptel";
                const bench::Accuracy& near = row.errors[0];
                const double largest = shown == Shown::height ? near.height_max : near.gradient_max;
                const double rms_error = shown == Shown::height ? near.height_rms : near.gradient_rms;
                const double error = std::clamp(largest, 1e-17, 10.0);
                const Point at = axes.at(std::clamp(row.median_ns, 1.0, 1e4), error);
                const double half = is_ours ? 3 : 2;
                const Point rms = axes.at(std::clamp(row.median_ns, 1.0, 1e4), std::clamp(rms_error, 1e-17, 10.0));
                picture.line(at, rms, is_ours ? accent : accent_2, 0.7);
                picture.fill({at.x - half, at.y - half, 2 * half, 2 * half}, is_ours ? accent : accent_2);
                const bool is_left = row.lane_form == "iterations"; // beside the same without
                if (is_ours)
                    picture.text({at.x + (is_left ? -5 : 5), at.y + 3}, row.precision + (is_left ? ", iterations" : ""),
                                 {6.5, accent, is_left ? Align::right : Align::left});
            }
            draw_axes(picture, axes);
        }
    return picture;
}

} // namespace haptel::tools
