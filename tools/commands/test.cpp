// haptel test: is every texture's gradient the gradient of its height, to rounding? Does every scene feel as it did?
#include "tools/arguments/feel_files.h"
#include "tools/arguments/quantity.h"
#include "tools/arguments/texture_argument.h"
#include "tools/arguments/texture_files.h"
#include "tools/check/suggested_facts.h"
#include "tools/check/test_report.h"
#include "tools/commands/command.h"
#include "tools/library/library_test.h"
#include "tools/output/terminal.h"
#include "tools/replay/feel_test.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <memory>
#include <tuple>
#include <utility>

namespace haptel::tools {

namespace {

struct TestOptions {
    std::vector<std::string> paths;
    ParameterTexts parameters;
    double box_m = 0.05, footprint_m = 0;
    uint32_t points = jit::default_check_points;
    uint64_t seed = 1;
    bool json = false;
    std::string junit;
    double feel_tolerance = tools::feel_tolerance;
    bool update_feel = false;
    bool suggest_facts = false;
    std::pair<double, double> domain = {-8, 8}; // of a function's first argument
};

class TestRun {
public:
    explicit TestRun(const TestOptions& chosen) : options(chosen) {}

    void test(const TextureTarget& target);
    TestReport report;

private:
    const TestOptions& options;

    void test(const TextureTarget& target, const std::shared_ptr<const jit::CompiledProgram>& program,
              const char* name);
    void test_promise(const TextureTarget& target, const std::shared_ptr<const jit::CompiledProgram>& program,
                      const char* name);
};

void TestRun::test(const TextureTarget& target, const std::shared_ptr<const jit::CompiledProgram>& program,
                   const char* name)
{
    TextureRequest request = request_in_cube(options.box_m, options.footprint_m);
    request.parameters = values_for(program->source_of(*program->find(name)), options.parameters);
    report.textures.push_back(test_texture(program, target.file, name, request, options.points, options.seed));
}

// A library's own test says what holds by being flat; it may measure along lines, which is long work for the oracle.
void TestRun::test_promise(const TextureTarget& target, const std::shared_ptr<const jit::CompiledProgram>& program,
                           const char* name)
{
    const auto start = std::chrono::steady_clock::now();
    TestedTexture& tested = report.textures.emplace_back(TestedTexture{target.file, name, {}, {}, 0});
    tested.fault = why_not_held(program, name);
    tested.is_held_promise = tested.fault.empty();
    tested.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void TestRun::test(const TextureTarget& target)
{
    jit::TextureOptions compile;
    compile.only_texture = target.texture;
    compile.entries = jit::Entries::height_gradient;
    const jit::CompiledTextures compiled = jit::compile_texture_file(target.file, compile);
    fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
    if (!compiled.program) {
        report.textures.push_back({target.file, {}, {}, "it does not compile", 0});
        return;
    }
    for (const haptel_texture& texture : compiled.program->textures()) {
        if (!texture.height_gradient) continue;
        if (is_library_test(target.file))
            test_promise(target, compiled.program, texture.name);
        else
            test(target, compiled.program, texture.name);
    }
}

ExitCode suggest(const TestOptions& options, bool has_points)
{
    SuggestionOptions how;
    std::tie(how.least, how.greatest) = options.domain;
    how.box_m = options.box_m, how.footprint_m = options.footprint_m;
    how.seed = options.seed, how.values = options.parameters;
    if (has_points) how.points = options.points;
    bool is_any_measured = false;
    Json all = Json::array();
    for (const TextureTarget& target : texture_targets(options.paths, true))
        for (const Suggestion& one : suggest_facts(target.file, target.texture, how)) {
            is_any_measured = is_any_measured || one.skipped.empty();
            if (options.json)
                all.push_back(one.to_json());
            else
                fmt::print("{}\n", one.text());
        }
    if (options.json) print_json({{"suggestions", std::move(all)}});
    if (!is_any_measured) say_error("nothing was measured in " + fmt::format("{}", fmt::join(options.paths, ", ")));
    return is_any_measured ? ExitCode::fine : ExitCode::findings;
}

ExitCode update(const FeelTargets& feels)
{
    bool all = true;
    for (const std::string& recording : feels.recordings) {
        std::string said;
        const bool done = update_feel(recording, said);
        all = all && done;
        if (done)
            fmt::print("{}\n", said);
        else
            say_error(said);
    }
    if (feels.recordings.empty())
        say_error("there is no feel recording, SCENE" + std::string(feel_ending) + ", to update");
    return all && !feels.recordings.empty() ? ExitCode::fine : ExitCode::findings;
}

ExitCode run(const TestOptions& options)
{
    const FeelTargets feels = feel_targets(options.paths);
    for (const std::string& scene : feels.without)
        say_error(fmt::format("{} has no feel recording to be held to; make one: haptel record {} --seconds 1 --clock "
                              "virtual --out {}",
                              scene, scene, std::filesystem::path(scene).replace_extension(feel_ending).string()));
    if (!feels.without.empty()) return ExitCode::findings;
    if (options.update_feel) return update(feels);
    TestRun tests(options);
    for (const std::string& recording : feels.recordings)
        tests.report.feels.push_back(test_feel(recording, options.feel_tolerance));
    const std::vector<TextureTarget> targets = texture_targets(feels.others);
    for (size_t i = 0; i < targets.size(); ++i) {
        if (stderr_is_terminal()) fmt::print(stderr, "\r\x1b[K[{}/{}] {}", i + 1, targets.size(), targets[i].file);
        tests.test(targets[i]);
        if (stderr_is_terminal()) fmt::print(stderr, "\r\x1b[K");
    }
    if (options.json)
        print_json(tests.report.to_json());
    else
        fmt::print("{}", tests.report.to_table());
    if (!options.junit.empty()) {
        std::ofstream out(options.junit, std::ios::binary);
        out << tests.report.to_junit();
        if (!out.flush()) {
            say_error(fmt::format("cannot write {}", options.junit));
            return ExitCode::findings;
        }
    }
    if (tests.report.count() == 0) {
        say_error("there is no texture and no feel recording in " + fmt::format("{}", fmt::join(options.paths, ", ")));
        return ExitCode::findings;
    }
    return tests.report.failed() == 0 ? ExitCode::fine : ExitCode::findings;
}

} // namespace

Command test_command(CLI::App& app)
{
    const auto options = std::make_shared<TestOptions>();
    CLI::App* command = app.add_subcommand(
        "test", "Compare textures with a 113-bit oracle and finite differences, scenes with recorded forces");
    command
        ->add_option("paths", options->paths,
                     "Texture files, FILE:NAME, scenes with a feel recording beside them, or folders of these")
        ->required()
        ->type_name("PATH");
    add_parameters(*command, options->parameters);
    add_length(*command, "--box", options->box_m, "Side of the cube of test points round the origin [50mm]");
    add_length(*command, "--footprint", options->footprint_m, "Smallest wavelength worth rendering [0]",
               NumberRange::not_negative);
    auto* points = command
                       ->add_option("--points", options->points,
                                    "Points per texture; where a search begins, with --suggest-facts [20000]")
                       ->check(CLI::Range(1, 10'000'000))
                       ->capture_default_str();
    command->add_option("--seed", options->seed, "Seed of the points")->capture_default_str();
    command->add_flag("--json", options->json, "One JSON object on standard output");
    command->add_option("--junit", options->junit, "Report for continuous integration")->type_name("FILE");
    command
        ->add_option("--feel-tolerance", options->feel_tolerance,
                     "Forces so far from the recorded ones pass, N; torques, N m [1e-9]")
        ->check(CLI::NonNegativeNumber)
        ->type_name("N");
    command->add_flag("--update-feel", options->update_feel,
                      "Makes the forces of now those that the feel recordings hold; tests nothing");
    auto* suggesting =
        command->add_flag("--suggest-facts", options->suggest_facts,
                          "Measure range, slope, curvature and class of functions and textures, and print "
                          "them as a doc comment, to be confirmed: nothing is proven");
    command
        ->add_option("--domain", options->domain,
                     "With --suggest-facts: components of a function's first argument lie between [-8 8]")
        ->type_name("LOW HIGH")
        ->needs(suggesting);
    set_examples(*command, "  haptel test rock.haptel\n"
                           "  haptel test scene.toml\n"
                           "  haptel test stdlib examples --junit report.xml\n"
                           "  haptel test rock.haptel:rock --points 10000 --box 0.2m --json\n"
                           "  haptel test --suggest-facts grain.haptel:rings --domain -2 2");
    return {command, [options, points] {
                if (!(options->domain.first < options->domain.second)) {
                    say_error("--domain needs the lesser number first");
                    return ExitCode::misuse;
                }
                return options->suggest_facts ? suggest(*options, points->count() > 0) : run(*options);
            }};
}

} // namespace haptel::tools
