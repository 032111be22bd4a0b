// haptel test: is every texture's gradient the gradient of its height, to rounding?
#include "jit/check_gradient.h"
#include "jit/source_file.h"
#include "lang/parser.h"
#include "tools/command.h"
#include "tools/quantity.h"
#include "tools/terminal.h"
#include "tools/test_report.h"
#include "tools/texture_argument.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <memory>
#include <set>
#include <tuple>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

struct TestOptions {
    std::vector<std::string> paths;
    ParameterTexts parameters;
    double box_m = 0.05, footprint_m = 0;
    uint32_t points = jit::default_check_points;
    uint64_t seed = 1;
    bool json = false;
    std::string junit;
};

// A texture file, and one texture of it if only that is meant.
struct Target {
    std::string file, texture;
    bool operator<(const Target& other) const { return std::tie(file, texture) < std::tie(other.file, other.texture); }
};

// Folders stand for the texture files in them, at any depth, by name.
std::vector<Target> targets_of(const std::vector<std::string>& paths)
{
    std::vector<Target> targets;
    for (const std::string& path : paths) {
        std::error_code error;
        if (!fs::is_directory(path, error)) {
            const bool is_file = fs::exists(path, error);
            const jit::TextureReference reference = jit::split_reference(path);
            targets.push_back(is_file ? Target{path, {}} : Target{reference.file, reference.texture});
            continue;
        }
        std::set<Target> found;
        constexpr auto careful = fs::directory_options::skip_permission_denied;
        for (fs::recursive_directory_iterator entry(path, careful, error), end; !error && entry != end;
             entry.increment(error))
            if (entry->path().extension() == ".haptel" && entry->is_regular_file(error))
                found.insert({entry->path(), {}});
        targets.insert(targets.end(), found.begin(), found.end());
    }
    return targets;
}

// A file of functions alone is for others to import: there is nothing to test in it.
bool has_textures(const std::string& file)
{
    jit::SourceText source = jit::read_source(file);
    if (!source.error.empty()) return true; // the compiler says why it cannot be read
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    const lang::ast::File tree = lang::parse(sources, sources.add({file, std::move(source.text)}), diagnostics);
    return diagnostics.has_errors() || !tree.textures.empty();
}

class TestRun {
public:
    explicit TestRun(const TestOptions& chosen) : options(chosen)
    {
        for (size_t i = 0; i < 3; ++i) {
            box.minimum_m[i] = request.box_minimum_m[i] = -options.box_m / 2;
            box.maximum_m[i] = request.box_maximum_m[i] = options.box_m / 2;
        }
        request.footprint_m = options.footprint_m;
    }

    void test(const Target& target);
    TestReport report;

private:
    const TestOptions& options;
    jit::CheckBox box;
    TextureRequest request; // parameters at their defaults, or as set

    void test(const Target& target, const std::shared_ptr<const jit::CompiledProgram>& program, const char* name);
};

void TestRun::test(const Target& target, const std::shared_ptr<const jit::CompiledProgram>& program, const char* name)
{
    TestedTexture tested{target.file, name, {}, {}, 0};
    request.parameters.clear(); // each texture takes the values whose names it has
    for (const ir::Parameter& parameter : program->source_of(*program->find(name)).parameters)
        for (const auto& value : options.parameters)
            if (value.first == parameter.name) request.parameters.push_back(value);
    const auto start = std::chrono::steady_clock::now();
    const TextureResult bound = jit::make_binding(program, name, request, jit::Unbounded::allowed);
    if (bound.binding)
        tested.check = jit::check_gradient(program, *bound.binding, box, options.points, options.seed);
    else
        tested.fault = bound.diagnostics;
    tested.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.textures.push_back(std::move(tested));
}

void TestRun::test(const Target& target)
{
    if (!has_textures(target.file)) return;
    jit::TextureOptions compile;
    compile.only_texture = target.texture;
    compile.entries = jit::Entries::height_gradient;
    const jit::CompiledTextures compiled = jit::compile_texture_file(target.file, compile);
    fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
    if (!compiled.program) {
        report.textures.push_back({target.file, {}, {}, "it does not compile", 0});
        return;
    }
    for (const haptel_texture& texture : compiled.program->textures())
        if (texture.height_gradient) test(target, compiled.program, texture.name);
}

ExitCode run(const TestOptions& options)
{
    TestRun tests(options);
    const std::vector<Target> targets = targets_of(options.paths);
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
    if (tests.report.textures.empty()) {
        say_error("there is no texture in " + fmt::format("{}", fmt::join(options.paths, ", ")));
        return ExitCode::findings;
    }
    return tests.report.failed() == 0 ? ExitCode::fine : ExitCode::findings;
}

} // namespace

Command test_command(CLI::App& app)
{
    const auto options = std::make_shared<TestOptions>();
    CLI::App* command =
        app.add_subcommand("test", "Check textures against a 113-bit oracle and its differences, for authors and CI");
    command->add_option("paths", options->paths, "Texture files, FILE:NAME, or folders of them")
        ->required()
        ->type_name("PATH");
    add_parameters(*command, options->parameters);
    add_length(*command, "--box", options->box_m, "Side of the cube of test points round the origin [50mm]");
    add_length(*command, "--footprint", options->footprint_m, "Smallest wavelength worth rendering [0]",
               LengthRange::not_negative);
    command->add_option("--points", options->points, "Points per texture")
        ->check(CLI::Range(1, 10'000'000))
        ->capture_default_str();
    command->add_option("--seed", options->seed, "Of the points")->capture_default_str();
    command->add_flag("--json", options->json, "One JSON object on standard output");
    command->add_option("--junit", options->junit, "Report for continuous integration")->type_name("FILE");
    set_examples(*command, "  haptel test rock.haptel\n"
                           "  haptel test stdlib examples --junit report.xml\n"
                           "  haptel test rock.haptel:rock --points 10000 --box 0.2m --json");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
