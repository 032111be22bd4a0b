// haptel eval: values at points, by three engines.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <sys/stat.h>

using namespace haptel::test;
using haptel::tools::Json;

namespace {

const char* const tilt = "texture tilt(float depth = 2mm in 0mm .. 9mm) { return depth * (p.x / 4mm) + 0.5 * p.y; }\n"
                         "texture third() { return p.x / 3.0; }\n"
                         "texture scaled() { return footprint + 0.001 * extent.x + 0.0 * uv.x + 1mm * n.x; }\n";

Json json_of(const Ran& ran)
{
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    return Json::parse(ran.out);
}

} // namespace

TEST_CASE("eval gives height and gradient of a plane, parameters set")
{
    const Folder folder;
    const std::string file = folder.write("tilt.haptel", tilt);
    const Json json = json_of(run_command("eval '" + file + ":tilt' --at 1mm,-2mm,0.5 --set depth=4mm --json"));
    CHECK(std::fabs(json["height_m"].get<double>() - (0.001 - 0.001)) <= 1e-18);
    CHECK(json["gradient"] == Json({1.0, 0.5, 0.0}));
    CHECK(json["faults"] == 0);
    const Ran text = run_command("eval '" + file + ":tilt' --at 1mm,0,0");
    CHECK(contains(text.out, "height_m 0.0005\n"));
    CHECK(contains(text.out, "gradient 0.5 0.5 0\n"));
    const Json inputs = json_of(run_command("eval '" + file +
                                            ":scaled' --at 0,0,0 --footprint 2mm --box 0.1m "
                                            "--normal 1,0,0 --json"));
    CHECK(std::fabs(inputs["height_m"].get<double>() - (0.002 + 0.0001 + 0.001)) <= 1e-17);
}

TEST_CASE("eval shows the material outputs that a texture writes, and no others")
{
    const Folder folder;
    const std::string file = folder.write(
        "sticky.haptel", "texture sticky(out float friction_scale) { friction_scale = 1.5; return 0.0; }\n");
    for (const std::string engine : {"jit", "interpreter", "oracle"}) {
        const Json json = json_of(run_command("eval '" + file + ":sticky' --at 0,0,0 --json --engine " + engine));
        CHECK(json["friction_scale"] == 1.5);
        CHECK(!json.contains("stiffness_scale"));
    }
    CHECK(contains(run_command("eval '" + file + ":sticky' --at 0,0,0").out, "friction_scale 1.5\n"));
    const Json report = json_of(run_command("check '" + file + "' --json"));
    CHECK(report["textures"][0]["outputs"] == Json::array({"friction_scale"}));
}

TEST_CASE("the interpreter agrees to the bit, the oracle prints 36 digits")
{
    const Folder folder;
    const std::string file = folder.write("t.haptel", tilt);
    const std::string at = "eval '" + file + ":third' --at 0.1,0,0 --json --engine ";
    CHECK(json_of(run_command(at + "jit"))["height_m"] == json_of(run_command(at + "interpreter"))["height_m"]);
    const Ran oracle = run_command(at + "oracle");
    // (the double nearest to 0.1) / 3, whose digits go on as those of that double do
    CHECK(contains(oracle.out, "\"height_m\": 0.0333333333333333351837050410419275"));
    CHECK(json_of(oracle)["engine"] == "oracle");
}

TEST_CASE("eval adds columns to a table of points")
{
    const Folder folder;
    const std::string file = folder.write("t.haptel", tilt);
    const auto table = [&](const std::string& csv) {
        const std::string points = folder.write("points.csv", csv);
        return run_command("eval '" + file + ":tilt' --points '" + points + "'");
    };
    CHECK(table("x,y,z\n0.004,0,0\n0,0.002,0\n").out ==
          "x,y,z,height_m,gx,gy,gz,faults\n0.004,0,0,0.002,0.5,0.5,0,0\n0,0.002,0,0.001,0.5,0.5,0,0\n");
    CHECK(table("name,z,y,x\r\na,0,0,0.004\r\n\r\n").out ==
          "name,z,y,x,height_m,gx,gy,gz,faults\na,0,0,0.004,0.002,0.5,0.5,0,0\n");
    CHECK(table("0.004,0,0\n").out == "x,y,z,height_m,gx,gy,gz,faults\n0.004,0,0,0.002,0.5,0.5,0,0\n");
    for (const auto& [csv, message] : std::vector<std::pair<std::string, std::string>>{
             {"x,y\n1,2\n", "points.csv:1: expected the columns x,y,z"},
             {"x,y,z\n1,2,3\n1,2\n", "points.csv:3: column 3: expected a length"},
             {"x,y,z\n1,2,many\n", "found 'many'"},
             {"x,y,z\n1,2,3\n1,2,3,4\n", "points.csv:3: expected 3 columns as in the first line, found 4"},
             {"name,x,y,z\na,1,2,3\n1,2,3\n", "points.csv:3: column 4: expected a length"},
             {"x,y,z,name\n1,2,3\n", "points.csv:2: expected 4 columns as in the first line, found 3"},
             {"1,2,3,4\n1,2,3\n", "points.csv:2: expected 4 columns"},
             {"\x1b[2J\x01" + std::string(5000, 'w') + "\n", "found '?[2J?wwwwwwwww"},
             {std::string(59, 'w') + "\u00e9\n", "found '" + std::string(59, 'w') + "...'"},
             {"", "there are no points"}}) {
        const Ran ran = table(csv);
        INFO(ran.err);
        CHECK(ran.code == 1);
        CHECK(ran.out.empty());
        CHECK(contains(ran.err, message));
        CHECK(ran.err.size() < 1000);
    }
    CHECK(table("\xef\xbb\xbfx,y,z\n0.004,0,0\n").out ==
          "x,y,z,height_m,gx,gy,gz,faults\n0.004,0,0,0.002,0.5,0.5,0,0\n");
    const Ran wide = table(std::string(2 << 20, '1') + "\n");
    CHECK(wide.code == 1);
    CHECK(contains(wide.err, "longer than any of a table"));
    REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
    for (const auto& [name, is] :
         std::vector<std::pair<std::string, std::string>>{{"/dev/zero", "it is a device"},
                                                          {folder.file("pipe"), "it is a pipe"},
                                                          {folder.file("."), "it is a folder"}}) {
        const Ran ran = run_command("eval '" + file + ":tilt' --points '" + name + "'", "timeout 20");
        CHECK(ran.code == 1);
        CHECK(contains(ran.err, "cannot read " + name + ": " + is));
    }
}

TEST_CASE("a table's cells may have units, and faults are told for each point")
{
    const Folder folder;
    // infinite at 0, and flat with a fault there
    const std::string file =
        folder.write("pole.haptel", "texture pole(out float friction_scale) { friction_scale = p.x / 1mm; return 1um "
                                    "/ (p.x / 1mm); }");
    const auto ran = [&](const std::string& csv, const std::string& options) {
        return run_command("eval '" + file + ":pole' --points '" + folder.write("points.csv", csv) + "'" + options);
    };
    CHECK(ran("x,y,z\n1 mm,2cm,-0.5um\n0,0,0\n", "").out ==
          "x,y,z,height_m,gx,gy,gz,friction_scale,faults\n1 mm,2cm,-0.5um,1e-06,-0.001,0,0,1,0\n0,0,0,0,0,0,0,0,3\n");
    CHECK(ran("1mm,0,0\n", "").out.starts_with("x,y,z,height_m,gx,gy,gz,friction_scale,faults\n1mm,0,0,1e-06,"));
    CHECK(contains(ran("1furlong,0,0\n", "").err, "points.csv:1: column 1: unknown unit 'furlong'"));
    CHECK(contains(ran("x,y,z\n0,0,3in\n", "").err, "points.csv:2: column 3: unknown unit 'in'"));

    for (const std::string engine : {"jit", "interpreter", "oracle"}) {
        const Json points = json_of(ran("name,x,y,z\na,1mm,2cm,-0.5um\nb,0,0,0\n", " --json --engine " + engine));
        REQUIRE(points.is_array());
        REQUIRE(points.size() == 2);
        CHECK(points[0]["p_m"] == Json({0.001, 0.02, -0.5e-6}));
        CHECK(points[0]["name"] == "pole");
        CHECK(std::fabs(points[0]["height_m"].get<double>() - 1e-6) < 1e-20);
        CHECK(points[0]["friction_scale"] == 1.0);
        CHECK(points[0]["faults"] == 0);
        CHECK(points[1]["faults"] == 3);
        CHECK(points[1]["height_m"] == 0);
    }
    CHECK(run_command("eval '" + file + ":pole' --points nowhere.csv --json").code == 1);
}

TEST_CASE("eval reads a table of any length piece by piece")
{
    const Folder folder;
    const std::string texture = "'" + folder.write("t.haptel", tilt) + ":tilt'";
    std::string csv = "x,y,z\n";
    for (int i = 0; i < 10'000; ++i) csv += "0.004,0,0\n";
    const Ran whole = run_command("eval " + texture + " --points '" + folder.write("a.csv", csv) + "'");
    CHECK(whole.code == 0);
    CHECK(std::count(whole.out.begin(), whole.out.end(), '\n') == 10'001);
    CHECK(whole.out.ends_with("\n0.004,0,0,0.002,0.5,0.5,0,0\n"));
    const Ran broken = run_command("eval " + texture + " --points '" + folder.write("b.csv", csv + "1,2\n") + "'");
    CHECK(broken.code == 1);
    CHECK(contains(broken.err, "b.csv:10002: column 3: expected a length"));
}

TEST_CASE("eval gives many points the numbers of single ones, in each precision")
{
    const Folder folder;
    const std::string texture =
        "'" + folder.write("hills.haptel", "texture hills() { return 1mm * fbm(p / 3mm, 5); }") + ":hills'";
    std::string csv = "x,y,z\n";
    for (int i = 0; i < 40; ++i) csv += std::to_string(i * 0.00037) + "," + std::to_string(1000 - i) + ",0\n";
    const std::string points = " --points '" + folder.write("points.csv", csv) + "'";
    const std::string exact = run_command("eval " + texture + points + " --engine interpreter").out;
    std::vector<std::string> seen;
    for (const std::string precision : {"f64", "mixed", "f32"}) {
        const std::string table = run_command("eval " + texture + points + " --precision " + precision).out;
        CHECK(std::count(table.begin(), table.end(), '\n') == 41);
        CHECK((table == exact) == (precision == "f64"));
        CHECK(std::find(seen.begin(), seen.end(), table) == seen.end());
        seen.push_back(table);
        const std::string one = run_command("eval " + texture + " --at 0.00037,999,0 --precision " + precision).out;
        const size_t row = table.find("0.000370,999,0,") + 15;
        CHECK(contains(one, "height_m " + table.substr(row, table.find(',', row) - row) + "\n"));
    }
}

TEST_CASE("eval reads a picture with every engine")
{
    const Folder folder;
    std::string picture = "P5\n16 16\n255\n"; // a PGM
    for (int i = 0; i < 256; ++i) picture += static_cast<char>(i * 37 % 256);
    const std::string arguments =
        "eval '" +
        folder.write("dents.haptel", "texture dents(image t) { return 1mm * sample_tiled(t, p.xy / 1cm); }") +
        ":dents' --set 't=" + folder.write("dents.pgm", picture) + "' --at 3mm,7mm,0 --json --engine ";
    const Json exact = Json::parse(run_command(arguments + "interpreter").out);
    CHECK(Json::parse(run_command(arguments + "jit").out)["height_m"] == exact["height_m"]);
    const double truth = Json::parse(run_command(arguments + "oracle").out)["height_m"].get<double>();
    CHECK(truth > 1e-6);
    CHECK(std::abs(truth - exact["height_m"].get<double>()) < 1e-12 * truth);
}

TEST_CASE("what eval cannot do is said, with the right exit code")
{
    const Folder folder;
    const std::string file = "'" + folder.write("t.haptel", tilt);
    const auto code = [&](const std::string& arguments, const std::string& message) {
        const Ran ran = run_command("eval " + arguments);
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.out.empty());
        CHECK(contains(ran.err, message));
        return ran.code;
    };
    CHECK(code(file + ":tilt' --at 0,0,0 --precision f32 --engine oracle", "the oracle has its own") == 2);
    CHECK(code(file + ":tilt'", "--at") == 2);
    CHECK(code(file + ":tilt' --at 0,0", "expected a point x,y,z") == 2);
    CHECK(code(file + ":tild' --at 0,0,0", "did you mean 'tilt'?") == 1);
    CHECK(code(file + ":tilt' --at 0,0,0 --set dept=1mm", "did you mean 'depth'?") == 1);
    CHECK(code("nowhere.haptel:t --at 0,0,0", "nowhere.haptel:1:1: error: cannot read this file") == 1);
    CHECK(code(file + ":tilt' --points nowhere.csv", "cannot read nowhere.csv") == 1);
}
