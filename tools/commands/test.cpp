// haptel test: is every texture's gradient the gradient of its height, to rounding?
#include "jit/check/check_gradient.h"
#include "tools/arguments/quantity.h"
#include "tools/arguments/texture_argument.h"
#include "tools/arguments/texture_files.h"
#include "tools/commands/command.h"
#include "tools/output/terminal.h"
#include "tools/report/test_report.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <memory>

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
};

AmplifiedPlace place_of(const lang::SourceSet& sources, const lang::Span& span)
{
    const std::string_view text = sources.text(span);
    const size_t line_end = text.find('\n');
    return {sources.file(span.file).name, std::string(text.substr(0, line_end)) + (line_end == text.npos ? "" : " ..."),
            sources.position(span.file, span.begin)};
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

    void test(const TextureTarget& target);
    TestReport report;

private:
    const TestOptions& options;
    jit::CheckBox box;
    TextureRequest request; // parameters at their defaults, or as set

    void test(const TextureTarget& target, const std::shared_ptr<const jit::CompiledProgram>& program,
              const char* name);
};

void TestRun::test(const TextureTarget& target, const std::shared_ptr<const jit::CompiledProgram>& program,
                   const char* name)
{
    TestedTexture tested{target.file, name, {}, {}, 0};
    request.parameters.clear(); // each texture takes the values whose names it has
    for (const ir::Parameter& parameter : program->source_of(*program->find(name)).parameters)
        for (const auto& value : options.parameters)
            if (value.first == parameter.name) request.parameters.push_back(value);
    const auto start = std::chrono::steady_clock::now();
    const TextureResult bound = jit::make_binding(program, name, request, jit::For::figures);
    if (bound.binding)
        tested.check = jit::check_gradient(program, *bound.binding, box, options.points, options.seed);
    else
        tested.fault = bound.diagnostics;
    if (tested.check && tested.check->amplified)
        tested.amplified = place_of(program->sources(), tested.check->amplified->span);
    tested.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.textures.push_back(std::move(tested));
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
    for (const haptel_texture& texture : compiled.program->textures())
        if (texture.height_gradient) test(target, compiled.program, texture.name);
}

ExitCode run(const TestOptions& options)
{
    TestRun tests(options);
    const std::vector<TextureTarget> targets = texture_targets(options.paths);
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
        app.add_subcommand("test", "Compare textures with a 113-bit oracle and with finite differences");
    command->add_option("paths", options->paths, "Texture files, FILE:NAME, or folders of them")
        ->required()
        ->type_name("PATH");
    add_parameters(*command, options->parameters);
    add_length(*command, "--box", options->box_m, "Side of the cube of test points round the origin [50mm]");
    add_length(*command, "--footprint", options->footprint_m, "Smallest wavelength worth rendering [0]",
               NumberRange::not_negative);
    command->add_option("--points", options->points, "Points per texture")
        ->check(CLI::Range(1, 10'000'000))
        ->capture_default_str();
    command->add_option("--seed", options->seed, "Seed of the points")->capture_default_str();
    command->add_flag("--json", options->json, "One JSON object on standard output");
    command->add_option("--junit", options->junit, "Report for continuous integration")->type_name("FILE");
    set_examples(*command, "  haptel test rock.haptel\n"
                           "  haptel test stdlib examples --junit report.xml\n"
                           "  haptel test rock.haptel:rock --points 10000 --box 0.2m --json");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
