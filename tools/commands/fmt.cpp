// haptel fmt: source text in the one style.
#include "jit/texture/source_file.h"
#include "lang/format/format.h"
#include "tools/commands/command.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

namespace {

struct FormatOptions {
    std::vector<std::string> files;
    bool check = false, to_stdout = false;
};

ExitCode format_file(const std::string& path, const FormatOptions& options)
{
    jit::SourceText source = jit::read_source(path);
    if (!source.error.empty()) {
        say_error(fmt::format("{}: {}{}{}", path, source.error, source.hint.empty() ? "" : ": ", source.hint));
        return ExitCode::findings;
    }
    lang::SourceSet sources;
    const uint32_t file = sources.add({path, source.text});
    lang::Diagnostics diagnostics;
    const std::optional<std::string> formatted = lang::format(sources, file, diagnostics);
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
    command->add_flag("--stdout", options->to_stdout, "Print the formatted text and leave the files alone");
    set_examples(*command, "  haptel fmt rock.haptel\n"
                           "  haptel fmt --check examples/textures/*.haptel\n"
                           "  haptel fmt --stdout rock.haptel | diff rock.haptel -");
    return {command, [options] {
                ExitCode worst = ExitCode::fine;
                for (const std::string& path : options->files)
                    if (const ExitCode code = format_file(path, *options); code != ExitCode::fine) worst = code;
                return worst;
            }};
}

} // namespace haptel::tools
