// Recordings as users make and use them: recorded, replayed, exported, and kept when the program is killed.
#include "runtime/servo/recording.h"
#include "tests/support/catch.h"
#include "tests/tools/commands/explore_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

using namespace haptel::test;
using haptel::runtime::read_trace;
using haptel::tools::Json;

namespace {

// A scene, and a second of it recorded.
struct Recorded {
    Stage stage;
    std::string file;

    explicit Recorded(const std::string& device = "", const std::string& options = "--clock virtual --seconds 1")
        : stage(device), file(stage.folder.file("run.haptrace"))
    {
        const Ran ran = run_command("record " + stage.scene + " --out " + file + " " + options);
        INFO(ran.err);
        REQUIRE(ran.code == 0);
    }
};

void put_in_place(const std::string& file, const std::string& from, const std::string& to)
{
    std::string text = read_file(file);
    REQUIRE(contains(text, from));
    text.replace(text.find(from), from.size(), to);
    std::ofstream(file) << text;
}

} // namespace

TEST_CASE("a recording is replayed to equal forces, and says what it is of")
{
    const Recorded recorded("stroke = \"random\"");
    const Ran ran = run_command("replay " + recorded.file);
    CHECK(ran.out == "1000 ticks replayed: every force equals the recorded one\n");
    CHECK(ran.err == "");
    CHECK(ran.code == 0);
    const Json json = json_of(run_command("replay " + recorded.file + " --json"));
    CHECK(json["ticks"] == 1000);
    CHECK(json["equal"] == true);
    CHECK(json["first_difference"].is_null());
    CHECK(json["changed"].empty());

    const auto read = read_trace(recorded.file);
    REQUIRE(read.origin);
    CHECK(read.origin->device.name == "simulated:premium");
    CHECK(read.origin->device.force_max_n == 8.5);
    CHECK(read.origin->clock == "virtual");
    REQUIRE(read.origin->files.size() == 2);
    CHECK(read.origin->files[0].path == "scene.toml");
    CHECK(read.origin->files[1].path == "grooves.haptel");

    // Wherever it is started from, and whatever it is called.
    std::filesystem::rename(recorded.file, recorded.stage.folder.file("other.bin"));
    CHECK(run_command("replay other.bin", "cd '" + recorded.stage.folder.path.string() + "' &&").code == 0);
}

TEST_CASE("a recording holds what trace.csv holds, is exported as such, and is a device as such")
{
    const Stage stage("press_n = 9\nname = \"simulated:touch\"");
    const std::string file = stage.out("run.haptrace"), csv = stage.out("exported.csv");
    const std::string explore = "explore " + stage.scene + " --clock virtual --seconds 1 --out ";
    REQUIRE(run_command(explore + stage.out("run") + " --record " + file).code == 0);
    REQUIRE(run_command("replay " + file + " --csv " + csv).code == 0);
    CHECK(read_file(csv) == read_file(stage.out("run") + "/trace.csv"));
    CHECK(contains(run_command("replay " + csv + " " + stage.scene).out, "1000 ticks replayed: every force equals"));

    REQUIRE(run_command(explore + stage.out("again") + " --device replay:" + file).code == 0);
    CHECK(felt(stage.out("again")) == felt(stage.out("run")));

    const Ran nameless = run_command("replay " + csv);
    CHECK(nameless.code == 2);
    CHECK(contains(nameless.err, "does not say of which scene it is"));
}

TEST_CASE("an edited texture is told of with the tick, the figure and the file")
{
    const Recorded recorded;
    // Heights and slopes grow by a 120th, and so does what they add to the force.
    put_in_place(recorded.stage.folder.file("grooves.haptel"), "60um", "60.5um");
    const Ran ran = run_command("replay " + recorded.file + " --json");
    CHECK(ran.code == 1);
    const Json json = json_of(ran);
    CHECK(json["equal"] == false);
    REQUIRE(json["changed"].size() == 1);
    CHECK(json["changed"][0]["path"] == "grooves.haptel");
    CHECK(json["changed"][0]["kind"] == "texture");
    const auto ticks = read_trace(recorded.file).records;
    double most_n = 0;
    for (const auto& tick : ticks) most_n = std::max(most_n, glm::length(tick.force_n));
    uint64_t touch = 0; // nothing can differ before; it comes down on the flank of a groove
    while (touch < ticks.size() && ticks[touch].contact == 0) ++touch;
    const Json& first = json["first_difference"];
    CHECK(first["tick"] >= touch);
    CHECK(first["tick"] < touch + 100);
    CHECK(first["object"] == "icosphere");
    CHECK(json["largest_difference"]["force_n"] > 1e-5);
    CHECK(json["largest_difference"]["force_n"] < most_n / 120);
    CHECK(run_command("replay " + recorded.file + " --tolerance 0.01").code == 0);
    CHECK(contains(run_command("replay " + recorded.file).out, "the texture grooves.haptel has changed since"));
    CHECK(contains(run_command("replay " + recorded.file).out,
                   "first at tick " + std::to_string(first["tick"].get<int>()) + " ("));
}

TEST_CASE("an edited scene is told of, and another one may be felt in its place")
{
    const Recorded recorded;
    const std::string before = read_file(recorded.stage.scene);
    put_in_place(recorded.stage.scene, "size_m = 0.1", "size_m = 0.1\nstiffness_n_per_m = 900");
    const std::string other = recorded.stage.folder.write("other.toml", before);
    const Json json = json_of(run_command("replay " + recorded.file + " --json"));
    CHECK(json["equal"] == false);
    CHECK(json["changed"][0]["kind"] == "scene");
    // A ninth of 800 N/m more on the same way into the surface: the forces were at least so much smaller.
    const Json& largest = json["largest_difference"];
    const auto then = largest["recorded_force_n"], now = largest["replayed_force_n"];
    CHECK(std::abs(now[2].get<double>() / then[2].get<double>() - 900.0 / 800) < 0.05);
    CHECK(run_command("replay " + recorded.file + " " + other).code == 0); // and not the same file, by its content

    std::filesystem::remove(recorded.stage.scene);
    const Ran gone = run_command("replay " + recorded.file);
    CHECK(gone.code == 1);
    CHECK(contains(gone.err, "Name it: haptel replay " + recorded.file + " SCENE.toml"));
}

TEST_CASE("a comment in a texture is told of, and changes no force")
{
    const Recorded recorded;
    put_in_place(recorded.stage.folder.file("grooves.haptel"), "texture", "// deeper?\ntexture");
    const Ran ran = run_command("replay " + recorded.file);
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "the texture grooves.haptel has changed since it was recorded"));
}

TEST_CASE("each device of a scene has a recording, and each is replayed alone")
{
    const Folder folder;
    folder.write("grooves.haptel", grooves);
    const std::string scene = folder.write(
        "two.toml", "[[device]]\n[[device]]\nstroke = \"press\"\nprobe = { kind = \"sphere\", radius_m = 0.004 }\n"
                    "[[object]]\nshape = \"icosphere\"\nsize_m = 0.1\ntexture = \"grooves.haptel:grooves\"\n");
    const std::string out = folder.file("run.haptrace");
    REQUIRE(run_command("record " + scene + " --out " + out + " --seconds 1 --clock virtual").code == 0);
    CHECK(read_trace(folder.file("run_2.haptrace")).origin->hand == 2);
    for (const char* file : {"run.haptrace", "run_2.haptrace"}) {
        CAPTURE(file);
        CHECK(run_command("replay " + folder.file(file)).code == 0);
    }
    put_in_place(scene, "[[device]]\n[[device]]", "[[device]]");
    CHECK(contains(run_command("replay " + folder.file("run_2.haptrace")).err, "recorded with device 2 of its scene"));
}

TEST_CASE("a recording on the wall clock repeats its forces, whatever deadlines were missed")
{
    const Recorded recorded("", "--seconds 1");
    const auto ticks = read_trace(recorded.file);
    CHECK(ticks.origin->clock == "wall");
    CHECK(ticks.error == "");
    CHECK(run_command("replay " + recorded.file).code == 0);
}

TEST_CASE("a recording that is cut or damaged says so")
{
    const Recorded recorded;
    const std::string whole = read_file(recorded.file);
    std::ofstream(recorded.file, std::ios::binary) << whole.substr(0, whole.size() - 1000);
    const Ran cut = run_command("replay " + recorded.file);
    CHECK(cut.code == 0);
    CHECK(contains(cut.err, "within a tick"));
    std::string changed = whole;
    changed[changed.size() / 2] ^= 4;
    std::ofstream(recorded.file, std::ios::binary) << changed;
    const Ran damaged = run_command("replay " + recorded.file);
    CHECK(damaged.code == 1);
    CHECK(contains(damaged.err, " is damaged (bytes "));
    const std::string csv = recorded.stage.out("rest.csv");
    CHECK(run_command("replay " + recorded.file + " --csv " + csv).code == 1); // what is before the damage
    CHECK(read_trace(csv).records.size() > 400);
    const Ran device = run_command("explore " + recorded.stage.scene + " --device replay:" + recorded.file);
    CHECK(device.code == 1);
    CHECK(contains(device.err, " is damaged (bytes "));
}

TEST_CASE("recording over what is no recording is refused before anything is felt")
{
    const Stage stage;
    const std::string before = read_file(stage.scene);
    const Ran ran = run_command("record " + stage.scene + " --out " + stage.scene + " --seconds 1 --clock virtual");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "is there already and is not a recording"));
    CHECK(read_file(stage.scene) == before);
    CHECK(run_command("record " + stage.scene).code == 2);
}

TEST_CASE("a scene is held to the forces beside it, until they are meant to be others")
{
    const Stage stage;
    const std::string feel = stage.out("scene.feel.haptrace"), test = "test --points 10 ";
    const Ran none = run_command(test + stage.scene);
    CHECK(none.code == 1);
    CHECK(contains(none.err, "haptel record " + stage.scene + " --seconds 1 --clock virtual --out " + feel));
    REQUIRE(run_command("record " + stage.scene + " --seconds 1 --clock virtual --out " + feel).code == 0);
    const auto before = std::filesystem::file_size(feel);
    const auto path = read_trace(feel).records;
    CHECK(run_command(test + stage.scene).code == 0);

    // The columns that tell nothing go, and nothing else.
    const Ran small = run_command(test + "--update-feel " + stage.scene);
    CHECK(contains(small.out, "rewritten, 0 of 1000 ticks feel otherwise"));
    CHECK(std::filesystem::file_size(feel) < before * 4 / 5);
    CHECK(contains(run_command(test + "--update-feel " + stage.scene).out, "as it was"));
    const Ran folder = run_command(test + stage.folder.path.string() + " --json");
    CHECK(folder.code == 0);
    CHECK(json_of(folder)["feels"][0]["ticks"] == 1000);
    CHECK(json_of(folder)["textures"].size() == 1);
    CHECK(json_of(folder)["passed"] == 2);

    put_in_place(stage.folder.file("grooves.haptel"), "60um", "61um");
    const Ran other = run_command(test + stage.scene + " --junit " + stage.out("r.xml"));
    CHECK(other.code == 1);
    CHECK(contains(other.out, "first at tick "));
    CHECK(contains(other.out, "on `icosphere`: force "));
    CHECK(contains(other.out, "the texture grooves.haptel has changed since it was recorded"));
    CHECK(contains(other.out, "haptel test --update-feel " + feel));
    CHECK(contains(read_file(stage.out("r.xml")), "tests=\"1\" failures=\"1\""));
    CHECK(run_command(test + stage.scene + " --feel-tolerance 0.1").code == 0);

    const Ran updated = run_command(test + "--update-feel " + stage.folder.path.string());
    CHECK(updated.code == 0);
    CHECK(!contains(updated.out, " 0 of 1000 ticks"));
    CHECK(run_command(test + feel).code == 0);
    const auto again = read_trace(feel).records; // along the same path
    REQUIRE(again.size() == path.size());
    for (std::size_t i = 0; i < path.size(); ++i)
        if (again[i].tip_m != path[i].tip_m || again[i].tail_m != path[i].tail_m) FAIL("the path is another at " << i);

    std::filesystem::resize_file(feel, 5000);
    CHECK(contains(run_command(test + feel).out, "cut after 5000 bytes"));
    CHECK(run_command(test + "--update-feel " + feel).code == 1);
    CHECK(std::filesystem::file_size(feel) == 5000);
}

// Both times are of the system's monotonic clock: that of the last tick in the file, and that at which the kill is
// over, which is later than it was. A busy machine may keep the command from running at all for a while, and then no
// tick was there to be lost, or nobody to write it down: the test tries again, up to five times, and one of them must
// have lost at most 50 ms.
TEST_CASE("a recording that is killed has lost at most the last 50 ms")
{
    const Stage stage;
    const std::string file = stage.out("run.haptrace"), process = stage.out("process");
    const std::string script = stage.folder.write("tell.sh", "echo $$ >'" + process + "'; exec \"$@\"\n");
    double least_lost_ms = 1e9;
    for (int i = 0; i < 5 && least_lost_ms > 50; ++i) {
        std::filesystem::remove(file);
        Ran ran;
        std::chrono::steady_clock::duration killed{};
        {
            const std::jthread running([&] {
                ran = run_command("record " + stage.scene +
                                      " --device simulated:touch --clock wall --seconds 60 --out " + file,
                                  "sh '" + script + "'");
            });
            const auto is_recorded = [&] {
                std::error_code missing;
                return std::filesystem::file_size(file, missing) > 100'000 && !missing;
            };
            for (int wait = 0; wait < 6000 && !is_recorded(); ++wait)
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            std::this_thread::sleep_for(std::chrono::seconds(2));
            kill(std::stoi(read_file(process)), SIGKILL);
            killed = std::chrono::steady_clock::now().time_since_epoch();
        }
        CHECK(ran.code == 128 + SIGKILL);
        const auto recorded = read_trace(file);
        CHECK(recorded.error == "");
        REQUIRE(recorded.records.size() > 1000);
        const double lost_ms = std::chrono::duration<double, std::milli>(killed).count() -
                               static_cast<double>(recorded.records.back().woken_ns) * 1e-6;
        CHECK(lost_ms > 0);
        UNSCOPED_INFO("lost " << lost_ms << " ms after " << recorded.records.size() << " ticks");
        least_lost_ms = std::min(least_lost_ms, lost_ms);
    }
    CHECK(least_lost_ms <= 50);
    CHECK(run_command("replay " + file).code == 0);
}

TEST_CASE("a hand of two axes is replayed as it felt: by slopes alone")
{
    const Recorded recorded("name = \"simulated:2diy\"");
    CHECK(read_trace(recorded.file).origin->device.slopes_only);
    const Ran ran = run_command("replay " + recorded.file);
    CHECK(ran.out == "1000 ticks replayed: every force equals the recorded one\n");
    CHECK(ran.code == 0);
}
