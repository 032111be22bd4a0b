// haptel bench: figures with the machine they were taken on.
#include "bench/machine.h"
#include "tools/arguments/precisions.h"
#include "tools/arguments/quantity.h"
#include "tools/commands/command.h"
#include "tools/figures/bench_accuracy.h"
#include "tools/figures/bench_batch.h"
#include "tools/figures/bench_compile.h"
#include "tools/figures/bench_math.h"
#include "tools/figures/bench_scale.h"
#include "tools/figures/bench_servo.h"
#include "tools/figures/bench_skip.h"
#include "tools/figures/bench_tick.h"
#include "tools/figures/bench_verdict.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <thread>

namespace haptel::tools {
namespace {

struct BenchOptions {
    std::string what = "compile", out;
    bool quick = false, json = false;
    // compile, in a process that another one has started: this texture alone, edited so
    std::string first;
    uint32_t edit = 0;
    // of batch alone
    std::vector<const CLI::Option*> of_batch;
    std::vector<std::string> paths; // of compile, too
    ParameterTexts parameters;
    std::string precision = "mixed";
    size_t points = 1'000'000;
    double box_m = 0.05;
};

std::string in_words(const bench::Machine& machine)
{
    return fmt::format("{}, {} threads, {}", machine.cpu, machine.cores, machine.isa);
}

// What one kind of figures gives: rows for scripts, a table for people, and files beside them.
struct Figures {
    Json rows = Json::array();
    std::vector<std::pair<std::string, Json>> more; // by name
    std::string table, csv;
    std::vector<std::pair<std::string, std::shared_ptr<plot::Picture>>> pictures; // by file name
    std::string error;                                                            // why there are none
};

template <typename Row>
Figures figures_of(const std::vector<Row>& rows)
{
    Figures figures;
    for (const Row& row : rows) figures.rows.push_back(to_json(row));
    figures.table = to_table(rows);
    figures.csv = to_csv(rows);
    return figures;
}

// Of a benchmark that tells how far it is.
template <typename Bench>
auto measured(Bench bench, const BenchOptions& options)
{
    Progress progress;
    return bench(options.quick, [&](double share) { progress.show(share); });
}

Figures compile_figures(const BenchOptions& options)
{
    if (!options.paths.empty()) {
        std::string error;
        Figures figures = figures_of(edit_rows(options.paths, options.quick, error));
        figures.error = error;
        return figures;
    }
    const std::vector<bench::CompileRow> rows = compile_rows(options.quick);
    Figures figures = figures_of(rows);
    figures.more.emplace_back("growth", bench::growth(rows, &bench::CompileRow::front_end));
    figures.more.emplace_back("growth_to_code", bench::growth(rows, &bench::CompileRow::warm));
    figures.table += growth_line(rows);
    return figures;
}

Figures accuracy_figures(const BenchOptions& options)
{
    const std::vector<bench::AccuracyRow> rows = measured(bench::bench_accuracy, options);
    Figures figures = figures_of(rows);
    figures.more.emplace_back("alternatives", alternatives_json(rows));
    figures.more.emplace_back("differences", differences_json(rows));
    const bench::Machine machine = bench::this_machine();
    const std::string where = in_words(machine) + ", commit " + machine.commit;
    for (const auto& [name, shown] :
         {std::pair{"accuracy.png", Shown::gradient}, {"accuracy_height.png", Shown::height}})
        figures.pictures.emplace_back(name, std::make_shared<plot::Picture>(draw_accuracy(rows, shown, where)));
    return figures;
}

Figures batch_figures(const BenchOptions& options)
{
    Figures figures;
    const std::vector<std::string> paths =
        options.paths.empty() ? std::vector<std::string>{"stdlib", "examples"} : options.paths;
    const BatchTextures found =
        batch_textures(paths, options.parameters, options.box_m, precision_of(options.precision));
    figures.error = found.error;
    if (figures.error.empty() && found.textures.empty())
        figures.error = fmt::format("there is no texture in {}: name files or folders of them, haptel bench batch PATH",
                                    fmt::join(paths, ", "));
    if (!figures.error.empty()) return figures;
    bench::BatchOptions batch{options.points, 9, {1}, options.box_m};
    if (const unsigned all = std::thread::hardware_concurrency(); all > 1) batch.threads.push_back(all);
    if (options.quick) batch.points = std::min<size_t>(batch.points, 50'000), batch.rounds = 3;
    const std::vector<bench::BatchRow> rows = measured(
        [&](bool, const auto& progress) { return bench::bench_batch(found.textures, batch, progress); }, options);
    for (const bench::BatchRow& row : rows) figures.rows.push_back(to_json(row, options.precision));
    Json means = Json::array();
    for (const bench::BatchSummary& summary : bench::summary(rows)) means.push_back(to_json(summary));
    figures.more.emplace_back("points", batch.points);
    figures.more.emplace_back("means", means);
    figures.table = fmt::format("{} points, {}, {} lanes\n", batch.points, options.precision, rows[0].lanes);
    figures.table += to_table(rows);
    figures.csv = to_csv(rows, options.precision);
    return figures;
}

Figures tick_figures(const BenchOptions& options)
{
    const std::vector<bench::TickRow> rows = measured(bench::bench_tick, options);
    Figures figures = figures_of(rows);
    figures.more.emplace_back("growth", growth_json(rows));
    figures.table += growth_table(rows);
    return figures;
}

Figures scale_figures(const BenchOptions& options)
{
    const bench::Scale scale = measured(bench::bench_scale, options);
    Figures figures;
    for (const bench::ScaleRow& row : scale.rows) figures.rows.push_back(to_json(row));
    Json builds = Json::array();
    for (const bench::BuildRow& row : scale.builds) builds.push_back(to_json(row));
    figures.more.emplace_back("builds", builds);
    figures.table = to_table(scale);
    figures.csv = to_csv(scale);
    return figures;
}

struct Kind {
    const char *name, *measures;
    Figures (*figures)(const BenchOptions&);
};
constexpr Kind kinds[] = {
    {"compile", "from text to code", compile_figures},
    {"accuracy", "error of the gradient against time, ours and plain C++", accuracy_figures},
    {"batch", "many points of every texture", batch_figures},
    {"math", "elementary functions", [](const auto& of) { return figures_of(measured(bench::bench_math, of)); }},
    {"tick", "of the servo, by probe, mesh and number of objects", tick_figures},
    {"scale", "how that grows, and what a surface costs", scale_figures},
    {"skip", "what a tick leaves out", [](const auto& of) { return figures_of(measured(bench::bench_skip, of)); }},
    {"servo", "how late it wakes, at 250 Hz to 10 kHz, ordinary and real-time, alone and beside others",
     [](const auto& of) { return figures_of(measured(bench::bench_servo, of)); }},
};

// Every line of a table tells where it was taken.
std::string stamped(const std::string& csv, const bench::Machine& machine)
{
    std::string text;
    for (size_t start = 0, end; (end = csv.find('\n', start)) != std::string::npos; start = end + 1)
        text += csv.substr(start, end - start) +
                (start == 0 ? ",commit,isa,cpu\n"
                            : fmt::format(",{},{},\"{}\"\n", machine.commit, machine.isa, machine.cpu));
    return text;
}

// Empty, or why not.
std::string write_files(const std::string& folder, const std::string& what, const Json& json, const Figures& figures,
                        const bench::Machine& machine)
{
    std::error_code ignored; // a folder that cannot be made cannot be written to either
    std::filesystem::create_directories(folder, ignored);
    const std::filesystem::path path(folder);
    std::vector<std::pair<std::string, std::string>> texts{{what + ".json", to_text(json) + "\n"}};
    if (!figures.csv.empty()) texts.emplace_back(what + ".csv", stamped(figures.csv, machine));
    for (const auto& [name, text] : texts)
        if (const std::string why = write_file(path / name, text); !why.empty())
            return fmt::format("cannot write '{}': {}", (path / name).string(), why);
    for (const auto& [name, picture] : figures.pictures)
        if (std::string error = picture->write_png((path / name).string()); !error.empty()) return error;
    return {};
}

ExitCode run(const BenchOptions& options)
{
    if (!options.first.empty()) {
        const std::optional<double> time_ms = bench::first_compile(options.first, options.edit);
        if (time_ms) fmt::print("{}\n", *time_ms);
        return time_ms ? ExitCode::fine : ExitCode::misuse;
    }
    for (const CLI::Option* option : options.of_batch) {
        const bool is_file = option->get_positional();
        if (options.what == "batch" || (is_file && options.what == "compile") || option->count() == 0) continue;
        say_error(is_file ? "texture files are for haptel bench batch and compile: the others bring their own"
                          : fmt::format("{} is for haptel bench batch: the others bring their own points",
                                        option->get_name()));
        return ExitCode::misuse;
    }
    const bench::Machine machine = bench::this_machine();
    const std::string name = in_words(machine);
    const Figures figures = std::ranges::find(kinds, options.what, &Kind::name)->figures(options);
    if (!figures.error.empty()) {
        say_error(figures.error);
        return ExitCode::findings;
    }
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
    const std::string error = write_files(options.out, options.what, json, figures, machine);
    if (error.empty()) return ExitCode::fine;
    say_error(error);
    return ExitCode::findings;
}

} // namespace

Command bench_command(CLI::App& app)
{
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Measure compile times, accuracy, batches, math, the tick of the "
                                                    "servo, its scale, its skip and servo deadlines");
    std::vector<std::string> names;
    std::string measures = "What to measure:";
    for (const Kind& kind : kinds) {
        names.emplace_back(kind.name);
        measures += fmt::format("\n  {}: {}", kind.name, kind.measures);
    }
    command->add_option("what", options->what, measures)->check(CLI::IsMember(names))->capture_default_str();
    options->of_batch = {
        command
            ->add_option("paths", options->paths,
                         "batch: texture files, FILE:NAME, or folders [stdlib examples]; "
                         "compile: texture files that are edited [examples, and long texts]")
            ->type_name("PATH"),
        command->add_option("--points", options->points, "batch: number of points")
            ->check(CLI::Range(1, 100'000'000))
            ->capture_default_str(),
        command->add_option("--precision", options->precision, "batch: f64, mixed or f32")
            ->check(CLI::IsMember({"f64", "mixed", "f32"}))
            ->capture_default_str(),
        add_length(*command, "--box", options->box_m, "batch: side of the cube of points round the origin [50mm]"),
        add_parameters(*command, options->parameters)};
    command->add_option("--first", options->first, "")->group(""); // not for people
    command->add_option("--edit", options->edit, "")->group("");
    command->add_flag("--quick", options->quick, "Fewer rounds and points");
    command->add_option("--out", options->out, "Folder for WHAT.json, WHAT.csv and pictures")->type_name("DIR");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel bench compile\n"
                           "  haptel bench compile mine.haptel\n"
                           "  haptel bench accuracy --out figures\n"
                           "  haptel bench batch stdlib examples --set picture=examples/scenes/waves.png\n"
                           "  haptel bench math --out figures\n"
                           "  haptel bench tick --quick\n"
                           "  haptel bench scale --out figures\n"
                           "  haptel bench skip --quick --json\n"
                           "  haptel bench servo\n"
                           "  haptel bench compile --quick --json --out figures");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
