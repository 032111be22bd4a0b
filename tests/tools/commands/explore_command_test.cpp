// The main job end to end: scene file, texture file, compiler, servo, simulated device, report.
#include "tests/support/catch.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/explore_stage.h"
#include "tests/tools/commands/png.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>
#include <sys/stat.h>
#include <utility>

using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("explore feels a scene and reports it as promised")
{
    const Stage stage;
    const Ran ran =
        run_command("explore " + stage.scene + " --seconds 3 --clock virtual --json --out " + stage.out("run"));
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = json_of(ran);
    CHECK(json["ticks"] == 3000);
    CHECK(json["seconds"] == 3.0);
    CHECK(json["rate_hz"] == 1000.0);
    CHECK(json["missed_deadlines"] == 0);
    CHECK(json["contact_ticks"] > 1500);
    CHECK(json["faults"] == 0);
    CHECK(json["textures_compiled"] == 1);
    CHECK(json["reloads"] == 0);
    CHECK((json["allocations_in_tick"] == 0 || json["allocations_in_tick"].is_null()));
    CHECK(json["position_resolution_m"] == 30e-6); // of simulated:premium
    const double felt_m =
        json["felt_height_m"]["maximum"].get<double>() - json["felt_height_m"]["minimum"].get<double>();
    CHECK(std::fabs(felt_m - 120e-6) < 1e-6); // twice the grooves' depth: the circle crosses them
    CHECK(json["texture_below_resolution"] == false);
    CHECK(json["force_n"]["max"] > 0.3);
    CHECK(json["force_n"]["max"] <= 7.0);
    CHECK(json["tick_ns"]["median"] > 0);
    CHECK(json["tick_ns"]["p99"] >= json["tick_ns"]["median"]);
    CHECK(json["wake_late_us"]["median"].is_null()); // no deadlines on the virtual clock

    CHECK(Json::parse(read_file(stage.out("run") + "/report.json")) == json);
    const auto rows = felt(stage.out("run"));
    CHECK(rows.size() == 3001);
    CHECK(contains(
        rows[0],
        "tick,time_s,x_m,y_m,z_m,tail_x_m,tail_y_m,tail_z_m,fx_n,fy_n,fz_n,contact,depth_m,height_m,binding,"));
    for (const char* picture : {"force.png", "path.png", "tick_time.png"}) {
        CAPTURE(picture);
        CHECK(png_size(stage.out("run") + "/" + picture).first > 500);
    }
}

TEST_CASE("what a tick leaves out is counted in the report")
{
    const Folder folder;
    folder.write("rock.haptel", "texture rock() { return 60um * fbm(p / 4mm, 4); }\n");
    const auto skipped = [&](double v_max_m_per_s) {
        const std::string scene = folder.write(
            "scene.toml", fmt::format("[servo]\nv_max_m_per_s = {}\n[device]\nstroke = \"press\"\n"
                                      "[[object]]\nshape = \"sphere\"\nsize_m = 0.1\ntexture = \"rock.haptel:rock\"\n"
                                      "[[object]]\nshape = \"box\"\nsize_m = 0.1\nposition_m = [1, 0, 0]\n",
                                      v_max_m_per_s));
        const Ran ran = run_command("explore " + scene + " --seconds 3 --clock virtual --json");
        INFO(ran.err);
        REQUIRE(ran.code == 0);
        const Json json = json_of(ran);
        const int touched = json["contact_ticks"];
        REQUIRE((touched > 500 && touched < 2900));
        CHECK(json["skipped"]["texture"] == 3000 - touched);
        CHECK(json["skipped"]["mapping"] == touched); // the sphere has coordinates, which the rock does not read
        CHECK(json["skipped"]["objects"].get<int>() > 2900);
        return std::pair(json["skipped"]["octaves"].get<int>(), touched);
    };
    const auto [of_fast, touched_fast] = skipped(0.5); // a footprint of 1 mm, where octaves have 4, 2, 1 and 0.5 mm
    CHECK(of_fast == touched_fast);
    const auto [of_slow, touched_slow] = skipped(0.01);
    CHECK(of_slow == 0);
}

TEST_CASE("through a workspace twin runs and a replay feel the same, bit for bit, and energy is the hand's")
{
    const Stage stage("[workspace]\nscale = 0.3\nposition_m = [0.01, 0, 0]\nrotation_deg = [10, 20, 30]\n");
    const auto explore = [&](const std::string& name, const std::string& device) {
        const Ran ran = run_command("explore " + stage.scene + " --seconds 1 --clock virtual --json --out " +
                                    stage.out(name) + device);
        INFO(ran.err);
        REQUIRE(ran.code == 0);
        return json_of(ran);
    };
    const Json json = explore("a", "");
    CHECK(json["contact_ticks"] > 300);
    if (is_sanitized) return; // which takes long over the pictures
    explore("b", "");
    explore("c", " --device replay:" + stage.out("a") + "/trace.csv");
    CHECK(felt(stage.out("a")) == felt(stage.out("b")));
    CHECK(felt(stage.out("a")) == felt(stage.out("c")));
}

TEST_CASE("two devices on one scene feel what each feels alone, and are reported each")
{
    const Folder folder;
    folder.write("grooves.haptel", grooves);
    const std::string first = "name = \"simulated:touch\"\nseed = 3\nstroke = \"random\"\n",
                      second =
                          "stroke = \"press\"\nprobe = { kind = \"sphere\", radius_m = 0.004 }\nworkspace = { scale "
                          "= 0.5 }\n",
                      object = "[[object]]\nshape = \"icosphere\"\nsize_m = 0.1\ntexture = \"grooves.haptel:grooves\"\n"
                               "magnet = { force_n = 0.5, reach_m = 0.01 }\n";
    const auto explore = [&](const std::string& name, const std::string& text, const std::string& more = "") {
        const std::string scene = folder.write(name + ".toml", text + object);
        const Ran ran =
            run_command("explore " + scene + " --seconds 2 --clock virtual --json --out " + folder.file(name) + more);
        INFO(ran.err);
        REQUIRE(ran.code == 0);
        return json_of(ran);
    };
    const Json both = explore("both", "[[device]]\n" + first + "[[device]]\n" + second);
    REQUIRE(both["devices"].size() == 2);
    CHECK(both["device"] == "simulated:touch");
    CHECK(both["devices"][0]["device"] == "simulated:touch");
    CHECK(both["devices"][1]["device"] == "simulated:premium");
    CHECK(both["devices"][1]["tick_ns"]["median"] > 0);
    for (const char* picture : {"force_2.png", "path_2.png", "tick_time_2.png"})
        CHECK(png_size(folder.file("both") + "/" + picture).first > 500);
    if (is_sanitized) return; // which takes long over the pictures

    const Json one = explore("one", "[device]\n" + first), two = explore("two", "[device]\n" + second);
    explore("again", "[[device]]\n" + first + "[[device]]\n" + second);
    const auto rows = [&](const std::string& name, const std::string& trace) { return felt(folder.file(name), trace); };
    CHECK(rows("both", "trace.csv").size() == 2001);
    CHECK(rows("both", "trace.csv") == rows("one", "trace.csv"));
    CHECK(rows("both", "trace_2.csv") == rows("two", "trace.csv"));
    CHECK(rows("again", "trace_2.csv") == rows("both", "trace_2.csv"));
    CHECK(rows("both", "trace.csv") != rows("both", "trace_2.csv"));
    CHECK(one["devices"].size() == 1);
    for (const char* field : {"ticks", "seconds", "contact_ticks", "force_n", "energy_j", "faults", "skipped"}) {
        CAPTURE(field);
        CHECK(both[field] == one[field]);
        CHECK(both["devices"][0][field] == one[field]);
        CHECK(both["devices"][1][field] == two[field]);
    }

    // A replay in the place of each.
    const Json replayed = explore("replayed", "[[device]]\n" + first + "[[device]]\n" + second,
                                  " --device replay:" + folder.file("both") +
                                      "/trace.csv --device replay:" + folder.file("both") + "/trace_2.csv");
    CHECK(rows("replayed", "trace.csv") == rows("both", "trace.csv"));
    CHECK(rows("replayed", "trace_2.csv") == rows("both", "trace_2.csv"));
    const Ran many = run_command("explore " + folder.file("one.toml") + " --device simulated --device simulated");
    CHECK(many.code == 1);
    CHECK(contains(many.err, "--device is given 2 times, but the scene has one device"));
    const Ran other = run_command("explore " + folder.file("one.toml") + " --device simulated:tuch");
    CHECK(contains(other.err, "device `simulated:touch`: `--device simulated:tuch` in its place: unknown"));
    const Ran people = run_command("explore " + folder.file("both.toml") + " --seconds 0.1 --clock virtual");
    CHECK(contains(people.out, "both.toml with simulated:touch"));
    CHECK(contains(people.out, "both.toml with simulated:premium"));
}

TEST_CASE("who waits for a small force is told so, in the report, the trace and for people")
{
    const Stage stage;
    const std::string scene = stage.folder.write("wait.toml", "[servo]\nwait_for_small_force_n = 0.05\n[[object]]\n"
                                                              "shape = \"icosphere\"\nmagnet = { force_n = 1, "
                                                              "reach_m = 0.1 }\n");
    const Ran ran =
        run_command("explore " + scene + " --seconds 0.2 --clock virtual --json --out " + stage.out("wait"));
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = json_of(ran);
    const auto waited = json["waiting_ticks"].get<uint64_t>();
    CHECK(waited > 0);
    uint64_t rows_waiting = 0;
    for (const std::string& row : felt(stage.out("wait")))
        rows_waiting += row.ends_with(",1,0,0,0,0,0,0,0,0,0,"); // no torque, no grip, not degraded, no object, no fault
    CHECK(rows_waiting == waited);
    CHECK(contains(run_command("explore " + scene + " --seconds 0.2 --clock virtual").out,
                   "waited       " + std::to_string(waited) + " ticks"));
}

TEST_CASE("the report for people names the same things")
{
    const Stage stage;
    const Ran ran = run_command("explore " + stage.scene + " --seconds 1 --clock virtual");
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "scene.toml with simulated:premium"));
    CHECK(contains(ran.out, "1000 ticks at 1000 Hz"));
    CHECK(ran.err.empty()); // no terminal, no status
}

TEST_CASE("twin runs on the virtual clock and a replay feel the same, bit for bit")
{
    if (is_sanitized) return; // which takes long over the pictures: the test below replays as well
    // A hand that presses harder than the touch device can hold: its saturation is part of what must repeat.
    for (const std::string device : {"name = \"simulated:touch\"\npress_n = 9", "stroke = \"random\""}) {
        CAPTURE(device);
        const Stage stage(device);
        const std::string explore = "explore " + stage.scene + " --clock virtual --out ";
        REQUIRE(run_command(explore + stage.out("one") + " --seconds 2").code == 0);
        REQUIRE(run_command(explore + stage.out("two") + " --seconds 2").code == 0);
        REQUIRE(
            run_command(explore + stage.out("replay") + " --device replay:" + stage.out("one") + "/trace.csv").code ==
            0);
        const auto one = felt(stage.out("one"));
        CHECK(one.size() == 2001);
        CHECK(one == felt(stage.out("two")));
        CHECK(one == felt(stage.out("replay")));
    }
}

TEST_CASE("a replay knows the limits of the device that was recorded, whatever the scene names, and its own gaps")
{
    const Stage stage("press_n = 9"); // on the default device
    const std::string explore = "explore " + stage.scene + " --clock virtual --json --out ";
    const Ran one = run_command(explore + stage.out("one") + " --device simulated:touch --seconds 2");
    REQUIRE(one.code == 0);
    CHECK(contains(one.err, "`press_n` is 9 N, but at most 3.3 N push back, all that `simulated:touch` can hold"));
    const std::string trace = stage.out("one") + "/trace.csv";
    const Ran ran = run_command(explore + stage.out("replay") + " --device replay:" + trace);
    CHECK(ran.err.empty());
    CHECK(felt(stage.out("one")) == felt(stage.out("replay")));
    CHECK(json_of(ran)["ticks"] == 2000);
    CHECK(json_of(ran)["seconds"] == 2);

    std::string rows;
    std::istringstream in(read_file(trace));
    for (std::string line; std::getline(in, line);)
        if (!line.starts_with("77,")) rows += line + "\n";
    const Ran gap = run_command("explore " + stage.scene +
                                " --clock virtual --device replay:" + stage.folder.write("gap.csv", rows));
    CHECK(gap.code == 0);
    CHECK(contains(gap.err, "warning: "));
    CHECK(contains(gap.err, "1 of 2000 ticks are missing, the first of them tick 77"));
}

TEST_CASE("what is wrong with a scene is said, with its place, and is exit code 1")
{
    const auto refused = [](const Stage& stage, const std::string& arguments = "") {
        const Ran ran = run_command("explore " + stage.scene + " --seconds 1 --clock virtual --json " + arguments);
        CHECK(ran.code == 1);
        CHECK(ran.out.empty());
        return ran.err;
    };
    CHECK(contains(refused(Stage("", "colour = 3\n")), "colour"));
    CHECK(contains(refused(Stage("", "stifness_n_per_m = 3\n")), "stiffness_n_per_m"));
    CHECK(contains(refused(Stage("name = \"simulated:premum\"")), "premium"));
    CHECK(contains(refused(Stage(), "--device replay:/no/such/trace.csv"), "/no/such/trace.csv"));
    CHECK(contains(refused(Stage(), "--device teapot"), "teapot"));
    CHECK(contains(refused(Stage("", "parameters = { depht = \"1um\" }\n")), "depth"));

    const Stage broken;
    broken.folder.write("grooves.haptel", "texture grooves() { return 1mm * sinn(p.x); }");
    CHECK(contains(refused(broken), "grooves.haptel:1:"));
    CHECK(run_command("explore /no/such/scene.toml").code == 1);

    const Stage slow("[servo]\nrate_hz = 100000\n"); // 2000 sines in a fifth of 10 us
    slow.folder.write("grooves.haptel", "texture grooves() { float h = 0.0; for (int i = 0; i < 2000; ++i)"
                                        " h += sin(p.x / 1mm + float(i)); return clamp(1um * h, -1mm, 1mm); }");
    const std::string why = refused(slow);
    INFO(why);
    CHECK(contains(why, "per call (median), more than the 2 us that a servo period of 10 us leaves for it"));
}

TEST_CASE("a folder that cannot be written is an error before anything runs")
{
    const Stage stage;
    const Ran ran =
        run_command("explore " + stage.scene + " --seconds 1 --clock virtual --out " + stage.scene + "/run");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "trace.csv"));
}

TEST_CASE("a scene of the current folder is named without a path")
{
    const Stage stage;
    const std::filesystem::path scene = stage.scene;
    const Ran ran = run_command("explore '" + scene.filename().string() + "' --seconds 0.1 --clock virtual --json",
                                "cd '" + scene.parent_path().string() + "' &&");
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(json_of(ran)["ticks"] == 100);
}

TEST_CASE("misuse of explore is exit code 2")
{
    const Stage stage;
    for (const std::string arguments : {"", "--seconds", "--seconds -1", "--seconds nan", "--clock slow", "--jason"}) {
        CAPTURE(arguments);
        CHECK(run_command("explore " + (arguments.empty() ? "" : stage.scene + " " + arguments)).code == 2);
    }
}

TEST_CASE("an interrupt ends the run cleanly, with its report")
{
    const Stage stage;
    const std::string signal = GENERATE("INT", "TERM", "HUP"); // HUP: the terminal was closed
    CAPTURE(signal);
    // As soon as the run writes its trace, however long it took to start.
    const std::string out = stage.folder.file("run");
    const std::string script =
        stage.folder.write("interrupt.sh", "\"$@\" & command=$!\n"
                                           "until [ -e '" +
                                               out +
                                               "/trace.csv' ] || ! kill -0 $command 2>/dev/null\n"
                                               "do sleep 0.05; done\n"
                                               "sleep 0.3; kill -" +
                                               signal + " $command; wait $command\n");
    const std::string clock = GENERATE("wall", "virtual"); // virtual: a servo faster than the trace is written
    if (is_sanitized && (signal == "INT") != (clock == "virtual")) return; // takes long over the pictures
    const Ran ran = run_command("explore " + stage.scene + " --json --clock " + clock + " --out '" + out + "'",
                                "timeout -s KILL 30 sh '" + script + "'");
    CHECK(ran.code == 0);
    CHECK(json_of(ran)["state"] == "stopped");
}

TEST_CASE("explore: a signal ends it at once while its scene is loaded")
{
    const Folder folder;
    std::string elements = "ply\nformat ascii 1.0\n"; // which takes its reader many seconds
    for (int i = 0; i < 200'000; ++i) elements += "element e" + std::to_string(i) + " 1\nproperty float x\n";
    folder.write("slow.ply", elements + "end_header\n");
    const std::string scene = folder.write("slow.toml", "[[object]]\nmesh = \"slow.ply\"\n");
    const std::string script = folder.write("end.sh", "\"$@\" & sleep 0.5; kill -TERM $!; wait $!\n");
    const Ran ran = run_command("explore '" + scene + "' --clock virtual --seconds 0.1", "sh '" + script + "'");
    CHECK(ran.code == 128 + SIGTERM);
    CHECK(!contains(ran.err, "error"));
}

TEST_CASE("a scene that is no file is refused, never waited for")
{
    const Folder folder;
    const std::string pipe = folder.file("pipe.toml");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const Ran ran = run_command("explore '" + pipe + "' --seconds 0.1 --clock virtual", "timeout 20");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "not a regular file"));
}
