// haptel fit: parameters of a texture from what was measured of a surface.
#include "jit/fit/fit.h"
#include "tools/arguments/quantity.h"
#include "tools/arguments/texture_argument.h"
#include "tools/commands/command.h"
#include "tools/fit/fit_report.h"
#include "tools/fit/measured_file.h"
#include "tools/output/json.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace haptel::tools {

namespace {

struct FitOptions {
    TextureArgument texture;
    ParameterTexts parameters;
    std::string measured, preset;
    double pixel_m = 0, white_m = 0;
    std::optional<double> speed_m_per_s, stiffness_n_per_m;
    glm::dvec2 direction{1, 0};
    uint64_t seed = 1;
    bool json = false;
};

ExitCode misuse(const std::string& text)
{
    say_error(text);
    return ExitCode::misuse;
}

ExitCode refused(const std::string& error, const std::string& hint)
{
    say_error(error);
    if (!hint.empty()) fmt::print(stderr, "  hint: {}\n", hint);
    return ExitCode::findings;
}

// The preset beside the texture that it is of, in a file of its own that imports it.
std::string preset_file(const FitOptions& options, const haptel_texture& texture, const jit::FitResult& result)
{
    const std::filesystem::path out = options.preset, base = options.texture.file;
    std::error_code ignored;
    const std::filesystem::path folder = std::filesystem::absolute(out, ignored).parent_path();
    const std::filesystem::path import = std::filesystem::absolute(base, ignored).lexically_relative(folder);
    return fmt::format("import \"{}\" as base;\n\n{}", import.generic_string(),
                       preset_text("fitted", "base." + options.texture.name, texture, result,
                                   std::filesystem::path(options.measured).filename().string()));
}

ExitCode run(const FitOptions& options)
{
    const bool is_stroke = is_stroke_file(options.measured);
    if (!is_stroke && (options.pixel_m == 0 || options.white_m == 0))
        return misuse("a picture of heights needs --scale, the side of a pixel, and --height, the height of white");
    if (is_stroke && !options.speed_m_per_s) return misuse("a stroke needs --speed, of the hand over the surface");
    if (!options.preset.empty())
        if (const std::string why = why_not_written(options.preset); !why.empty())
            return refused(fmt::format("cannot write '{}': {}", options.preset, why), {});

    MeasuredHeights heights;
    MeasuredStroke stroke;
    if (is_stroke) {
        stroke = read_stroke(options.measured);
        if (!stroke.error.empty()) return refused(stroke.error, stroke.hint);
        stroke.stroke.speed_m_per_s = *options.speed_m_per_s;
        if (stroke.stroke.of == jit::Stroke::Of::force && !options.stiffness_n_per_m)
            return misuse("a stroke of forces needs --stiffness, newtons per metre of height");
        stroke.stroke.stiffness_n_per_m = options.stiffness_n_per_m.value_or(0);
        stroke.stroke.direction[0] = options.direction.x, stroke.stroke.direction[1] = options.direction.y;
    } else {
        heights = read_heights(options.measured, options.pixel_m, options.white_m);
        if (!heights.error.empty()) return refused(heights.error, heights.hint);
    }

    jit::TextureOptions compile;
    compile.entries = jit::Entries::both_and_batches;
    compile.precision = jit::Precision::f64;
    compile.effort = jit::Effort::full;
    const jit::CompiledTextures compiled = jit::compile_texture_file(options.texture.file, compile);
    fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
    if (!compiled.program) return ExitCode::findings;
    const jit::FitRequest request{options.texture.name, options.parameters, options.seed};
    const jit::FitResult result = is_stroke ? jit::fit_stroke(compiled.program, request, stroke.stroke)
                                            : jit::fit_heights(compiled.program, request, heights.map);
    if (!result.failure.empty()) return refused(result.failure, {});

    const haptel_texture& texture = *compiled.program->find(options.texture.name);
    if (!options.preset.empty())
        if (const std::string why = write_file(options.preset, preset_file(options, texture, result)); !why.empty())
            return refused(fmt::format("cannot write '{}': {}", options.preset, why), {});
    if (options.json)
        print_json(fit_json(texture, result));
    else
        fmt::print("{}", fit_text(texture, result));
    return ExitCode::fine;
}

} // namespace

Command fit_command(CLI::App& app)
{
    const auto options = std::make_shared<FitOptions>();
    CLI::App* command =
        app.add_subcommand("fit", "Parameters of a texture from a measured height map or a recorded stroke");
    add_texture(*command, options->texture);
    command
        ->add_option("--to", options->measured,
                     "A picture of heights (PNG, TIFF, EXR ...), or a table of a stroke: time_s and force_n or "
                     "acceleration_m_per_s2")
        ->required()
        ->type_name("PICTURE|FILE.csv");
    add_length(*command, "--scale", options->pixel_m, "Side of a pixel");
    add_length(*command, "--height", options->white_m,
               "Height of white above black; of 1 in a picture of real numbers");
    add_number(*command, "--speed", options->speed_m_per_s, "Of the hand along the stroke, m/s", NumberRange::positive);
    add_number(*command, "--stiffness", options->stiffness_n_per_m,
               "Of what pressed the tip: newtons of force per metre of height", NumberRange::positive);
    add_parsed(*command, "--direction", "X,Y", options->direction, parse_direction2,
               "Of the stroke over the texture [1,0]");
    add_parameters(*command, options->parameters);
    command->add_option("--seed", options->seed, "Of the guesses that the search begins with [1]");
    command->add_option("--preset", options->preset, "Write the texture `fitted`, a preset with what was found")
        ->type_name("FILE.haptel");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command,
                 "  haptel fit wood.haptel:wood --to scan.png --scale 20um --height 0.3mm --preset oak.haptel\n"
                 "  haptel fit rock.haptel:rock --to stroke.csv --speed 0.1 --stiffness 700 --set octaves=5 --json");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
