// The frame of the command: help, version, misuse.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

using namespace haptel::test;

TEST_CASE("help and version go to standard output with exit code 0")
{
    const Ran version = run_command("--version");
    CHECK(version.code == 0);
    CHECK(contains(version.out, "haptel 0."));
    CHECK(version.err.empty());

    const Ran help = run_command("--help");
    CHECK(run_command("help").out == help.out);
    CHECK(run_command("help check").out == run_command("check --help").out);
    CHECK(contains(run_command("help chek").err, "did you mean 'check'?"));
    CHECK(help.code == 0);
    CHECK(contains(help.out, "--version"));
    CHECK(help.err.empty());
}

TEST_CASE("misuse is exit code 2, said on standard error, with nothing on standard output")
{
    for (const std::string line : {"", "paint", "--colour", "-x"}) {
        CAPTURE(line);
        const Ran ran = run_command(line);
        CHECK(ran.code == 2);
        CHECK(ran.out.empty());
        CHECK(contains(ran.err, "--help"));
    }
}

TEST_CASE("output that cannot be written is an error, not a success with nothing to show")
{
    const Folder folder;
    const std::string file = folder.write("flat.haptel", "texture flat() { return 1um; }");
    for (const std::string to : {">/dev/full", "--json >/dev/full", "--json >&-"}) {
        CAPTURE(to);
        const Ran ran = run_command("check '" + file + "' " + to);
        CHECK(ran.code == 1);
        CHECK(contains(ran.err, "written"));
    }
}
