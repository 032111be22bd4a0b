// haptel test: files and folders of textures, the table, JSON, JUnit, exit codes.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("test finds the textures of folders, and passes what is right")
{
    const Folder folder;
    std::filesystem::create_directories(folder.path / "a/b");
    folder.write("a/b/wave.haptel", "texture wave() { return 10um * sin(p.x / 1mm); }");
    folder.write("a/flat.haptel", "texture flat() { return 1mm; }\ntexture tilt() { return p.y; }");
    folder.write("a/functions.haptel", "float half_of(float x) { return x / 2.0; }");
    folder.write("a/notes.txt", "not a texture");
    const Ran ran =
        run_command("test '" + folder.file("a") + "' --points 20 --json --junit '" + folder.file("r.xml") + "'");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    CHECK(json["passed"] == 3);
    CHECK(json["failed"] == 0);
    REQUIRE(json["textures"].size() == 3);
    const Json& wave = json["textures"][0];
    CHECK(wave["name"] == "wave");
    CHECK(wave["file"] == folder.file("a") + "/b/wave.haptel");
    CHECK(wave["points"] == 20);
    CHECK(wave["passed"] == true);
    for (const char* figure :
         {"height_error_oracle", "gradient_error_oracle", "conditioning", "gradient_error_difference", "loop_integral"})
        CHECK(wave[figure].get<double>() < 1e-9);
    for (const char* count : {"points_at_kinks", "not_finite", "bounds_exceeded"}) CHECK(wave[count] == 0);
    CHECK(wave["continuity_measured"] == "C1");
    const std::string xml = read_file(folder.path / "r.xml");
    CHECK(contains(xml, "tests=\"3\" failures=\"0\""));
    CHECK(contains(xml, "name=\"wave\""));
}

TEST_CASE("one texture of a file, as a table")
{
    const Folder folder;
    const std::string file = folder.write("two.haptel", "texture a() { return 1mm; } texture b() { return p.x; }");
    const Ran ran = run_command("test '" + file + ":b' --points 10");
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "two.haptel:b"));
    CHECK(contains(ran.out, "1 passed, 0 failed"));
    CHECK_FALSE(contains(ran.out, "two.haptel:a"));
}

TEST_CASE("test and check take a footprint")
{
    const Folder folder;
    // no number from a footprint of more than 1 mm on
    const std::string file = folder.write(
        "fine.haptel", "texture fine() { return footprint > 1mm ? log(p.x / 1m - 9.0) * 1mm : footprint; }");
    CHECK(run_command("test '" + file + "' --points 10").code == 0);
    CHECK(run_command("test '" + file + "' --points 10 --footprint 1mm").code == 0);
    CHECK(run_command("test '" + file + "' --points 10 --footprint 2mm").code == 1);
    const std::string plain = folder.write("plain.haptel", "texture plain() { return 3.0 * footprint; }");
    const auto height = [&](const std::string& option) {
        return Json::parse(run_command("check '" + plain + "' --json" + option).out)["textures"][0]["height_m"];
    };
    CHECK(height("")["maximum"] == 0.0);
    CHECK(height(" --footprint 2mm")["minimum"] == 0.006);
    CHECK(height(" --footprint 2mm")["maximum"] == 0.006);
    CHECK(run_command("test '" + file + "' --footprint -1mm").code == 2);
}

TEST_CASE("what fails is exit code 1 and says why")
{
    const Folder folder;
    const std::string pole = folder.write("pole.haptel", "texture pole() { return 1um / (p.x / 1m); }");
    const Ran failed = run_command("test '" + pole + "' --points 20 --junit '" + folder.file("r.xml") + "'");
    CHECK(failed.code == 1);
    CHECK(contains(failed.out, "FAILED"));
    CHECK(contains(failed.out, "not finite"));
    CHECK(contains(read_file(folder.path / "r.xml"), "<failure>"));

    const std::string broken = folder.write("broken.haptel", "texture t() { return dept; }");
    const Ran uncompiled = run_command("test '" + broken + "' --json");
    CHECK(uncompiled.code == 1);
    CHECK(contains(uncompiled.err, "broken.haptel:1:22: error"));
    const Json json = Json::parse(uncompiled.out);
    CHECK(json["failed"] == 1);
    CHECK(json["textures"][0]["points"].is_null());
    CHECK(json["textures"][0]["gradient_error_oracle"].is_null());

    CHECK(run_command("test nowhere.haptel").code == 1);
    std::filesystem::create_directories(folder.path / "empty");
    const Ran empty = run_command("test '" + folder.file("empty") + "'");
    CHECK(empty.code == 1);
    CHECK(contains(empty.err, "no texture"));
    CHECK(run_command("test").code == 2);
    CHECK(run_command("test x.haptel --points none").code == 2);
}

TEST_CASE("a hash of a sine passes and is told, with its place and the cure; columns are explained")
{
    const Folder folder;
    const std::string file =
        folder.write("hashed.haptel", "float rnd(float n)\n{\n    return fract(sin(n) * 43758.5453);\n}\n"
                                      "texture hashed() { return 1mm * rnd(floor(p.x / 1mm)); }\n");
    const Ran ran = run_command("test '" + file + "' --points 100");
    INFO(ran.out);
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "passed, amplifies rounding"));
    CHECK(contains(ran.out, "hashed.haptel:3:12: fract(sin(n) * 43758.5453)"));
    CHECK(contains(ran.out, "hash() of the library"));
    for (const char* column : {"points", "height", "gradient", "differ.", "condit.", "kinks"})
        CHECK(contains(ran.out, std::string("\n") + column + " ")); // at the begin of a line of its own
    const Json json = Json::parse(run_command("test '" + file + "' --points 100 --json").out)["textures"][0];
    CHECK(json["passed"] == true);
    CHECK(json["amplified_rounding"]["line"] == 3);
    CHECK(json["amplified_rounding"]["column"] == 12);
    CHECK(json["amplified_rounding"]["is_hash_of_sine"] == true);
    CHECK(json["amplified_rounding"]["height_error"].get<double>() < 1e-10);
}

TEST_CASE("each figure that fails names its worst point, and eval sees the same there")
{
    const Folder folder;
    const std::string file = folder.write("steep.haptel", "/// @facts slope 0.5, curvature 1, class C1\n"
                                                          "float f(float x) { return sin(x); }\n"
                                                          "texture steep() { return 1mm * f(p.x / 1mm); }");
    const Ran ran = run_command("test '" + file + "' --points 20");
    CHECK(ran.code == 1);
    const std::string lead = "slope leaves its bound: ";
    REQUIRE(contains(ran.out, lead));
    const std::string line = ran.out.substr(ran.out.find(lead));
    const size_t at = line.find("--at ") + 5, found = line.find("found ") + 6;
    REQUIRE(found > at);
    const std::string place = line.substr(at, line.find(':', at) - at);
    const double slope = std::stod(line.substr(found));
    // |cos| of the place, which is at most 1
    CHECK(slope <= 1);
    CHECK(slope > 0.99); // of 400 paths with 26 halvings
    const Json seen = Json::parse(run_command("eval '" + file + ":steep' --json --at " + place).out);
    CHECK(std::abs(seen["gradient"][0].get<double>()) == slope);
}

TEST_CASE("suggested facts are no less than the closed form, and check takes them as they are pasted")
{
    struct Known {
        std::string function;
        double low, high, slope, curvature;
        std::string continuity;
    };
    constexpr double pi = 3.141592653589793, e = 2.718281828459045;
    const double ln2 = std::log(2.0);
    for (const Known& known : std::vector<Known>{
             {"float f(float x) { return sinturn(fract(x)); }", -1, 1, 2 * pi, 4 * pi * pi, "C1"},
             {"float f(vec2 q) { return sin(3.0 * q.x) + sin(3.0 * q.y); }", -2, 2, 3 * std::sqrt(2.0), 9, "C1"},
             {"float f(vec3 q) { return 0.25 * exp2(-dot(q, q)); }", 0, 0.25, 0.25 * std::sqrt(2 * ln2 / e), 0.5 * ln2,
              "C1"},
             {"float f(vecN q) { return cos(q.x); }", -1, 1, 1, 1, "C1"},
             {"vec2 f(float x) { return vec2(sin(x), 2.0 * cos(x)); }", -2, 2, 2, 2, "C1"},
             {"float f(float x) { return abs(x - floor(x) - 0.5); }", 0, 0.5, 1, 0, "C0"},
             // with 3 standing behind a and 0.5 behind b
             {"float f(float x, float a, float b = 0.5) { return a * sin(x) + b; }", -2.5, 3.5, 3, 3, "C1"}}) {
        INFO(known.function);
        const Folder folder;
        const std::string texture = "\ntexture t() { return 0.1mm * f(" +
                                    std::string(contains(known.function, "vec3")    ? "p / 1mm"
                                                : contains(known.function, "vecN")  ? "p.xz / 1mm"
                                                : contains(known.function, "(vec2") ? "p.xy / 1mm"
                                                                                    : "p.x / 1mm") +
                                    (contains(known.function, "float a") ? ", 3.0)" : ")") +
                                    (contains(known.function, "vec2 f") ? ".y; }\n" : "; }\n");
        const std::string file = folder.write("f.haptel", known.function + texture);
        const Ran ran = run_command("test '" + file + ":f' --suggest-facts --domain -4 4 --set a=3.0");
        INFO(ran.out << ran.err);
        REQUIRE(ran.code == 0);
        REQUIRE(contains(ran.out, "to be confirmed.)\n/// @facts value "));
        double low = 0, high = 0, slope = 0, curvature = 0;
        char continuity[8] = "";
        REQUIRE(std::sscanf(ran.out.c_str() + ran.out.find("value "),
                            "value %lf .. %lf, slope %lf, curvature %lf, class %7s", &low, &high, &slope, &curvature,
                            continuity) == 5);
        // Outward, by less than a digit of four.
        const double largest = std::max(std::abs(known.low), known.high);
        const auto is_above = [](double suggested, double truth, double size) {
            return suggested >= truth && suggested <= truth + 2e-3 * size + 1e-9;
        };
        CHECK(is_above(high, known.high, largest));
        CHECK(is_above(-low, -known.low, largest));
        CHECK(is_above(slope, known.slope, known.slope));
        CHECK(is_above(curvature, known.curvature, known.curvature));
        CHECK(continuity == known.continuity);

        const std::string pasted = ran.out.substr(0, ran.out.find("\n", ran.out.find("@facts")) + 1);
        folder.write("f.haptel", pasted + known.function + texture);
        const Ran check = run_command("check '" + file + "' --json");
        INFO(check.err);
        CHECK(check.code == 0);
        const Json json = Json::parse(check.out);
        for (const Json& finding : json["diagnostics"]) CHECK(finding["severity"] == "note");
        CHECK(json["textures"][0]["declared"] == Json::array({"f"}));
        CHECK(run_command("test '" + file + "'").code == 0);
    }
}

TEST_CASE("what cannot be measured is said; textures are measured, and JSON has the numbers")
{
    const Folder folder;
    const std::string file =
        folder.write("m.haptel", "float cell(ivec2 c) { return 1.0; }\n"
                                 "float sized(vec2 q, float size) { return sin(q.x / size); }\n"
                                 "float twice(float g(float), float x) { return g(g(x)); }\n"
                                 "void turn(inout vec2 q) { q = q.yx; }\n"
                                 "float never(float x) { return sqrt(-1.0 - x * x); }\n"
                                 "texture wave(float depth = 10um) { return depth * sinturn(p.x / 2mm); }\n");
    const Ran ran = run_command("test '" + file + "' --suggest-facts --set depth=20um --box 20mm");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "// float cell(ivec2 c): not measured: its first argument is none of"));
    CHECK(contains(
        ran.out,
        "// float sized(vec2 q, float size): not measured: further arguments have no value: --set size=VALUE"));
    CHECK(contains(ran.out, "twice"));
    CHECK(contains(ran.out, "turn"));
    CHECK(contains(ran.out, "// float never(float x): not measured: it is finite nowhere over -8 .. 8"));
    // 20 um, of 2 mm: its slope is 20e-6 * 2 pi / 2e-3 = 0.0628318, its curvature 197.39
    CHECK(contains(ran.out,
                   "/// @facts value -2e-05 .. 2e-05, slope 0.06284, curvature 197.4, class C1\n// texture wave"));
    const Json json = Json::parse(run_command("test '" + file + ":wave' --suggest-facts --json").out)["suggestions"];
    REQUIRE(json.size() == 1);
    CHECK(std::abs(json[0]["value_maximum"].get<double>() - 10e-6) < 1e-12);
    CHECK(json[0]["skipped"].is_null());
    CHECK(run_command("test '" + file + ":cell' --suggest-facts").code == 1);
    CHECK(run_command("test '" + file + "' --suggest-facts --domain 2 1").code == 2);
    CHECK(run_command("test '" + file + "' --domain 1 2").code == 2);
    CHECK(
        run_command("test '" + folder.write("b.haptel", "float f(float x) { return y; }") + "' --suggest-facts").code ==
        1);
}
