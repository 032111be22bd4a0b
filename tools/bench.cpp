// haptel bench: figures with the machine they were taken on.
#include "bench/compile_bench.h"
#include "bench/machine.h"
#include "tools/command.h"
#include "tools/json.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>

namespace haptel::tools {
namespace {

struct BenchOptions {
    std::string what = "compile", out;
    bool quick = false, json = false;
};

Json to_json(const bench::Times& times)
{
    return {{"median", times.median_ms}, {"p99", times.p99_ms}};
}

Json to_json(const bench::CompileRow& row)
{
    const bool has_code = row.first_ms > 0;
    return {{"texture", row.texture},
            {"lines", row.lines},
            {"front_end_ms", to_json(row.front_end)},
            {"first_ms", has_code ? Json(row.first_ms) : Json(nullptr)},
            {"warm_ms", has_code ? to_json(row.warm) : Json(nullptr)},
            {"cached_ms", nullptr}}; // null: there is no cache on disk
}

std::string to_table(const std::vector<bench::CompileRow>& rows)
{
    std::string text = fmt::format("{:<10} {:>6}  {:>21}  {:>9}  {:>21}\n", "texture", "lines", "front end ms (p99)",
                                   "first ms", "to code again ms (p99)");
    for (const bench::CompileRow& row : rows) {
        text += fmt::format("{:<10} {:>6}  {:>12.2f} ({:>6.2f})", row.texture, row.lines, row.front_end.median_ms,
                            row.front_end.p99_ms);
        if (row.first_ms > 0)
            text += fmt::format("  {:>9.1f}  {:>12.1f} ({:>6.1f})", row.first_ms, row.warm.median_ms, row.warm.p99_ms);
        text += "\n";
    }
    return text + fmt::format("time per line, longest over shortest: {:.2f}\n", bench::growth(rows));
}

ExitCode run(const BenchOptions& options)
{
    const bench::Machine machine = bench::this_machine();
    const std::vector<bench::CompileRow> rows = bench::bench_compile(options.quick);
    Json json{{"machine", fmt::format("{}, {} threads", machine.cpu, machine.cores)},
              {"commit", machine.commit},
              {"flags", machine.compiler + " " + machine.flags},
              {"rows", Json::array()},
              {"growth", bench::growth(rows)}};
    for (const bench::CompileRow& row : rows) json["rows"].push_back(to_json(row));
    if (options.json)
        print_json(json);
    else
        fmt::print("{}, commit {}, {} {}\n{}", json["machine"].get<std::string>(), machine.commit, machine.compiler,
                   machine.flags, to_table(rows));
    if (options.out.empty()) return ExitCode::fine;
    std::error_code ignored; // a folder that cannot be made cannot be written to either
    std::filesystem::create_directories(options.out, ignored);
    const std::string file = (std::filesystem::path(options.out) / "compile.json").string();
    std::ofstream written(file);
    written << to_text(json) << "\n";
    written.close();
    if (written) return ExitCode::fine;
    fmt::print(stderr, "haptel bench: cannot write '{}'\n", file);
    return ExitCode::findings;
}

} // namespace

Command bench_command(CLI::App& app)
{
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Figures: how long it takes from text to code");
    command->add_option("what", options->what, "compile")->check(CLI::IsMember({"compile"}))->capture_default_str();
    command->add_flag("--quick", options->quick, "Fewer rounds: done within seconds");
    command->add_option("--out", options->out, "Folder for compile.json")->type_name("DIR");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel bench compile\n"
                           "  haptel bench compile --quick --json --out figures");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
