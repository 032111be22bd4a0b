// haptel fit: a picture and a table made by plain arithmetic, and the parameters that they were made with.
#include "tests/support/catch.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <cmath>
#include <numbers>
#include <random>
#include <string>

using namespace haptel::test;
using haptel::tools::Json;

namespace {

const char* const ridges = "texture ridges(float depth = 50um in 1um .. 1mm, float pitch = 1mm in 0.2mm .. 20mm,\n"
                           "    int profile = round in {round, flat}, vec2 shift = vec2(0.0, 0.0) in 0.0 .. 0.5)\n"
                           "{\n"
                           "    float wave = sinturn(p.x / pitch + shift.x + 0.0 * shift.y);\n"
                           "    return 0.5 * depth * (profile == round ? wave : clamp(3.0 * wave, -1.0, 1.0));\n"
                           "}\n";

// 16 bits, the row on top first; 0.1 mm a pixel, white is 0.5 mm.
std::string picture(double depth_m, double pitch_m, double shift)
{
    constexpr int side = 128;
    std::string bytes = "P5 128 128 65535\n";
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const double x_m = (column + 0.5 - side / 2.0) * 1e-4;
            const double height_m = 0.2e-3 + 0.5 * depth_m * std::sin(2 * std::numbers::pi * (x_m / pitch_m + shift));
            const auto gray = static_cast<unsigned>(std::lround(height_m / 0.5e-3 * 65535));
            bytes += static_cast<char>(gray >> 8);
            bytes += static_cast<char>(gray & 255);
        }
    return bytes;
}

} // namespace

TEST_CASE("fit finds what a picture of heights was made with, and writes a preset of it")
{
    const Folder folder;
    const std::string file = folder.write("ridges.haptel", ridges),
                      map = folder.write("map.pgm", picture(0.12e-3, 1.7e-3, 0.3)),
                      out = (folder.path / "found.haptel").string();
    const Ran ran = run_command("fit '" + file + ":ridges' --to '" + map + "' --scale 0.1mm --height 0.5mm --preset '" +
                                out + "' --json");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    CHECK(json["parameters"]["depth"].get<double>() == Approx(0.12e-3).epsilon(1e-3));
    CHECK(json["parameters"]["pitch"].get<double>() == Approx(1.7e-3).epsilon(1e-4));
    CHECK(json["parameters"]["shift.x"].get<double>() == Approx(0.3).epsilon(1e-3));
    CHECK(json["parameters"]["profile"] == "round");
    CHECK(json["error"].get<double>() < 1e-3); // what 16 bits leave
    CHECK(json["bands"] == nullptr);
    REQUIRE(json["undetermined"].size() == 1);
    CHECK(json["undetermined"][0]["name"] == "shift.y");

    const Ran height = run_command("eval '" + out + ":fitted' --at 0.0002,0,0 --json");
    INFO(height.err);
    REQUIRE(height.code == 0);
    CHECK(Json::parse(height.out)["height_m"].get<double>() ==
          Approx(0.06e-3 * std::sin(2 * std::numbers::pi * (0.2 / 1.7 + 0.3))).epsilon(1e-3));
}

TEST_CASE("fit finds the pitch and depth that a noisy stroke of forces or accelerations was made with")
{
    const Folder folder;
    const std::string file = folder.write("ridges.haptel", ridges);
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, 0.01);
    // 0.2 m/s over ridges of 2 mm, 0.1 mm deep: 100 Hz; 700 N/m of force, or (2 pi 100)^2 of acceleration
    std::string forces = "time_s,force_n\n", accelerations = "time_s,acceleration_m_per_s2\r\n";
    for (int i = 0; i < 4096; ++i) {
        const double height_m = 0.05e-3 * std::sin(2 * std::numbers::pi * 100 * i * 1e-3);
        forces += std::to_string(i * 1e-3) + "," + std::to_string(1 + 700 * height_m * (1 + noise(random))) + "\n";
        accelerations +=
            std::to_string(i * 1e-3) + "," + std::to_string(-std::pow(200 * std::numbers::pi, 2) * height_m) + "\r\n";
    }
    for (const auto& [table, options] : {std::pair(forces, " --stiffness 700"), std::pair(accelerations, "")}) {
        if (is_sanitized && table == forces) continue; // which takes minutes: the test below fits forces
        const std::string stroke = folder.write("stroke.csv", table);
        const Ran ran = run_command("fit '" + file + ":ridges' --to '" + stroke + "' --speed 0.2" + options +
                                    " --set profile=round --json");
        INFO(ran.err << ran.out);
        REQUIRE(ran.code == 0);
        const Json json = Json::parse(ran.out);
        CHECK(json["parameters"]["pitch"].get<double>() == Approx(2e-3).epsilon(0.12)); // within its third of an octave
        CHECK(json["parameters"]["depth"].get<double>() == Approx(0.1e-3).epsilon(0.12));
        CHECK(json["bands"].size() > 8);
        CHECK(json["fitted"] == Json({"depth", "pitch", "shift.x", "shift.y"}));
    }
}

TEST_CASE("fit takes passes with gaps between them, along the direction that it is told")
{
    const Folder folder;
    const std::string file = folder.write("ridges.haptel", ridges);
    // Along (3, 4) at 0.25 m/s, the hand's x moves at 0.15 m/s: ridges of 2 mm are 75 Hz. Each pass begins elsewhere.
    std::string table = "time_s,force_n\n";
    for (int pass = 0; pass < 12; ++pass)
        for (int i = 0; i < 600; ++i)
            table += std::to_string(pass + i * 1e-3) + "," +
                     std::to_string(700 * 0.05e-3 * std::sin(2 * std::numbers::pi * (75e-3 * i + 0.29 * pass))) + "\n";
    const std::string stroke = folder.write("stroke.csv", table), common = "fit '" + file + ":ridges' --to '" + stroke +
                                                                           "' --speed 0.25 --stiffness 700"
                                                                           " --set profile=round --json";
    const Ran ran = run_command(common + " --direction 3,4");
    INFO(ran.err << ran.out);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    CHECK(json["parameters"]["pitch"].get<double>() == Approx(2e-3).epsilon(0.12)); // within its third of an octave
    CHECK(json["parameters"]["depth"].get<double>() == Approx(0.1e-3).epsilon(0.05));
    CHECK(json["error"].get<double>() < 1);

    CHECK(run_command(common + " --direction 0,0").code == 2);
    CHECK(run_command(common + " --direction north").code == 2);
}

TEST_CASE("fit says what is missing, wrong or unreadable")
{
    const Folder folder;
    const std::string file = folder.write("ridges.haptel", ridges),
                      map = folder.write("map.pgm", picture(1e-4, 1e-3, 0)),
                      table = folder.write("table.csv", "time_s,x\n0,1\n"),
                      uneven = folder.write("uneven.csv", "time_s,force_n\n0,1\n0.001,1\n0.0022,1\n"),
                      still = folder.write("still.csv", "time_s,force_n\n0,1\n0,1\n0,1\n"),
                      backward = folder.write("backward.csv", "time_s,force_n\n0,1\n0.001,1\n0.0005,1\n"),
                      words = folder.write("words.csv", "time_s,force_n\n0,1\n0.001,many\n"),
                      stroke = folder.write("stroke.csv", "time_s,force_n\n0,1\n0.001,1\n0.002,1\n");
    const auto fit = [&](const std::string& rest) { return run_command("fit '" + file + ":ridges' --to " + rest); };
    const auto says = [&](const std::string& rest, int code, const std::string& what) {
        const Ran ran = fit(rest);
        INFO(rest << ": " << ran.err);
        CHECK(ran.code == code);
        CHECK(contains(ran.err, what));
        CHECK(ran.out.empty());
    };
    says("'" + map + "'", 2, "--scale");
    says("'" + stroke + "'", 2, "--speed");
    says("'" + stroke + "' --speed 0.1", 2, "--stiffness");
    says("nowhere.png --scale 1um --height 1mm", 1, "nowhere.png");
    says("'" + file + "' --scale 1um --height 1mm", 1, "ridges.haptel");
    says("'" + table + "' --speed 0.1 --stiffness 1", 1, "table.csv:1: expected the columns");
    says("'" + uneven + "' --speed 0.1 --stiffness 1", 1, "even distances");
    says("'" + backward + "' --speed 0.1 --stiffness 1", 1, "even distances");
    says("'" + still + "' --speed 0.1 --stiffness 1", 1, "do not grow");
    says("'" + words + "' --speed 0.1 --stiffness 1", 1, "words.csv:3: force_n");
    says("'" + stroke + "' --speed 0.1 --stiffness 1", 1, "at least 128 samples in each pass, found 3");
    says("'" + map + "' --scale 0.1mm --height 1mm --set pich=1mm", 1, "pitch");
    says("'" + map + "' --scale 0.1mm --height 1mm --preset /nowhere/x.haptel", 1, "/nowhere/x.haptel");
}
