// haptel info: what there is to call, and what a file's textures are.
#include "jit/texture/source_file.h"
#include "jit/texture/texture.h"
#include "lang/abi/library_name.h"
#include "lang/syntax/parser.h"
#include "lang/text/near_name.h"
#include "tools/check/check_report.h"
#include "tools/commands/command.h"
#include "tools/library/info_library.h"
#include "tools/library/reference.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <span>

namespace haptel::tools {

namespace {

struct InfoOptions {
    std::string what; // empty: everything there is to call
    bool json = false, markdown = false;
};

bool is_file(const std::string& what)
{
    return what.find(".haptel") != std::string::npos || what.find('/') != std::string::npos ||
           names_library_file(std::string_view(what).substr(0, what.find(':')));
}

ExitCode show_entry(const InfoOptions& options)
{
    const std::vector<Entry> entries = reference();
    std::vector<std::string_view> names;
    Json found = Json::array();
    std::string text;
    for (const Entry& entry : entries) {
        names.push_back(entry.name);
        if (entry.name != options.what) continue;
        found.push_back(to_json(entry));
        text += (text.empty() ? "" : "\n") + to_text(entry);
    }
    if (found.empty()) {
        const std::string_view meant = near_name(options.what, names).name;
        say_error(fmt::format("there is no function '{}': {}", lang::printable(options.what),
                              meant.empty() ? "haptel info lists them all; a file ends in .haptel"
                                            : fmt::format("did you mean '{}'?", meant)));
        return ExitCode::misuse;
    }
    if (options.json)
        print_json({{"functions", std::move(found)}});
    else
        fmt::print("{}", text);
    return ExitCode::fine;
}

ExitCode show_all(const InfoOptions& options)
{
    const std::vector<Entry> entries = reference();
    if (options.json) {
        Json all = Json::array();
        for (const Entry& entry : entries) all.push_back(to_json(entry));
        print_json({{"functions", std::move(all)}});
    } else {
        fmt::print("{}", options.markdown ? to_markdown(entries) : to_list(entries));
    }
    return ExitCode::fine;
}

// A doc comment of several lines, all but the first behind `indent`.
std::string indented(std::string doc, const std::string& indent)
{
    for (size_t at = 0; (at = doc.find('\n', at)) != std::string::npos; at += indent.size() + 1)
        doc.insert(at + 1, indent);
    return doc;
}

// Values and ranges as the author wrote them.
std::string to_text(const lang::SourceSet& sources, const lang::ast::TextureParameter& parameter)
{
    const auto text = [&](const auto& part) { return std::string(sources.text(part->span)); };
    std::string line = fmt::format("  {} {}", parameter.type.base.text, parameter.name.text);
    if (parameter.value) line += " = " + text(parameter.value);
    if (parameter.minimum && parameter.maximum)
        line += fmt::format(" in {} .. {}", text(parameter.minimum), text(parameter.maximum));
    if (!parameter.choices.empty()) {
        std::vector<std::string> names;
        for (const lang::ast::Name& choice : parameter.choices) names.push_back(choice.text);
        line += fmt::format(" in {{{}}}", fmt::join(names, ", "));
    }
    if (!parameter.doc.empty()) line += "  // " + indented(parameter.doc, "    // ");
    return line + "\n";
}

// `head` is its first line; a preset's parameters are listed with the texture that it is of.
std::string to_text(const lang::SourceSet& sources, const std::string& head,
                    std::span<const lang::ast::TextureParameter> parameters, const ir::Texture& texture)
{
    std::string text = head + "\n";
    if (!texture.doc.empty()) text += "  " + indented(texture.doc, "  ") + "\n";
    for (const lang::ast::TextureParameter& parameter : parameters)
        if (!parameter.is_output) text += to_text(sources, parameter);
    const std::vector<std::string> inputs = inputs_of(texture), outputs = outputs_of(texture);
    text += fmt::format("  reads {}\n", inputs.empty() ? "nothing" : fmt::format("{}", fmt::join(inputs, ", ")));
    if (!outputs.empty()) text += fmt::format("  writes {}\n", fmt::join(outputs, ", "));
    return text;
}

// The name of the texture that one is written as a preset of; empty: it is none.
std::string_view preset_of(const lang::ast::File& tree, std::string_view name)
{
    const auto written =
        std::ranges::find_if(tree.presets, [&](const lang::ast::Preset& preset) { return preset.name.text == name; });
    return written == tree.presets.end() ? std::string_view() : std::string_view(written->of.text);
}

// Those of this file, of the texture or of another preset of it, in their order.
std::vector<std::string> presets_of(const lang::ast::File& tree, std::string_view name)
{
    std::vector<std::string> presets;
    for (const lang::ast::Preset& preset : tree.presets) {
        std::string_view of = preset.of.text;
        for (size_t left = tree.presets.size(); left > 0 && of != name && !of.empty(); --left) of = preset_of(tree, of);
        if (of == name) presets.push_back(preset.name.text);
    }
    return presets;
}

// From which any program can draw a panel (docs/control.md): fields may be added, and none taken away or changed
// without another version.
Json manifest(Json textures)
{
    return {{"schema", "haptel-textures"}, {"version", 1}, {"textures", std::move(textures)}};
}

ExitCode show_file(const InfoOptions& options)
{
    const jit::TextureReference named = jit::split_reference(options.what);
    const std::string &path = named.file, &wanted = named.texture;
    const lang::CompileResult result = jit::check_texture_file(path);
    if (!result.program) {
        fmt::print(stderr, "{}", lang::render(result.diagnostics.all(), result.sources, stderr_has_color()));
        return ExitCode::findings;
    }
    lang::Diagnostics heard; // what the parser says was said above
    const lang::ast::File tree = lang::parse(result.sources, 0, heard);
    std::vector<std::string_view> names;
    Json all = Json::array();
    std::string text;
    for (const ir::Texture& texture : result.program->module.textures) {
        names.push_back(texture.name);
        if (!wanted.empty() && texture.name != wanted) continue;
        const std::string_view of = preset_of(tree, texture.name);
        all.push_back(texture_json(path, texture));
        all.back()["preset_of"] = of.empty() ? Json(nullptr) : Json(of);
        all.back()["presets"] = presets_of(tree, texture.name);
        const auto add = [&](const std::string& head, std::span<const lang::ast::TextureParameter> parameters) {
            text += (text.empty() ? "" : "\n") + to_text(result.sources, head, parameters, texture);
        };
        for (const lang::ast::Texture& written : tree.textures)
            if (written.name.text == texture.name) add("texture " + texture.name, written.parameters);
        for (const lang::ast::Preset& written : tree.presets)
            if (written.name.text == texture.name) add(std::string(result.sources.text(written.span)), {});
    }
    if (all.empty() && !wanted.empty()) {
        const std::string_view meant = near_name(wanted, names).name;
        say_error(fmt::format("{} has no texture '{}'{}", path, lang::printable(wanted),
                              meant.empty() ? "" : fmt::format(": did you mean '{}'?", meant)));
        return ExitCode::findings;
    }
    if (options.json)
        print_json(manifest(std::move(all)));
    else
        fmt::print("{}", text);
    return ExitCode::fine;
}

} // namespace

Command info_command(CLI::App& app)
{
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command = app.add_subcommand(
        "info", "Explain a function, or list a file's or a library's textures; without an argument list all functions");
    command
        ->add_option("what", options->what,
                     "A function, a texture file, or a library: its archive, folder or name; "
                     "without it all functions are listed")
        ->type_name("NAME|FILE[:TEXTURE]|LIBRARY");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    command->add_flag("--markdown", options->markdown, "The reference of all functions as a page");
    set_examples(*command, "  haptel info\n"
                           "  haptel info fbm\n"
                           "  haptel info examples/textures/rock.haptel\n"
                           "  haptel info rock.haptel:rock --json\n"
                           "  haptel info wood-1.2.0.haptlib");
    return {command, [options] {
                if (options->what.empty() || options->markdown) return show_all(*options);
                const std::vector<Entry> functions = reference();
                const bool is_function = std::ranges::find(functions, options->what, &Entry::name) != functions.end();
                if (!is_function && names_library(options->what)) return show_library(options->what, options->json);
                return is_file(options->what) ? show_file(*options) : show_entry(*options);
            }};
}

} // namespace haptel::tools
