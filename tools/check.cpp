// haptel check: what is wrong with a texture file, and what is known of its textures before anybody touches them.
#include "jit/source_file.h"
#include "lang/value.h"
#include "stdlib/stdlib.h"
#include "tools/check_report.h"
#include "tools/command.h"
#include "tools/fixes.h"
#include "tools/quantity.h"
#include "tools/terminal.h"
#include "tools/texture_argument.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <memory>

namespace haptel::tools {

namespace {

constexpr int fix_rounds_max = 8; // what was hidden behind one mistake shows when it is mended

struct CheckOptions {
    std::vector<std::string> files;
    ParameterTexts parameters;
    double box_m = 0.2;
    bool strict = false, fix = false, json = false;
};

lang::CompileResult compile_file(const std::string& path, bool strict)
{
    lang::CompileOptions options;
    options.strict = strict;
    for (const stdlib::LibraryFile& file : stdlib::library())
        options.library.push_back({std::string(file.name), std::string(file.text)});
    options.load_import = jit::load_beside;
    jit::SourceText source = jit::read_source(path);
    if (source.error.empty()) return lang::compile({path, std::move(source.text)}, options);
    lang::CompileResult result;
    result.sources.add({path, {}});
    result.diagnostics.error({}, "unreadable-file", source.error).hint = source.hint;
    return result;
}

class CheckRun {
public:
    explicit CheckRun(const CheckOptions& chosen) : options(chosen), is_set(chosen.parameters.size(), false)
    {
        report.box_m = chosen.box_m;
    }

    void check(const std::string& path);
    // --set for a parameter that no texture has: most likely a slip of the pen.
    void report_unknown_parameters();
    CheckReport report;

private:
    lang::CompileResult fix(const std::string& path, lang::CompileResult result);
    // Defaults, but for what --set says.
    std::vector<double> values_of(const std::string& path, const ir::Texture& texture);
    void say(CheckFinding finding);

    const CheckOptions& options;
    std::vector<bool> is_set; // by options.parameters
    std::vector<std::string> parameter_names;
};

// A finding that belongs to no line.
void CheckRun::say(CheckFinding finding)
{
    fmt::print(stderr, "{}: error: {} [{}]\n", finding.file, finding.message, finding.code);
    if (!finding.hint.empty()) fmt::print(stderr, "     = hint: {}\n", finding.hint);
    report.add(std::move(finding));
}

lang::CompileResult CheckRun::fix(const std::string& path, lang::CompileResult result)
{
    size_t applied = 0;
    for (int round = 0; round < fix_rounds_max; ++round) {
        const FixedText fixed = apply_fixes(result.sources.file(0).text, 0, result.diagnostics);
        if (fixed.applied == 0) break;
        std::ofstream out(path, std::ios::binary | std::ios::trunc);
        out << fixed.text;
        out.close();
        if (!out) {
            say({lang::Severity::error,
                 "unwritable-file",
                 "cannot write the mended text",
                 "is it write-protected?",
                 path,
                 {},
                 {}});
            break;
        }
        applied += fixed.applied;
        result = compile_file(path, options.strict);
    }
    if (applied > 0) fmt::print(stderr, "{}: {} fixed\n", path, applied);
    return result;
}

std::vector<double> CheckRun::values_of(const std::string& path, const ir::Texture& texture)
{
    std::vector<double> values;
    for (const ir::Parameter& parameter : texture.parameters) {
        double& value = values.emplace_back(parameter.value);
        parameter_names.push_back(parameter.name);
        for (size_t i = 0; i < options.parameters.size(); ++i) {
            const auto& [name, text] = options.parameters[i];
            if (name != parameter.name) continue;
            is_set[i] = true;
            const lang::ParameterValue parsed = lang::parse_value(text, parameter);
            if (parsed.error.empty())
                value = parsed.value;
            else
                say({lang::Severity::error,
                     "bad-value",
                     "--set " + name + " for " + texture.name + ": " + parsed.error,
                     parsed.hint,
                     path,
                     {},
                     {}});
        }
    }
    return values;
}

void CheckRun::check(const std::string& path)
{
    lang::CompileResult result = compile_file(path, options.strict);
    if (options.fix) result = fix(path, std::move(result));
    fmt::print(stderr, "{}", lang::render(result.diagnostics.all(), result.sources, stderr_has_color()));
    report.add(result);
    if (!result.program) return;
    for (const ir::Texture& texture : result.program->module.textures)
        report.textures.push_back(check_bounds(path, result.program, texture, values_of(path, texture), options.box_m));
}

void CheckRun::report_unknown_parameters()
{
    if (report.textures.empty()) return; // nothing compiled, so nothing is known of parameters
    const std::vector<std::string_view> names(parameter_names.begin(), parameter_names.end());
    for (size_t i = 0; i < is_set.size(); ++i) {
        if (is_set[i]) continue;
        const std::string& name = options.parameters[i].first;
        const std::string_view nearest = lang::nearest_name(name, names);
        say({lang::Severity::error,
             "unknown-parameter",
             "no texture has a parameter '" + name + "'",
             nearest.empty() ? "" : "did you mean '" + std::string(nearest) + "'?",
             options.files.front(),
             {},
             {}});
    }
}

ExitCode run(const CheckOptions& options)
{
    CheckRun checks(options);
    for (const std::string& path : options.files) checks.check(path);
    checks.report_unknown_parameters();
    const CheckReport& report = checks.report;
    if (options.json)
        print_json(report.to_json());
    else
        fmt::print("{}", report.to_text());
    return report.count(lang::Severity::error) > 0 ? ExitCode::findings : ExitCode::fine;
}

} // namespace

Command check_command(CLI::App& app)
{
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* command =
        app.add_subcommand("check", "What is wrong with texture files, and how high their textures get");
    command->add_option("files", options->files, "Texture files")->required()->type_name("FILE");
    add_length(*command, "--box", options->box_m, "Side of the cube round the origin that bounds are for [0.2m]");
    add_parameters(*command, options->parameters);
    command->add_flag("--strict", options->strict, "Warnings are errors");
    command->add_flag("--fix", options->fix, "Write what the compiler proposes into the files");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel check rock.haptel\n"
                           "  haptel check --strict examples/textures/*.haptel\n"
                           "  haptel check rock.haptel --box 50mm --set depth=0.1mm --json");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
