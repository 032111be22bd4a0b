// haptel check --watch: again at each save, however an editor saves, and at each return of a file.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

#include <string>

using namespace haptel::test;

namespace {

// `haptel check --watch` of a file in `folder` with edits by a shell beside it; interrupted behind them.
struct Watched {
    Folder folder;
    std::string edits;

    std::string quoted(const std::string& name) const { return "'" + folder.file(name) + "'"; }
    void edit(const std::string& command) { edits += command + "; "; }
    // Waits for so many checks to have begun and the last one to be over, with patience for a busy machine.
    void wait_for(int checks)
    {
        edit("for i in $(seq 400); do [ $(grep -c '^----' " + quoted("err") + ") -ge " + std::to_string(checks) +
             " ] && break; sleep 0.05; done; sleep 0.3");
    }
    Ran run(const std::string& arguments, const std::string& signal)
    {
        edit("kill -" + signal + " $(cat " + quoted("pid") + ")");
        const std::string own_id =
            "sh -c 'echo $$ >\"" + folder.file("pid") + "\"; exec \"$0\" \"$@\" 2>\"" + folder.file("err") + "\"'";
        Ran ran = run_command("check --watch " + arguments, "(" + edits + ") >/dev/null 2>&1 & timeout 60 " + own_id);
        ran.err = read_file(folder.path / "err");
        return ran;
    }
};

size_t count_of(const std::string& text, const std::string& part)
{
    size_t count = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
}

} // namespace

TEST_CASE("check --watch checks at each save, in place or by rename, and ends with 0 at Ctrl-C")
{
    Watched watched;
    const Folder& folder = watched.folder;
    folder.write("wave.haptel", "import \"depth.haptel\";\ntexture wave() { return DEPTH * sinturn(p.x / 1mm); }\n");
    folder.write("depth.haptel", "const float DEPTH = 10um;\n");
    folder.write("depth2.haptel", "const float DEPTH = 20um;\n");
    folder.write("broken.haptel",
                 "import \"depth.haptel\";\ntexture wave() { return DEPTH * sinturn(p.x / LENGTH); }\n");
    folder.write("tilt.haptel", "texture tilt() { return 0.25 * p.x; }\n");
    const std::string wave = watched.quoted("wave.haptel");
    watched.wait_for(1);
    watched.edit("cat " + watched.quoted("broken.haptel") + " >" + wave); // in place
    watched.wait_for(2);
    watched.edit("cp " + watched.quoted("tilt.haptel") + " " + watched.quoted("new") + "; mv " + watched.quoted("new") +
                 " " + wave); // as editors do
    watched.wait_for(3);
    const Ran ran = watched.run(wave, "INT");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK(count_of(ran.err, "----\n") == 3);
    CHECK(count_of(ran.err, "wave.haptel was saved") == 2);
    CHECK(count_of(ran.err, "error: unknown name 'LENGTH'") == 1);
    CHECK(count_of(ran.out, "wave.haptel:wave in a cube") == 1);
    CHECK(count_of(ran.out, "slope      at most 0.25 ") == 1);
    CHECK(ran.out.find("wave.haptel:wave") < ran.out.find("wave.haptel:tilt"));
}

TEST_CASE("check --watch goes on while a file is gone, and follows imports")
{
    Watched watched;
    const Folder& folder = watched.folder;
    folder.write("flat.haptel", "import \"depth.haptel\" as depth;\ntexture flat() { return depth.DEPTH; }\n");
    folder.write("depth.haptel", "const float DEPTH = 10um;\n");
    const std::string flat = watched.quoted("flat.haptel"), kept = watched.quoted("kept");
    watched.wait_for(1);
    watched.edit("mv " + flat + " " + kept + "; sleep 0.1; cp " + kept + " " + flat); // one save
    watched.wait_for(2);
    watched.edit("mv " + flat + " " + kept);
    watched.wait_for(3);
    watched.edit("mv " + kept + " " + flat);
    watched.wait_for(4);
    watched.edit("echo 'const float DEPTH = 20um;' >" + watched.quoted("depth.haptel"));
    watched.wait_for(5);
    watched.edit("touch " + watched.quoted("other.haptel") + "; sleep 0.5"); // nobody's
    const Ran ran = watched.run(flat, "TERM");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK(count_of(ran.err, "----\n") == 5);
    CHECK(count_of(ran.err, "flat.haptel is gone ----") == 1);
    CHECK(count_of(ran.err, "cannot read this file") == 1);
    CHECK(count_of(ran.err, "depth.haptel was saved ----") == 1);
    CHECK(count_of(ran.out, "height     10 um .. 10 um") == 3);
    CHECK(count_of(ran.out, "height     20 um .. 20 um") == 1);
    CHECK(run_command("check --watch --fix " + flat).code == 2);
}
