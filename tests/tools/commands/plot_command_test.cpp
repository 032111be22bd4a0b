#include "tests/support/catch.h"
#include "tests/tools/commands/png.h"
#include "tests/tools/commands/run_command.h"

using namespace haptel::test;

namespace {

constexpr const char* bumps = R"(
texture bumps(float depth = 50um in 0um .. 200um) { return depth * sin(p.x / 1mm) * sin(p.y / 1mm); }
)";

} // namespace

TEST_CASE("plot draws every kind of picture in the size asked for")
{
    const Folder folder;
    const std::string texture = folder.write("bumps.haptel", bumps) + ":bumps";
    for (const std::string kind : {"height", "shaded", "relief", "section", "spectrum", "gradient-error"}) {
        const std::string picture = folder.file(kind + ".png");
        const Ran ran =
            run_command("plot " + texture + " --kind " + kind + " --out " + picture + " --size 256 --window 10mm");
        INFO(ran.err);
        CHECK(ran.code == 0);
        CHECK(ran.out.empty());
        CHECK(png_size(picture) == std::pair<uint32_t, uint32_t>(256, 256));
    }
}

TEST_CASE("parameters, window and place change the picture")
{
    const Folder folder;
    const std::string texture = folder.write("bumps.haptel", bumps) + ":bumps";
    const auto drawn = [&](const std::string& arguments) {
        const std::string picture = folder.file("x.png");
        CHECK(run_command("plot " + texture + " --out " + picture + " --size 128 " + arguments).code == 0);
        return read_file(picture);
    };
    const std::string plain = drawn("");
    CHECK(plain == drawn("--kind shaded --window 20mm --at 0,0,0"));
    CHECK(plain != drawn("--set depth=100um"));
    CHECK(plain != drawn("--window 15mm"));
    CHECK(plain != drawn("--at 1mm,0,0"));
    CHECK(plain != drawn("--kind height"));
}

TEST_CASE("plot says what is wrong: 1 for findings, 2 for misuse")
{
    const Folder folder;
    const std::string file = folder.write("bumps.haptel", bumps);
    const std::string to = " --out " + folder.file("x.png");
    CHECK(run_command("plot " + file + ":bumbs" + to).code == 1);
    CHECK(contains(run_command("plot " + file + ":bumbs" + to).err, "bumps"));
    CHECK(run_command("plot /no/such.haptel:bumps" + to).code == 1);
    CHECK(run_command("plot " + file + ":bumps --set depht=1um" + to).code == 1);
    CHECK(run_command("plot " + file + ":bumps --out /no/such/folder/x.png").code == 1);
    const Ran nowhere = run_command("plot '" + file + ":bumps' --size 64 --out '" + folder.file("none/p.png") + "'");
    CHECK(nowhere.code == 1);
    CHECK(contains(nowhere.err, "none/p.png': No such file or directory"));
    const std::string broken = folder.write("broken.haptel", "texture t() { return");
    CHECK(contains(run_command("plot " + broken + ":t" + to).err, "broken.haptel:1:"));

    for (const std::string arguments :
         {"--window 0", "--window twelve", "--size 3", "--kind photo", "--set depth", "--at 1,2"}) {
        CAPTURE(arguments);
        CHECK(run_command("plot " + file + ":bumps" + to + " " + arguments).code == 2);
    }
    CHECK(run_command("plot " + file + to).code == 2);
    CHECK(run_command("plot " + file + ":bumps").code == 2);
}
