// What a subcommand of the haptel binary is: the options it declares and the function that runs it.
//
// A file tools/commands/NAME.cpp holds one subcommand as `Command NAME_command(CLI::App& app)` and is listed in
// commands.def; main.cpp knows no more of it. Data goes to standard output, everything said to a person to standard
// error.
#pragma once

#include "tools/output/exit_code.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace haptel::tools {

struct Command {
    CLI::App* app = nullptr; // the subcommand as added to the root
    std::function<ExitCode()> run;
};

// Text of --help after the options: how the command is used, one example per line.
inline void set_examples(CLI::App& app, const std::string& lines)
{
    app.footer("Examples:\n" + lines);
}

#define HAPTEL_COMMAND(name) Command name##_command(CLI::App& app);
#include "tools/commands/commands.def"
#undef HAPTEL_COMMAND

} // namespace haptel::tools
