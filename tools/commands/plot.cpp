// haptel plot: pictures of a texture.
#include "jit/texture/texture.h"
#include "tools/arguments/quantity.h"
#include "tools/arguments/texture_argument.h"
#include "tools/commands/command.h"
#include "tools/output/terminal.h"
#include "tools/plot/plot_texture.h"
#include "tools/plot/texture_picture.h"

#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace haptel::tools {

namespace {

struct PlotOptions : PictureOptions {
    std::string out;
};

ExitCode draw(const PlotOptions& options)
{
    const jit::CompiledTextures compiled = jit::compile_texture_file(options.texture.file, compile_options(options));
    fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
    if (!compiled.program) return ExitCode::findings;
    std::optional<plot::Picture> picture =
        draw_texture(compiled.program, options, [](const std::string& text) { fmt::print(stderr, "{}", text); });
    if (!picture) return ExitCode::findings;
    const std::string error = picture->write_png(options.out);
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
    add_parsed(*command, "--at", "X,Y,Z", options->center_m, parse_point,
               "Centre of the square, which lies in the plane z = const [0,0,0]");
    auto* section =
        command
            ->add_option_function<std::vector<std::string>>(
                "--section", [options](const std::vector<std::string>& ends) { set_section(*options, ends); },
                "Draw a section between two points, which may lie anywhere")
            ->expected(2)
            ->delimiter(' ')
            ->type_name("X,Y,Z");
    add_parsed(*command, "--direction", "X,Y,Z", options->direction, parse_direction,
               "Draw a section through the centre along it, as long as the window")
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
