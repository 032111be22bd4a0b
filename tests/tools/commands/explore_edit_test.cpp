// haptel explore while its files are edited: scene, meshes and textures.
#include "runtime/servo/recording.h"
#include "tests/tools/commands/explore_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

using namespace haptel::test;
using haptel::tools::Json;
namespace runtime = haptel::runtime;

namespace {

// For a shell: in the background, once the run that writes there feels something, however long it took to start.
std::string once_felt(const std::string& out, const std::string& edits)
{
    return "(for i in $(seq 400); do [ -s '" + out + "/trace.csv' ] && break; sleep 0.05; done; " + edits + ") & ";
}

} // namespace

TEST_CASE("a scene or a mesh that is edited is felt without a restart; a broken edit is explained and not felt")
{
    const Folder folder;
    folder.write("grooves.haptel", grooves);
    const auto roof = [](const char* ridge) { // a roof over the square of 2 units
        return "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 " + std::string(ridge) +
               "\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    };
    folder.write("roof.obj", roof("0.1"));
    const auto scene = [&](const std::string& name, const std::string& more) {
        return folder.write(name,
                            "[servo]\n" + more +
                                "[device]\nstroke = \"press\"\npress_n = 2\n[[object]]\nmesh = \"roof.obj\"\nsize_m = "
                                "0.1\ntexture = \"grooves.haptel:grooves\"\n");
    };
    const std::string path = scene("scene.toml", "");
    folder.write("higher.obj", roof("0.11"));
    scene("limited.toml", "force_limit_n = 0.5\n");
    scene("wrong.toml", "force_limi_n = 0.5\n");
    scene("faster.toml", "rate_hz = 2000\n");
    const auto copy = [&](const char* from, const char* to) {
        return "cp " + folder.file(from) + " " + folder.file(to) + "; sleep 0.5; ";
    };
    const std::string edits =
        once_felt(folder.file("run"), "sleep 1.7; " + copy("limited.toml", "scene.toml") +
                                          copy("wrong.toml", "scene.toml") + copy("faster.toml", "scene.toml") +
                                          copy("limited.toml", "scene.toml") + copy("higher.obj", "roof.obj"));
    const Ran ran = run_command("explore " + path + " --seconds 5.5 --json --out " + folder.file("run"), edits);
    INFO(ran.err);
    CHECK(ran.code == 0);
    const Json json = json_of(ran);
    CHECK(json["scenes_swapped"] == 3); // limited, limited again, the mesh
    CHECK((json["allocations_in_tick"] == 0 || json["allocations_in_tick"].is_null()));
    CHECK(contains(ran.err,
                   "scene.toml:2:1: error: unknown key `force_limi_n` in [servo]: did you mean `force_limit_n`?"));
    CHECK(contains(ran.err, "scene.toml: not used; what was felt stays"));
    CHECK(contains(ran.err, "scene.toml: not used: the rate of a servo cannot change"));
    CHECK(contains(ran.err, "scene.toml: reloaded"));
    // Pressed with 2 N, limited to a quarter of it since the first edit.
    double before_n = 0, after_n = 0;
    for (const std::string& row : felt(folder.file("run"))) {
        std::istringstream cells(row);
        std::vector<double> values;
        for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::strtod(cell.c_str(), nullptr));
        const double force_n = std::hypot(values[8], values[9], values[10]);
        if (values[1] < 1.2) before_n = std::max(before_n, force_n);
        if (values[1] > 3) after_n = std::max(after_n, force_n);
    }
    CHECK(before_n > 0.7);
    CHECK(after_n <= 0.5 + 1e-12);
    CHECK(after_n > 0.4);
}

TEST_CASE("a probe that is edited is that of the next start, and that is said once: the hand goes on with what it has")
{
    const Folder folder;
    const auto scene = [&](const std::string& name, const std::string& probe, const std::string& of_second) {
        return folder.write(name, "[probe]\nkind = \"" + probe + "\"\n[[device]]\nstroke = \"press\"\n[[device]]\n" +
                                      of_second + "[[object]]\nshape = \"box\"\n");
    };
    const std::string path = scene("scene.toml", "point", "");
    scene("point.toml", "point", "");
    scene("own.toml", "point", "probe = { kind = \"stylus\" }\n");
    scene("gripper.toml", "gripper", "");
    scene("softer.toml", "gripper", "press_n = 0.5\n");
    const auto edit = [&](const char* to) {
        return "cp " + folder.file(to) + " " + folder.file("scene.toml") + "; sleep 0.6; ";
    };
    const std::string edits = once_felt(folder.file("run"), "sleep 1.2; " + edit("own.toml") + edit("point.toml") +
                                                                edit("gripper.toml") + edit("softer.toml"));
    const Ran ran = run_command("explore " + path + " --seconds 6 --json --out " + folder.file("run"), edits);
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(json_of(ran)["scenes_swapped"] == 4);
    const std::string reloaded =
                          "scene.toml: reloaded; devices, probes and workspaces stay as they were at the start\n",
                      another = "scene.toml: another probe is felt after a restart\n";
    CHECK(ran.err == reloaded + another + reloaded + reloaded + another + reloaded);
    // A point has no tail: as a gripper's second finger it would never let go of the box.
    int left = 0, touched = 0;
    const auto trace = runtime::read_trace(folder.file("run/trace.csv"));
    REQUIRE(trace.error.empty());
    for (const runtime::TickRecord& tick : trace.records) {
        if (tick.time_s < 3.5) continue;
        left += tick.contact == 0;
        touched += tick.contact > 0;
    }
    CHECK(left > 300);
    CHECK(touched > 300);
}

TEST_CASE("a scene whose file goes is felt on, which is said once; it is taken up again when it is back")
{
    const Folder folder;
    std::filesystem::create_directory(folder.path / "there");
    const std::string path =
        folder.write("there/scene.toml", "[device]\nstroke = \"press\"\n[[object]]\nshape = \"plane\"\n");
    const std::string edits = "(cd " + folder.path.string() +
                              "; cp there/scene.toml kept.toml; sleep 1.5; rm -r there; sleep 2"
                              "; mkdir there; cp kept.toml there/scene.toml; sleep 1.2"
                              "; rm there/scene.toml; sleep 0.1; cp kept.toml there/scene.toml) & ";
    const Ran ran = run_command("explore " + path + " --seconds 6 --json", edits);
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(json_of(ran)["scenes_swapped"] == 1);
    const std::string gone =
                          "scene.toml: the file is gone; what was felt stays, and the file is read when it is back\n",
                      back = "scene.toml: reloaded; devices, probes and workspaces stay as they were at the start\n";
    CHECK(ran.err == gone + back); // nothing of the second time: an editor may save like that
}

TEST_CASE("a texture that is edited is felt without a restart; a broken edit is explained and not felt")
{
    const Stage stage;
    stage.folder.write("deeper.haptel", std::string(grooves) + "// edited\n");
    const std::string edits = once_felt(
        stage.out("run"), "cp " + stage.folder.file("deeper.haptel") + " " + stage.folder.file("grooves.haptel") +
                              "; sleep 1; echo 'texture grooves() { return' > " + stage.folder.file("grooves.haptel"));
    const Ran ran = run_command("explore " + stage.scene + " --seconds 3 --json --out " + stage.out("run"), edits);
    CHECK(ran.code == 0);
    const Json json = json_of(ran);
    CHECK(json["reloads"] == 1);
    CHECK(json["textures_compiled"] == 2);
    CHECK(contains(ran.err, "reloaded"));
    CHECK(contains(ran.err, "grooves.haptel:2:1: error"));
}
