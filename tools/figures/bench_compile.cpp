#include "tools/figures/bench_compile.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <unistd.h>

namespace haptel::tools {
namespace {

Json times_of(const bench::Times& times)
{
    return {{"median", times.median}, {"p99", times.p99}};
}

Json measured(double milliseconds)
{
    return milliseconds > 0 ? Json(milliseconds) : Json(nullptr);
}

// Names and folders here are ours and hold no quotes; one that does is not used.
std::optional<double> in_fresh_process(const std::string& texture, uint32_t edit, const std::string& cache_folder)
{
    std::error_code fault;
    const std::string command = std::filesystem::read_symlink("/proc/self/exe", fault).string();
    for (const std::string& word : {command, texture, cache_folder})
        if (word.empty() || word.find('\'') != std::string::npos) return std::nullopt;
    const std::string line = fmt::format("HAPTEL_CACHE='{}' '{}' bench compile --first '{}' --edit {}", cache_folder,
                                         command, texture, edit);
    const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(line.c_str(), "r"), pclose);
    double time_ms = 0;
    if (!output || std::fscanf(output.get(), "%lf", &time_ms) != 1) return std::nullopt;
    return time_ms;
}

} // namespace

std::vector<bench::CompileRow> compile_rows(bool quick)
{
    // Not the user's folder: what an earlier run has left there would be found, and what is left here be of no use.
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("haptel-bench-" + std::to_string(getpid()));
    setenv("HAPTEL_CACHE", folder.c_str(), 1);
    std::vector<bench::CompileRow> rows = bench::bench_compile(quick, in_fresh_process);
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return rows;
}

std::vector<bench::CompileRow> edit_rows(const std::vector<std::string>& paths, bool quick, std::string& error)
{
    std::vector<bench::Text> texts;
    for (const std::string& path : paths) {
        std::ifstream file(path);
        std::string text{std::istreambuf_iterator<char>(file), {}};
        if (!file) {
            error = fmt::format("cannot read '{}'", path);
            return {};
        }
        texts.push_back({std::filesystem::path(path).stem().string(), std::move(text)});
    }
    try {
        return bench::bench_edits(texts, quick);
    } catch (const std::runtime_error& fault) {
        error = fault.what();
        return {};
    }
}

std::string to_csv(const std::vector<bench::CompileRow>& rows)
{
    std::string text =
        "texture,lines,front_end_ms,front_end_ms_p99,warm_ms,warm_ms_p99,binding_ms,binding_ms_p99,felt_ms,felt_ms_p99,"
        "first_ms,primed_ms,cached_ms\n";
    const auto cell = [](double milliseconds) { return milliseconds > 0 ? fmt::format("{}", milliseconds) : ""; };
    for (const bench::CompileRow& row : rows)
        text +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.texture, row.lines, row.front_end.median,
                        row.front_end.p99, row.warm.median, row.warm.p99, row.binding.median, row.binding.p99,
                        row.felt.median, row.felt.p99, cell(row.first_ms), cell(row.primed_ms), cell(row.cached_ms));
    return text;
}

Json to_json(const bench::CompileRow& row)
{
    return {{"texture", row.texture},
            {"lines", row.lines},
            {"front_end_ms", times_of(row.front_end)},
            {"warm_ms", times_of(row.warm)},
            {"binding_ms", times_of(row.binding)},
            {"felt_ms", times_of(row.felt)},
            {"first_ms", measured(row.first_ms)},
            {"primed_ms", measured(row.primed_ms)},
            {"cached_ms", measured(row.cached_ms)}};
}

std::string to_table(const std::vector<bench::CompileRow>& rows)
{
    const auto cell = [](double milliseconds) {
        return milliseconds > 0 ? fmt::format("{:.1f}", milliseconds) : std::string("-");
    };
    std::string text =
        fmt::format("{:<20} {:>6} {:>10} {:>16} {:>8} {:>16} | {:>9} {:>8} {:>8}   ms, medians\n", "texture", "lines",
                    "front end", "to code (p99)", "binding", "felt (p99)", "first", "primed", "again");
    for (const bench::CompileRow& row : rows)
        text +=
            fmt::format("{:<20} {:>6} {:>10.2f} {:>8.2f} ({:>5.1f}) {:>8.2f} {:>8.2f} ({:>5.1f}) | {:>9} {:>8} {:>8}\n",
                        row.texture, row.lines, row.front_end.median, row.warm.median, row.warm.p99, row.binding.median,
                        row.felt.median, row.felt.p99, cell(row.first_ms), cell(row.primed_ms), cell(row.cached_ms));
    return text +
           "to code: in a process that has compiled before; felt: to code, and bound to an object. Right: to code, "
           "first in a fresh process, with nothing on disk, with the library's functions there, with its own "
           "code there\n";
}

std::string growth_line(const std::vector<bench::CompileRow>& rows)
{
    return fmt::format("time per line, longest over shortest: {:.2f} front end, {:.2f} to code\n",
                       bench::growth(rows, &bench::CompileRow::front_end),
                       bench::growth(rows, &bench::CompileRow::warm));
}

} // namespace haptel::tools
