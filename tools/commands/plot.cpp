// haptel plot: pictures of a texture.
#include "jit/check/oracle.h"
#include "jit/texture/texture.h"
#include "lang/abi/evaluate.h"
#include "tools/arguments/quantity.h"
#include "tools/arguments/texture_argument.h"
#include "tools/commands/command.h"
#include "tools/output/terminal.h"
#include "tools/plot/plot_texture.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace haptel::tools {

namespace {

struct PlotOptions {
    TextureArgument texture;
    ParameterTexts parameters;
    std::string out, kind = "shaded";
    double window_m = 0.02, footprint_m = 0;
    glm::dvec3 center_m{0};
    std::optional<std::pair<glm::dvec3, glm::dvec3>> section_m; // its ends
    std::optional<glm::dvec3> direction;                        // of the section, of any length
    int size_px = 512;
};

const plot::TextureKind* find_kind(const std::string& name)
{
    for (const plot::TextureKind& kind : plot::texture_kinds())
        if (kind.name == name) return &kind;
    return nullptr;
}

// The texture over a cube of the window's size round its centre, its parameters set.
TextureRequest request_of(const PlotOptions& options)
{
    TextureRequest request;
    request.parameters = options.parameters;
    request.footprint_m = options.footprint_m;
    for (int axis = 0; axis < 3; ++axis) {
        request.box_minimum_m[axis] = options.center_m[axis] - options.window_m / 2;
        request.box_maximum_m[axis] = options.center_m[axis] + options.window_m / 2;
    }
    return request;
}

// The plane z = const faces +z; mesh coordinates run from 0 to 1 over the window.
haptel_point point_of(const PlotOptions& options, const glm::dvec3& p)
{
    haptel_point point{};
    for (int axis = 0; axis < 3; ++axis) point.p[axis] = p[axis];
    point.n[2] = 1;
    for (int axis = 0; axis < 2; ++axis) {
        point.uv[axis] = (p[axis] - options.center_m[axis]) / options.window_m + 0.5;
        point.uv_dp[axis][axis] = 1 / options.window_m;
    }
    return point;
}

ExitCode draw(const PlotOptions& options)
{
    jit::TextureOptions compile;
    compile.entries = jit::Entries::both_and_batches;
    compile.only_texture = options.texture.name;
    if (options.kind == "gradient-error") compile.precision = jit::Precision::f64; // whose error it is
    const jit::CompiledTextures compiled = jit::compile_texture_file(options.texture.file, compile);
    fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
    if (!compiled.program) return ExitCode::findings;
    const TextureResult texture =
        jit::make_binding(compiled.program, options.texture.name, request_of(options), jit::For::figures);
    fmt::print(stderr, "{}", texture.diagnostics);
    if (!texture.binding) return ExitCode::findings;

    plot::TextureView view;
    view.title =
        fmt::format("{}:{}", std::filesystem::path(options.texture.file).filename().string(), options.texture.name);
    for (const auto& [name, value] : options.parameters) view.title += fmt::format("  {} = {}", name, value);
    view.on_plane = [&](const glm::dvec3& p_m) { return point_of(options, p_m); };
    view.samples = [&](std::span<const haptel_point> points, std::span<haptel_sample> samples) {
        evaluate(*texture.binding, points, samples);
    };
    jit::Oracle oracle(compiled.program, *texture.binding);
    view.true_gradient = [&](const glm::dvec3& p) {
        const jit::OracleSample truth = oracle.sample(point_of(options, p));
        return glm::dvec3(truth.gradient[0], truth.gradient[1], truth.gradient[2]);
    };
    view.center_m = options.center_m;
    view.section_m = options.section_m;
    if (options.direction) {
        const glm::dvec3 half_m = options.window_m / 2 * glm::normalize(*options.direction);
        view.section_m.emplace(options.center_m - half_m, options.center_m + half_m);
    }
    view.is_bounded =
        std::isfinite(texture.binding->facts.height_min_m) && std::isfinite(texture.binding->facts.height_max_m);
    view.say = [&](const std::string& text) { fmt::print(stderr, "{}: {}\n", options.texture.file, text); };
    view.window_m = options.window_m;
    view.size_px = options.size_px;
    const std::string error = find_kind(options.kind)->draw(view).write_png(options.out);
    if (error.empty()) return ExitCode::fine;
    say_error(error);
    return ExitCode::findings;
}

void set_section(PlotOptions& options, const std::vector<std::string>& ends)
{
    glm::dvec3 points_m[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const Parsed<glm::dvec3> point = parse_point(ends[i]);
        if (!point) throw CLI::ValidationError("--section", point.error);
        points_m[i] = point.value;
    }
    if (points_m[0] == points_m[1]) throw CLI::ValidationError("--section", "both ends are one point");
    options.section_m.emplace(points_m[0], points_m[1]);
}

void set_direction(PlotOptions& options, const std::string& text)
{
    const Parsed<glm::dvec3> direction = parse_vector(text);
    if (!direction) throw CLI::ValidationError("--direction", direction.error);
    const double length = glm::length(direction.value);
    if (!(length > 0) || !std::isfinite(length)) throw CLI::ValidationError("--direction", "it has no direction");
    options.direction = direction.value;
}

} // namespace

Command plot_command(CLI::App& app)
{
    const auto options = std::make_shared<PlotOptions>();
    CLI::App* command = app.add_subcommand("plot", "Draw a texture as a PNG picture");
    add_texture(*command, options->texture);
    command->add_option("--out", options->out, "Picture to write")->required()->type_name("X.png");

    std::vector<std::string> kinds;
    std::string shows = "What to draw:";
    for (const plot::TextureKind& kind : plot::texture_kinds()) {
        kinds.emplace_back(kind.name);
        shows += fmt::format("\n  {}: {}", kind.name, kind.shows);
    }
    auto* kind =
        command->add_option("--kind", options->kind, shows)->check(CLI::IsMember(kinds))->capture_default_str();
    add_length(*command, "--window", options->window_m, "Side of the square that is shown [20mm]");
    command->add_option("--size", options->size_px, "Side of the picture, pixels")
        ->check(CLI::Range(64, 8192))
        ->capture_default_str();
    command
        ->add_option_function<std::string>(
            "--at",
            [options](const std::string& text) {
                const Parsed<glm::dvec3> point = parse_point(text);
                if (!point) throw CLI::ValidationError(point.error);
                options->center_m = point.value;
            },
            "Centre of the square, which lies in the plane z = const [0,0,0]")
        ->type_name("X,Y,Z");
    auto* section =
        command
            ->add_option_function<std::vector<std::string>>(
                "--section", [options](const std::vector<std::string>& ends) { set_section(*options, ends); },
                "Draw a section between two points, which may lie anywhere")
            ->expected(2)
            ->delimiter(' ')
            ->type_name("X,Y,Z");
    command
        ->add_option_function<std::string>(
            "--direction", [options](const std::string& text) { set_direction(*options, text); },
            "Draw a section through the centre along it, as long as the window")
        ->type_name("X,Y,Z")
        ->excludes(section);
    add_length(*command, "--footprint", options->footprint_m, "Smallest wavelength worth rendering [0]",
               NumberRange::not_negative);
    add_parameters(*command, options->parameters);
    set_examples(*command, "  haptel plot examples/textures/rock.haptel:rock --out rock.png\n"
                           "  haptel plot dimples.haptel:dimples --kind section --window 5mm --out section.png\n"
                           "  haptel plot dimples.haptel:dimples --section 0,0,0 3mm,4mm,0 --out across.png\n"
                           "  haptel plot wood.haptel:wood --set ring=3mm --kind spectrum --size 1024 --out wood.png");
    return {command, [options, kind] {
                if (options->section_m || options->direction) {
                    if (kind->count() > 0 && options->kind != "section") {
                        say_error("--section and --direction draw a section: leave --kind out");
                        return ExitCode::misuse;
                    }
                    options->kind = "section";
                }
                return draw(*options);
            }};
}

} // namespace haptel::tools
