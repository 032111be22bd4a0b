// haptel check: what is wrong with a texture file, and what is known of its textures before anybody touches them.
#include "jit/check/short_paths.h"
#include "jit/picture/image_file.h"
#include "jit/texture/facts.h"
#include "jit/texture/source_file.h"
#include "jit/texture/texture.h"
#include "lang/parameter_value.h"
#include "lang/text/near_name.h"
#include "libraries/find.h"
#include "tools/arguments/quantity.h"
#include "tools/arguments/texture_argument.h"
#include "tools/arguments/texture_files.h"
#include "tools/check/check_report.h"
#include "tools/check/check_watch.h"
#include "tools/check/explain.h"
#include "tools/check/fixes.h"
#include "tools/commands/command.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <set>
#include <span>

namespace haptel::tools {

namespace {

struct CheckOptions {
    std::vector<std::string> files;
    ParameterTexts parameters;
    double box_m = 0.2, footprint_m = 0;
    std::optional<double> normal_turn_per_m; // nothing: of a ball that fills the box
    std::optional<double> error_max;         // given: a precision is picked
    bool strict = false, fix = false, cost = false, json = false, watch = false;
    const CLI::Option* explain = nullptr; // given: nothing is checked, a code is explained
    std::string code;                     // empty: all are listed
};

class CheckRun {
public:
    explicit CheckRun(const CheckOptions& chosen) : options(chosen), is_set(chosen.parameters.size(), false)
    {
        report.box_m = chosen.box_m;
        report.normal_turn_per_m = chosen.normal_turn_per_m.value_or(2 / chosen.box_m);
        report.with_cost = chosen.cost;
    }

    void check(const std::string& path);
    // --set for a parameter that no texture has: most likely a slip of the pen.
    void report_unknown_parameters();
    CheckReport report;
    std::set<std::string> files; // that were read, or could not be

private:
    void fix(const std::string& path);
    // Defaults, but for what --set says.
    std::vector<jit::ImageFile> images_of(const std::string& path, const lang::Program& program,
                                          const ir::Texture& texture);
    // What a hand may feel of the pictures' files.
    void note_grain(const CheckedTexture& checked, std::span<const double> values,
                    const std::vector<jit::ImageFile>& images);
    std::vector<double> values_of(const std::string& path, const ir::Texture& texture);
    TextureRequest request_for(const ir::Texture& texture) const;
    lang::JumpSearch jump_search(const TextureBinding& felt) const;
    // Measures, and says which precision is the fastest within error_max, or that none is.
    void pick_precision(CheckedTexture& checked);
    // Findings that belong to no line.
    void say(lang::ErrorCode code, std::string message, std::string hint, const std::string& file)
    {
        say({lang::Severity::error, code.string(), std::move(message), std::move(hint), file, {}, {}});
    }
    void note(lang::NoteCode code, std::string message, std::string hint, const std::string& file)
    {
        say({lang::Severity::note, code.string(), std::move(message), std::move(hint), file, {}, {}});
    }
    void say(CheckFinding finding);

    const CheckOptions& options;
    std::vector<bool> is_set; // by options.parameters
    std::vector<std::string> parameter_names;
    Progress progress; // over the textures of a file
};

void CheckRun::say(CheckFinding finding)
{
    progress.hide();
    fmt::print(stderr, "{}: {}: {} [{}]\n", finding.file, lang::name_of(finding.severity), finding.message,
               finding.code);
    if (!finding.hint.empty()) fmt::print(stderr, "     = hint: {}\n", finding.hint);
    report.add(std::move(finding));
}

void CheckRun::fix(const std::string& path)
{
    const jit::SourceText source = jit::read_source(path);
    if (!source.error.empty()) return; // said where it is compiled
    const jit::TextureOptions of_file{.name = path, .load_import = jit::load_beside};
    const Mended mended = mend(source.text, [&](const std::string& text) { return jit::check_texture(text, of_file); });
    if (mended.applied > 0) {
        const std::string fault = replace_file(path, mended.text);
        if (!fault.empty())
            return say("unwritable-file", "cannot write the mended text: " + fault, "is it write-protected?", path);
        fmt::print(stderr, "{}: {} fixed\n", path, mended.applied);
    }
    if (mended.left_out > 0)
        fmt::print(stderr, "{}: {} left for you to mend: the proposed fix would cause more findings\n", path,
                   mended.left_out);
}

std::vector<double> CheckRun::values_of(const std::string& path, const ir::Texture& texture)
{
    std::vector<double> values;
    for (const ir::Parameter& parameter : texture.parameters) values.push_back(parameter.value);
    std::ranges::move(lang::parameter_names(texture), std::back_inserter(parameter_names));
    for (size_t i = 0; i < options.parameters.size(); ++i) {
        const auto& [name, text] = options.parameters[i];
        const auto [set, read] = lang::parse_values(name, text, texture);
        if (set.empty()) continue;
        is_set[i] = true;
        for (size_t k = 0; k < read.size(); ++k)
            if (read[k].error.empty())
                values[static_cast<size_t>(&set[k] - texture.parameters.data())] = read[k].value;
            else
                say("bad-value", "--set " + name + " for " + texture.name + ": " + read[k].error, read[k].hint, path);
    }
    return values;
}

// Null where none is set: then bounds are those of any image.
std::vector<jit::ImageFile> CheckRun::images_of(const std::string& path, const lang::Program& program,
                                                const ir::Texture& texture)
{
    const ir::ImageParts parts = ir::parts_read(program.module);
    std::vector<jit::ImageFile> images;
    for (const ir::Parameter& parameter : texture.parameters) {
        images.emplace_back();
        if (parameter.type != ir::Type::image) continue;
        for (const auto& [name, text] : options.parameters) {
            if (name != parameter.name) continue;
            jit::ImageFile read = jit::read_image(text, {}, parts);
            files.insert(text);
            if (!read.image)
                say("bad-value", "--set " + name + " for " + texture.name + ": " + read.error, read.hint, path);
            images.back() = std::move(read);
        }
    }
    return images;
}

void CheckRun::note_grain(const CheckedTexture& checked, std::span<const double> values,
                          const std::vector<jit::ImageFile>& images)
{
    std::vector<const ir::SplineImage*> views;
    for (const jit::ImageFile& file : images) views.push_back(file.image.get());
    const auto height = [&] {
        lang::Diagnostics heard; // and said of the picture itself
        return lang::analyse(*checked.program, *checked.texture, values, views,
                             {options.box_m, options.footprint_m, report.normal_turn_per_m}, heard)
            .at_values.height;
    };
    for (size_t i = 0; i < images.size(); ++i) {
        if (images[i].grain.level == 0 && !images[i].grain.has_blocks) continue;
        views[i] = &jit::flat_image();
        const ir::Interval black = height();
        views[i] = &jit::white_image();
        const ir::Interval white = height();
        views[i] = images[i].image.get();
        const double white_m =
            std::max(std::fabs(white.maximum - black.maximum), std::fabs(white.minimum - black.minimum));
        const std::string& name = checked.texture->parameters[i].name;
        for (const auto& [set, text] : options.parameters) {
            if (set != name) continue;
            for (const jit::GrainNote& said : jit::grain_notes(images[i].grain, lang::printable(text), white_m))
                note("coarse-picture", "--set " + name + " for " + checked.texture->name + ": " + said.message,
                     said.hint, checked.file);
        }
    }
}

TextureRequest CheckRun::request_for(const ir::Texture& texture) const
{
    TextureRequest request = request_in_cube(options.box_m, options.footprint_m);
    request.normal_turn_max_per_m = report.normal_turn_per_m;
    request.parameters = values_for(texture, options.parameters);
    return request;
}

lang::JumpSearch CheckRun::jump_search(const TextureBinding& felt) const
{
    return [&felt, this]() -> std::optional<lang::SeenJump> {
        const std::optional<jit::Jump> jump = jit::find_jump(felt, jit::box_of(request_in_cube(options.box_m)));
        if (!jump) return std::nullopt;
        return lang::SeenJump{jump->height_m, {jump->p_m[0], jump->p_m[1], jump->p_m[2]}, jump->time_s};
    };
}

void CheckRun::pick_precision(CheckedTexture& checked)
{
    checked.precision = {*options.error_max,
                         jit::measure_precisions(checked.file, checked.texture->name, request_for(*checked.texture))};
    if (!checked.precision->choice.error.empty()) {
        say("no-code", checked.texture->name + " cannot be measured: " + checked.precision->choice.error, "",
            checked.file);
        checked.precision.reset();
        return;
    }
    if (checked.precision->takes_f64())
        checked.precision->amplified =
            find_amplified(checked.file, checked.texture->name, request_for(*checked.texture));
    if (!checked.precision->is_met()) {
        say("not-close-enough",
            fmt::format("no precision of {} keeps the gradient within {:g} of its largest: {}", checked.texture->name,
                        *options.error_max, checked.precision->closest()),
            "allow that much, or bring coordinates nearer to the origin, --box: far away f64 has fewer digits for the "
            "place within a wavelength",
            checked.file);
    }
}

void CheckRun::check(const std::string& path)
{
    if (options.fix) fix(path);
    lang::CompileResult result = jit::check_texture_file(path);
    files.insert(path);
    files.insert(result.files.begin(), result.files.end());
    lang::Diagnostics& diagnostics = result.diagnostics;
    if (result.program) {
        const auto& textures = result.program->module.textures;
        const jit::CompiledTextures compiled =
            diagnostics.has_errors() ? jit::CompiledTextures() : jit::with_code(result, jit::servo_options());
        for (const ir::Texture& texture : textures) {
            progress.show(static_cast<double>(&texture - textures.data()) / static_cast<double>(textures.size()));
            const std::vector<double> values = values_of(path, texture);
            const auto images = images_of(path, *result.program, texture);
            std::vector<const ir::SplineImage*> views;
            std::vector<std::string> any_picture;
            for (size_t i = 0; i < images.size(); ++i) {
                views.push_back(images[i].image.get());
                const ir::Parameter& parameter = texture.parameters[i];
                if (parameter.type == ir::Type::image && !images[i].image) any_picture.push_back(parameter.name);
            }
            const TextureRequest request = request_for(texture);
            jit::FoundHeights found;
            TextureResult felt; // without a picture there is nothing to call
            if (compiled.program && any_picture.empty())
                felt = jit::make_binding(compiled.program, texture.name, request, jit::For::hand, &found);
            report.textures.push_back(
                {path, result.program, &texture,
                 lang::analyse(*result.program, texture, values, views,
                               {options.box_m, options.footprint_m, report.normal_turn_per_m}, diagnostics,
                               felt.binding ? jump_search(*felt.binding) : lang::JumpSearch()),
                 std::move(any_picture)});
            note_grain(report.textures.back(), values, images);
            if (const auto& hand = felt.binding)
                report.textures.back().heights = {{found.minimum_m, found.maximum_m},
                                                  {hand->facts.height_min_m, hand->facts.height_max_m},
                                                  hand->shoulder_m[0] > 0 || hand->shoulder_m[1] > 0};
            if (options.cost && felt.binding) {
                compiled.program->optimise();
                report.textures.back().call_s = jit::median_call_s(*felt.binding, request);
            }
            if (options.error_max && !diagnostics.has_errors()) pick_precision(report.textures.back());
        }
        progress.hide();
        diagnostics.sort_by_place();
    }
    if (options.strict) diagnostics.make_warnings_errors(); // last: what is known of the textures stays known
    fmt::print(stderr, "{}", lang::render(diagnostics.all(), result.sources, stderr_has_color()));
    report.add(result);
}

void CheckRun::report_unknown_parameters()
{
    if (report.textures.empty()) return; // nothing compiled, so nothing is known of parameters
    const std::vector<std::string_view> names(parameter_names.begin(), parameter_names.end());
    for (size_t i = 0; i < is_set.size(); ++i) {
        if (is_set[i]) continue;
        const std::string& name = options.parameters[i].first;
        const std::string_view nearest = near_name(name, names).name;
        say("unknown-parameter", "no texture has a parameter '" + name + "'",
            nearest.empty() ? "" : "did you mean '" + std::string(nearest) + "'?", options.files.front());
    }
}

struct Outcome {
    size_t errors;
    std::set<std::string> files; // that it depends on
};

// A folder stands for its texture files; one without any is said to be no file.
std::vector<std::string> files_at(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) return {libraries::path_named(path)};
    std::vector<std::string> files;
    for (const TextureTarget& target : texture_targets({path}, true)) files.push_back(target.file);
    return files.empty() ? std::vector{path} : files;
}

// Once, with its report.
Outcome check_all(const CheckOptions& options)
{
    CheckRun checks(options);
    for (const std::string& path : options.files)
        for (const std::string& file : files_at(path)) checks.check(file);
    checks.report_unknown_parameters();
    if (options.json)
        print_json(checks.report.to_json());
    else
        fmt::print("{}", checks.report.to_text());
    return {checks.report.count(lang::Severity::error), std::move(checks.files)};
}

ExitCode run(const CheckOptions& options)
{
    if (options.explain->count() > 0) return explain(options.code, options.json);
    if (options.files.empty()) {
        say_error("check needs a texture file, or a folder of them: haptel check PATH...");
        return ExitCode::misuse;
    }
    for (const std::string& path : options.files)
        if (path.ends_with(".toml")) {
            say_error("check reads texture files, and " + lang::printable(path) +
                      " is a scene: haptel explore feels it, and says what is wrong with it");
            return ExitCode::misuse;
        }
    if (!options.watch) return check_all(options).errors > 0 ? ExitCode::findings : ExitCode::fine;
    repeat_at_each_save([&] { return check_all(options).files; });
    return ExitCode::fine;
}

} // namespace

Command check_command(CLI::App& app)
{
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* command =
        app.add_subcommand("check", "Find mistakes in texture files; say how high, steep and smooth textures are");
    command->add_option("files", options->files, "Texture files, and folders of them")->type_name("PATH");
    add_length(*command, "--box", options->box_m, "Side of the cube round the origin that bounds are for [0.2m]");
    add_length(*command, "--footprint", options->footprint_m, "Smallest wavelength worth rendering [0]",
               NumberRange::not_negative);
    add_number(*command, "--normal-turn", options->normal_turn_per_m,
               "How fast the object's normals turn at most, radians per metre [2 / box: a ball that fills it]",
               NumberRange::not_negative)
        ->type_name("PER_M");
    add_parameters(*command, options->parameters);
    add_number(*command, "--max-error", options->error_max,
               "Pick the fastest precision whose gradient is off by at most this share of its largest, by measurement",
               NumberRange::positive)
        ->type_name("SHARE");
    command->add_flag("--strict", options->strict, "Warnings are errors");
    auto* fix = command->add_flag("--fix", options->fix, "Apply the proposed fixes to the files");
    command->add_flag("--watch", options->watch, "Check again at each save, until Ctrl-C")->excludes(fix);
    options->explain = command->add_option("--explain", options->code, "Explain a code; without CODE list all")
                           ->expected(0, 1)
                           ->type_name("[CODE]");
    command->add_flag("--cost", options->cost,
                      "Measured time of a call, and worst-case cost of each line, the most expensive first");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel check rock.haptel\n"
                           "  haptel check --strict examples/textures\n"
                           "  haptel check rock.haptel --box 50mm --set depth=0.1mm --json\n"
                           "  haptel check --max-error 1e-5 rock.haptel\n"
                           "  haptel check --fix rock.haptel\n"
                           "  haptel check --watch rock.haptel\n"
                           "  haptel check --explain dimension");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
