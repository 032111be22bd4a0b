// The haptel command: finds the subcommand, turns its outcome into the exit code, and nothing else.
#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"
#include "tools/commands/command.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

using namespace haptel;
using namespace haptel::tools;

namespace {

std::vector<Command> add_commands([[maybe_unused]] CLI::App& app)
{
    return {
#define HAPTEL_COMMAND(name) name##_command(app),
#include "tools/commands/commands.def"
#undef HAPTEL_COMMAND
    };
}

// A better answer than the parser's to a first word that is no command; empty if it is one, or an option.
std::string unknown_command(const CLI::App& app, int argc, char** argv)
{
    if (argc < 2 || argv[1][0] == '-') return {};
    const std::string word = argv[1];
    std::vector<std::string_view> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), word) != names.end()) return {};
    const std::string_view meant = near_name(word, names).name;
    const std::string advice =
        meant.empty() ? "haptel --help lists them all" : fmt::format("did you mean '{}'?", meant);
    return fmt::format("there is no command '{}': {}", word, advice);
}

ExitCode run(int argc, char** argv)
{
    CLI::App app("Textures you can touch, written like shaders.", "haptel");
    app.set_version_flag("--version", "haptel " HAPTEL_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(36);
    const std::vector<Command> commands = add_commands(app);
    if (const std::string unknown = unknown_command(app, argc, argv); !unknown.empty()) {
        say_error(unknown);
        return ExitCode::misuse;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error, std::cout, std::cerr) == 0 ? ExitCode::fine : ExitCode::misuse;
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        const ExitCode code = command.run();
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
        say_error("not all of the output could be written: is the disk full?");
        return code == ExitCode::fine ? ExitCode::findings : code;
    }
    return ExitCode::misuse;
}

} // namespace

int main(int argc, char** argv)
{
    try {
        char help[] = "--help"; // "help check" is "check --help"
        std::vector<char*> words(argv, argv + argc);
        if (argc > 1 && std::string_view(argv[1]) == "help") {
            words.erase(words.begin() + 1);
            words.push_back(help);
        }
        return static_cast<int>(run(static_cast<int>(words.size()), words.data()));
    } catch (const std::exception& error) {
        // Layers report errors as data; what still arrives here is the system's: no memory, a full disk.
        say_error(error.what());
        return static_cast<int>(ExitCode::findings);
    }
}
