// haptel fmt: source text in the one style.
#include "jit/texture/source_file.h"
#include "lang/format/format.h"
#include "lang/syntax/language_version.h"
#include "lang/syntax/parser.h"
#include "libraries/manifest.h"
#include "libraries/places.h"
#include "tools/check/fixes.h"
#include "tools/commands/command.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

namespace {

struct FormatOptions {
    std::vector<std::string> files;
    bool check = false, to_stdout = false, upgrade = false;
};

// The version that a file is written in: it says so, or its library does; else it is the present one.
uint32_t version_of(const std::string& path, std::string_view number)
{
    uint64_t version = language_version;
    if (!number.empty())
        std::from_chars(number.data(), number.data() + number.size(), version);
    else if (const auto manifest =
                 libraries::nearest_file(std::filesystem::absolute(path).parent_path(), libraries::manifest_name);
             !manifest.empty())
        if (const auto library = libraries::read_manifest_file(manifest).manifest) version = library->language_least;
    return static_cast<uint32_t>(std::min<uint64_t>(version, UINT32_MAX));
}

// `text` in the present version; nothing, and what is wrong, where it is none that can be upgraded.
std::optional<std::string> upgraded(const std::string& path, const std::string& text, lang::Diagnostics& diagnostics,
                                    lang::SourceSet& sources)
{
    const uint32_t file = sources.add({path, text});
    const lang::ast::File tree = lang::parse(sources, file, diagnostics);
    if (diagnostics.has_errors()) return {};
    const std::string_view number = sources.text(tree.language);
    const uint32_t version = version_of(path, number);
    if (version == 0 || version > language_version) {
        const lang::VersionFault fault = lang::fault_of_version(number.empty() ? std::to_string(version) : number);
        diagnostics.error(tree.language, "language-version", fault.message, fault.hint);
        return {};
    }
    return apply_fixes(text, lang::upgrades(sources, file, tree.language, version));
}

ExitCode format_file(const std::string& path, const FormatOptions& options)
{
    jit::SourceText source = jit::read_source(path);
    if (!source.error.empty()) {
        say_error(fmt::format("{}: {}{}{}", path, source.error, source.hint.empty() ? "" : ": ", source.hint));
        return ExitCode::findings;
    }
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    std::optional<std::string> text = source.text;
    if (options.upgrade) text = upgraded(path, source.text, diagnostics, sources);
    std::optional<std::string> formatted;
    if (text) formatted = lang::format(sources, sources.add({path, *text}), diagnostics);
    if (!formatted) {
        diagnostics.sort_by_place();
        fmt::print(stderr, "{}", lang::render(diagnostics.all(), sources, stderr_has_color()));
        return ExitCode::findings;
    }
    const bool changes = *formatted != source.text;
    if (options.to_stdout) fmt::print("{}", *formatted);
    if (options.check) {
        if (changes) fmt::print(stderr, "{}: would change\n", path);
        return changes ? ExitCode::findings : ExitCode::fine;
    }
    if (options.to_stdout || !changes) return ExitCode::fine;
    if (const std::string fault = replace_file(path, *formatted); !fault.empty()) {
        say_error(fmt::format("{}: cannot write the formatted text: {}", path, fault));
        return ExitCode::findings;
    }
    fmt::print(stderr, "{}: formatted\n", path);
    return ExitCode::fine;
}

} // namespace

Command fmt_command(CLI::App& app)
{
    const auto options = std::make_shared<FormatOptions>();
    CLI::App* command = app.add_subcommand("fmt", "Lay texture files out in the one style; comments stay");
    command->add_option("files", options->files, "Texture files")->required()->type_name("FILE");
    command->add_flag("--check", options->check, "Write nothing; exit 1 if a file would change");
    command->add_flag(
        "--upgrade", options->upgrade,
        "Rewrite what later versions of the language have changed, and say the version in the first line");
    command->add_flag("--stdout", options->to_stdout, "Print the formatted text and leave the files alone");
    set_examples(*command, "  haptel fmt rock.haptel\n"
                           "  haptel fmt --check examples/textures/*.haptel\n"
                           "  haptel fmt --upgrade rock.haptel\n"
                           "  haptel fmt --stdout rock.haptel | diff rock.haptel -");
    return {command, [options] {
                ExitCode worst = ExitCode::fine;
                for (const std::string& path : options->files)
                    if (const ExitCode code = format_file(path, *options); code != ExitCode::fine) worst = code;
                return worst;
            }};
}

} // namespace haptel::tools
