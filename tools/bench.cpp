// haptel bench: figures with the machine they were taken on.
#include "bench/machine.h"
#include "tools/bench_accuracy.h"
#include "tools/bench_compile.h"
#include "tools/command.h"
#include "tools/terminal.h"

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

// What one kind of figures gives: rows for scripts, a table for people, and files beside them, by name.
struct Figures {
    Json rows = Json::array();
    std::vector<std::pair<std::string, Json>> more;
    std::string table;
    std::vector<std::pair<std::string, std::string>> texts;
    std::shared_ptr<plot::Picture> picture;
};

Figures compile_figures(bool quick)
{
    const std::vector<bench::CompileRow> rows = bench::bench_compile(quick);
    Figures figures;
    for (const bench::CompileRow& row : rows) figures.rows.push_back(to_json(row));
    figures.more.emplace_back("growth", bench::growth(rows));
    figures.table = to_table(rows);
    return figures;
}

Figures accuracy_figures(bool quick, const std::string& machine)
{
    Progress progress;
    const std::vector<bench::AccuracyRow> rows =
        bench::bench_accuracy(quick, [&](double share) { progress.show(share); });
    Figures figures;
    for (const bench::AccuracyRow& row : rows) figures.rows.push_back(to_json(row));
    figures.table = to_table(rows);
    figures.texts.emplace_back("accuracy.csv", to_csv(rows));
    figures.picture = std::make_shared<plot::Picture>(draw_accuracy(rows, machine));
    return figures;
}

// Empty, or why not.
std::string write_files(const std::string& folder, const std::string& what, const Json& json, const Figures& figures)
{
    std::error_code ignored; // a folder that cannot be made cannot be written to either
    std::filesystem::create_directories(folder, ignored);
    const std::filesystem::path path(folder);
    std::vector<std::pair<std::string, std::string>> texts = figures.texts;
    texts.emplace_back(what + ".json", to_text(json) + "\n");
    for (const auto& [name, text] : texts) {
        std::ofstream written(path / name);
        written << text;
        written.close();
        if (!written) return fmt::format("cannot write '{}'", (path / name).string());
    }
    return figures.picture ? figures.picture->write_png((path / (what + ".png")).string()) : "";
}

ExitCode run(const BenchOptions& options)
{
    const bench::Machine machine = bench::this_machine();
    const std::string name = fmt::format("{}, {} threads, {}", machine.cpu, machine.cores, machine.isa);
    const Figures figures = options.what == "compile"
                                ? compile_figures(options.quick)
                                : accuracy_figures(options.quick, fmt::format("{}, commit {}", name, machine.commit));
    Json json{{"machine", name},
              {"isa", machine.isa},
              {"commit", machine.commit},
              {"flags", machine.compiler + " " + machine.flags},
              {"rows", figures.rows}};
    for (const auto& [key, value] : figures.more) json[key] = value;
    if (options.json)
        print_json(json);
    else
        fmt::print("{}, commit {}, {} {}\n{}", name, machine.commit, machine.compiler, machine.flags, figures.table);
    if (options.out.empty()) return ExitCode::fine;
    const std::string error = write_files(options.out, options.what, json, figures);
    if (error.empty()) return ExitCode::fine;
    say_error(error);
    return ExitCode::findings;
}

} // namespace

Command bench_command(CLI::App& app)
{
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Figures: error against time, and how long text takes to code");
    command
        ->add_option("what", options->what,
                     "compile: from text to code; accuracy: error of the gradient against time, ours and plain C++")
        ->check(CLI::IsMember({"compile", "accuracy"}))
        ->capture_default_str();
    command->add_flag("--quick", options->quick, "Fewer rounds and points");
    command->add_option("--out", options->out, "Folder for WHAT.json, and accuracy.csv and accuracy.png")
        ->type_name("DIR");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel bench compile\n"
                           "  haptel bench accuracy --out figures\n"
                           "  haptel bench compile --quick --json --out figures");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
