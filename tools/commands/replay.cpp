// haptel replay: gives a recorded hand the scene as it is now, and says where the forces are no longer those that were
// recorded.
#include "runtime/servo/recording.h"
#include "runtime/servo/trace_csv.h"
#include "tools/commands/command.h"
#include "tools/output/terminal.h"
#include "tools/replay/felt_difference.h"
#include "tools/replay/replay_run.h"
#include "tools/replay/traced_files.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <string>

namespace haptel::tools {

namespace {

struct ReplayOptions {
    std::string file, scene, csv;
    double tolerance = 0;
    bool json = false;
};

ExitCode export_csv(const ReplayOptions& options, const runtime::TraceResult& recorded)
{
    if (!recorded.note.empty()) say_warning(recorded.note);
    std::ofstream out(options.csv);
    runtime::write_trace_header(out);
    for (const runtime::TickRecord& record : recorded.records) runtime::write_trace_row(out, record);
    if (out.close(); !out) {
        say_error(fmt::format("cannot write '{}'", options.csv));
        return ExitCode::findings;
    }
    return recorded.error.empty() ? ExitCode::fine : ExitCode::findings;
}

ExitCode replay(const ReplayOptions& options)
{
    const runtime::TraceResult recorded = runtime::read_trace(options.file);
    if (!recorded.error.empty()) say_error(recorded.error);
    if (!options.csv.empty()) return export_csv(options, recorded);
    if (!recorded.error.empty()) return ExitCode::findings;
    const std::filesystem::path scene =
        options.scene.empty() ? scene_of(options.file, recorded) : std::filesystem::path(options.scene);
    if (scene.empty()) {
        say_error(fmt::format("{} does not say of which scene it is, as no trace.csv does: name it, haptel replay {} "
                              "SCENE.toml",
                              options.file, options.file));
        return ExitCode::misuse;
    }
    const std::vector<ChangedFile> changed =
        recorded.origin ? changed_files(*recorded.origin, scene) : std::vector<ChangedFile>{};
    const Replayed now = replay_run(scene, options.file, recorded);
    fmt::print(stderr, "{}", now.diagnostics);
    if (!now.fault.empty()) say_error(options.file + ": " + now.fault);
    if (now.ticks.empty()) {
        if (options.scene.empty() && !std::filesystem::exists(scene))
            say_error(fmt::format("the scene has moved since? Name it: haptel replay {} SCENE.toml", options.file));
        return ExitCode::findings;
    }
    const FeltDifference difference = compare_felt(recorded.records, now.ticks, options.tolerance);
    if (options.json) {
        Json json = to_json(difference, now.objects);
        json["recording"] = options.file;
        json["scene"] = scene.string();
        json["tolerance"] = options.tolerance;
        json["changed"] = to_json(changed);
        print_json(json);
    } else {
        if (difference.is_equal())
            fmt::print("{} ticks replayed: every force {}\n", difference.replayed,
                       options.tolerance > 0 ? fmt::format("is within {:g} N of the recorded one", options.tolerance)
                                             : "equals the recorded one");
        for (const std::string& line : lines_of(difference, now.objects)) fmt::print("{}\n", line);
        for (const std::string& line : lines_of(changed)) fmt::print("{}\n", line);
    }
    return difference.is_equal() && now.fault.empty() ? ExitCode::fine : ExitCode::findings;
}

} // namespace

Command replay_command(CLI::App& app)
{
    const auto options = std::make_shared<ReplayOptions>();
    CLI::App* command =
        app.add_subcommand("replay", "Feel a recording again, and compare the forces with those recorded");
    command->add_option("recording", options->file, "Recording of `haptel record`, or a trace.csv")
        ->required()
        ->type_name("FILE");
    command->add_option("scene", options->scene, "Scene to feel [the one that was recorded]")->type_name("SCENE.toml");
    command
        ->add_option("--tolerance", options->tolerance,
                     "Forces so far apart are equal, N; torques, N m [0: the same numbers]")
        ->check(CLI::NonNegativeNumber)
        ->type_name("N");
    command->add_option("--csv", options->csv, "Writes the recording to this file as trace.csv, and feels nothing")
        ->type_name("FILE");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel replay run.haptrace\n"
                           "  haptel replay run.haptrace other.toml --json\n"
                           "  haptel replay run/trace.csv scene.toml --tolerance 1e-9\n"
                           "  haptel replay run.haptrace --csv trace.csv");
    return {command, [options] { return replay(*options); }};
}

} // namespace haptel::tools
