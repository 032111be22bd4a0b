#include "tests/support/catch.h"
#include "tests/support/tries.h"
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
    const uint32_t side = is_sanitized ? 64 : 256; // sanitized pixels take long
    for (const std::string kind :
         {"height", "shaded", "relief", "ball", "cylinder", "section", "spectrum", "gradient-error"}) {
        const std::string picture = folder.file(kind + ".png");
        const Ran ran = run_command("plot " + texture + " --kind " + kind + " --out " + picture +
                                    " --window 10mm --size " + std::to_string(side));
        INFO(ran.err);
        CHECK(ran.code == 0);
        CHECK(ran.out.empty());
        CHECK(ran.err.empty());
        CHECK(png_size(picture) == std::pair(side, side));
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

TEST_CASE("plot says what a picture cannot show: what is finer than its pixels, faults, heights without a bound")
{
    const Folder folder;
    const std::string file =
        folder.write("hard.haptel", "texture fine() { return 1um * sinturn(p.x / 20um) * sinturn(p.y / 30um); }\n"
                                    "texture half() { return 1mm * sqrt(p.x / 1mm); }\n"
                                    "texture steep() { return 1mm * sqrt(abs(p.x / 1mm)); }\n"
                                    "texture pole() { return 1um / (p.x / 1mm) + 0.0001 * p.y; }\n");
    const auto said = [&](const std::string& arguments, int size = 128) {
        const Ran ran = run_command("plot " + file + arguments + " --size " + std::to_string(size) + " --out " +
                                    folder.file("x.png"));
        CHECK(ran.code == 0);
        return ran.err;
    };
    const int size = is_sanitized ? 64 : 128; // sanitized pixels take long
    for (const std::string kind : {"height", "shaded", "relief", "ball", "cylinder"}) {
        if (is_sanitized && kind != "height" && kind != "ball") continue;
        CAPTURE(kind);
        CHECK(contains(said(":fine --kind " + kind, size), " samples averaged per pixel; zoom with --window "));
        // Half of a ball as of a square lies at x < 0, where a root has no value.
        CHECK(contains(said(":half --kind " + kind, size),
                       "hard.haptel: faults at 50 % of the places, hatched: the height is not "
                       "finite there and counts as 0\n"));
    }
    CHECK(contains(said(":fine --kind section --at 0,5um,0"), "each pixel shows the range of "));
    CHECK(said(":fine --section 0,-1mm,0 0,1mm,0").empty()); // sin(x) is 0 there, and only changes across
    CHECK(said(":fine --kind height --window 0.3mm").empty());
    CHECK(contains(said(":fine --kind spectrum --window 0.2m"),
                   "finer than two samples of 97.7 µm: they show as longer"));
    CHECK(said(":fine --kind spectrum --window 5mm").empty());
    CHECK(contains(said(":half --section -1mm,0,0 4mm,0,0"), "faults at 20 % of the places"));
    CHECK(said(":half --section 1mm,0,0 4mm,0,0").empty());
    // 1 / x is beyond 16 times the distance of a quarter of the places where |x| is below about 1 of 10 mm.
    CHECK(contains(said(":pole --kind height"), "the height has no bound: colours are for -"));
    CHECK(!contains(said(":steep --kind height"), "no bound"));
}

TEST_CASE("a section goes through any two points, or along any direction")
{
    const Folder folder;
    const std::string texture = folder.write("bumps.haptel", bumps) + ":bumps";
    const auto drawn = [&](const std::string& arguments) {
        const std::string picture = folder.file("x.png");
        CHECK(run_command("plot " + texture + " --out " + picture + " --size 128 " + arguments).code == 0);
        return read_file(picture);
    };
    const std::string across = drawn("--section -10mm,-10mm,0 10mm,10mm,0");
    CHECK(across == drawn("--section -10mm,-10mm,0 10mm,10mm,0 --kind section"));
    CHECK(across != drawn("--section -10mm,10mm,0 10mm,-10mm,0"));
    CHECK(across != drawn("--kind section"));
    CHECK(drawn("--direction 3,0,0 --window 4mm --at 1mm,0.5mm,0") == drawn("--section -1mm,0.5mm,0 3mm,0.5mm,0"));
    CHECK(drawn("--direction 0,0,1").size() > 100);
    for (const std::string arguments :
         {"--section 0,0,0", "--section 0,0,0 0,0,0", "--section 0,0 1,1", "--direction 0,0,0", "--direction 1,1",
          "--section 0,0,0 1,0,0 --direction 1,0,0", "--section 0,0,0 1,0,0 --kind height",
          "--direction 1,0,0 --kind relief"}) {
        CAPTURE(arguments);
        CHECK(run_command("plot " + texture + " --out " + folder.file("y.png") + " " + arguments).code == 2);
    }
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
