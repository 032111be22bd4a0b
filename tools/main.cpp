// The haptel command: finds the subcommand, turns its outcome into the exit code, and nothing else.
#include "tools/command.h"
#include "tools/terminal.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

using namespace haptel::tools;

namespace {

std::vector<Command> add_commands([[maybe_unused]] CLI::App& app)
{
    return {
#define HAPTEL_COMMAND(name) name##_command(app),
#include "tools/commands.def"
#undef HAPTEL_COMMAND
    };
}

ExitCode run(int argc, char** argv)
{
    CLI::App app("Textures you can touch, written like shaders.", "haptel");
    app.set_version_flag("--version", "haptel " HAPTEL_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(36);
    const std::vector<Command> commands = add_commands(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error, std::cout, std::cerr) == 0 ? ExitCode::fine : ExitCode::misuse;
    }
    for (const Command& command : commands)
        if (command.app->parsed()) return command.run();
    return ExitCode::misuse;
}

} // namespace

int main(int argc, char** argv)
{
    try {
        return static_cast<int>(run(argc, argv));
    } catch (const std::exception& error) {
        // Layers report errors as data; what still arrives here is the system's: no memory, a full disk.
        say_error(error.what());
        return static_cast<int>(ExitCode::findings);
    }
}
