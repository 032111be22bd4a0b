// haptel test: files and folders of textures, the table, JSON, JUnit, exit codes.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

#include <nlohmann/json.hpp>

using namespace haptel::test;
using Json = nlohmann::json;

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
