// haptel new --library, pack, install, list, remove: from a library's author to who uses it.
#include "tests/libraries/package/hostile_archives.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/library_stage.h"

#include <algorithm>

using namespace haptel::test;
using haptel::tools::Json;
namespace fs = std::filesystem;

TEST_CASE("a library that is new is packed in one root, to the same bytes twice, and installed and used in another")
{
    const LibraryRoot author, user;
    Ran ran = author.run("new --library wood");
    CHECK(ran.code == 0);
    CHECK(author.run("fmt --check wood/waves.haptel wood/tests/waves.haptel").code == 0);
    CHECK(author.json("build wood --emit object -o wood.o")["textures"].size() == 1); // not its test
    CHECK(author.run("new --library wood").code == 1);
    CHECK(author.run("new --library Wood").code == 2);
    const Json packed = author.json("pack wood -o wood.haptlib");
    CHECK(packed["name"] == "wood");
    CHECK(packed["version"] == "0.1.0");
    CHECK(packed["problems"].empty());
    REQUIRE(packed["textures"].size() == 1);
    CHECK(packed["textures"][0]["preview"] == "previews/waves/waves.png");
    const std::string bytes = read_file(author.work / "wood.haptlib");
    CHECK(packed["bytes"] == bytes.size());
    ran = author.run("pack wood"); // with a picture of its own in the folder it is still the same
    CHECK(ran.out == "wood-0.1.0.haptlib\n");
    CHECK(read_file(author.work / "wood-0.1.0.haptlib") == bytes);

    fs::copy(author.work / "wood.haptlib", user.work / "wood.haptlib");
    ran = user.run("install wood.haptlib");
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(ran.out == (user.libraries / "wood" / "0.1.0").string() + "\n");
    CHECK(read_file(user.libraries / "wood/0.1.0/previews/waves/waves.png").starts_with("\x89PNG"));
    CHECK(std::system(
              ("cd '" + (user.libraries / "wood/0.1.0").string() + "' && sha256sum --quiet -c SHA256SUMS").c_str()) ==
          0);

    // A quarter of a wavelength from 0: half of the depth of 40 um.
    CHECK(height_of(user.run("eval wood.waves:waves --at 0.5mm,0,0")) == "height_m 2e-05");
    user.write("mine.haptel", "import wood.waves as its;\ntexture mine() { return 2.0 * its.waves(); }\n");
    CHECK(height_of(user.run("eval mine.haptel:mine --at 0.5mm,0,0")) == "height_m 4e-05");
    CHECK(user.run("check mine.haptel wood.waves --strict").code == 0);
    CHECK(user.run("test wood.waves --points 500").code == 0);
    CHECK(contains(user.run("info wood.waves").out, "Straight waves"));
    CHECK(user.run("plot wood.waves:waves --size 64 --out waves.png").code == 0);
    for (const char* reference : {"wood.waves", "wood.waves:waves"}) {
        user.write("scene.toml",
                   "[[object]]\nshape = \"box\"\nsize_m = 0.1\ntexture = \"" + std::string(reference) + "\"\n");
        CHECK(user.json("explore scene.toml --seconds 0.3 --clock virtual")["textures_compiled"] == 1);
    }

    const Json built = user.json("build wood --emit header -o wood.h");
    CHECK(built["textures"][0]["symbol"] == "haptel_texture_waves");
    const Json listed = user.json("list");
    REQUIRE(listed["libraries"].size() == 1);
    CHECK(listed["libraries"][0]["textures"] == Json{"wood.waves:waves"});
    CHECK(listed["libraries"][0]["place"] == "user");
    CHECK(contains(user.run("list").out, "wood 0.1.0  What these textures have in common"));
    CHECK(user.run("remove wood").code == 0);
    CHECK(fs::is_empty(user.libraries));
    CHECK(user.json("list")["libraries"].empty());
    ran = user.run("eval wood.waves:waves --at 0,0,0");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "library 'wood' is not installed"));
    ran = user.run("check mine.haptel");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "mine.haptel:1:1: error: cannot read \"wood.waves\": library 'wood' is not installed "
                            "[missing-import]"));
    CHECK(contains(ran.err, "haptel install wood.haptlib"));
    ran = user.run("explore scene.toml --seconds 0.3 --clock virtual");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "library 'wood' is not installed"));
}

TEST_CASE("pack refuses what is not fit to be published, says why, and writes nothing")
{
    const LibraryRoot root;
    const auto said = [&](const std::string& path, const std::string& text) {
        fs::remove_all(root.work / "wood");
        write_library(root, "wood", "wood", "1.0.0", "1");
        root.write("wood/" + path, text);
        const Ran ran = root.run("pack wood -o wood.haptlib");
        CHECK(ran.code == 1);
        CHECK(!fs::exists(root.work / "wood.haptlib"));
        return ran.err;
    };
    CHECK(contains(said("oak.haptel", "texture board() { return 1mm; }\n"),
                   "wood/oak.haptel: error: texture 'board' has no doc comment"));
    CHECK(contains(said("oak.haptel", "/// A\ntexture board() { return 1mm + ; }\n"),
                   "oak.haptel: error: it does not compile"));
    CHECK(contains(said("oak.haptel", "/// A\ntexture bord() { return 1mm; }\n"),
                   "it has no texture 'board', which `textures` of library.toml names: did you mean 'bord'?"));
    CHECK(
        contains(said("oak.haptel", "/// A\ntexture board() { return 1mm; }\n/// B\ntexture bark() { return 1mm; }\n"),
                 "texture 'bark' is not among the `textures` of library.toml: add \"oak:bark\""));
    CHECK(contains(said("tests/oak.haptel", "texture bord() { return 0.0; }\n"),
                   "there is no texture 'board' here that tests"));
    CHECK(contains(
        said("tests/oak.haptel", "import wood.oak as tested;\ntexture board() { return tested.board() - 2mm; }\n"),
        "the test 'board' is not flat, as it is where what it tests holds: -0.001 m at"));
    CHECK(contains(said("tests/oak.haptel", "import wood.stone;\ntexture board() { return 0.0; }\n"),
                   "has no file stone.haptel"));
    CHECK(contains(said("tests/oak.haptel", "import grain.oak;\ntexture board() { return 0.0; }\n"),
                   "library 'grain' is not among the dependencies of library 'wood'"));
    CHECK(contains(said("oak.haptel", "/// A\ntexture board() { return 1mm * detach(p.x / 1mm); }\n"),
                   "texture 'board' does not pass haptel test"));
    CHECK(contains(said("tests/oak.haptel", "texture board() { return 0.0; }\n"),
                   "tests/oak.haptel: error: it does not import what it tests: import wood.oak;"));
    root.write("outside.haptel", "const float K = 1mm;\n");
    CHECK(contains(said("oak.haptel", "import \"../outside.haptel\";\n/// A\ntexture board() { return K; }\n"),
                   "which is outside of the library"));
    CHECK(contains(said("a.out", "x"), "'a.out' is no file for a library"));
    CHECK(contains(said("library.toml", "schema = 1\nname = \"wood\"\n"),
                   "wood/library.toml:1:1: error: `license` is missing"));
    fs::remove_all(root.work / "wood/tests");
    fs::remove(root.work / "wood/library.toml");
    CHECK(contains(root.run("pack wood").err, "it has no library.toml"));
    CHECK(contains(root.run("pack nowhere").err, "cannot read this folder"));

    write_library(root, "wood", "wood", "1.0.0", "1");
    CHECK(root.run("pack wood -o nowhere/wood.haptlib").code == 1);
    CHECK(root.run("pack").code == 2);
    const Json refused = root.json("pack nowhere");
    CHECK(refused["archive"].is_null());
    CHECK(refused["problems"].size() == 1);
    CHECK(root.json("pack wood -o wood.haptlib")["archive"] == "wood.haptlib");
}

TEST_CASE("hostile archives are refused, and nothing is written")
{
    const LibraryRoot root;
    root.write("sound.haptlib", sound_archive());
    CHECK(root.run("install sound.haptlib").code == 0);
    CHECK(root.run("remove wood").code == 0);
    const auto archives = hostile_archives();
    CHECK(archives.size() >= 60);
    // Sanitized some, for a command for each takes long: libraries_test reads them all.
    for (size_t i = 0; i < archives.size(); i += is_sanitized ? 6 : 1) {
        const HostileArchive& archive = archives[i];
        root.write("evil.haptlib", archive.bytes);
        const auto before = root.state();
        const Ran ran = root.run("install evil.haptlib");
        INFO(archive.what << ": " << ran.err);
        CHECK(ran.code == 1);
        CHECK(contains(ran.err, "evil.haptlib"));
        CHECK(contains(ran.err, "error: "));
        CHECK(ran.out.empty());
        CHECK((root.state() == before));
    }
    const std::string homeless = "cd '" + root.work.string() + "' && env -u HOME -u XDG_DATA_HOME ";
    write_library(root, "wood/1.0.0", "wood", "1.0.0", "1"); // as where libraries are installed
    for (const char* const command : {"install sound.haptlib", "remove wood"}) {
        const auto before = root.state();
        const Ran ran = run_command(command, homeless);
        CHECK(ran.code == 1);
        CHECK(contains(ran.err, "there is no HOME"));
        CHECK((root.state() == before));
    }
    const Json json = root.json("install evil.haptlib");
    CHECK(json["folder"].is_null());
    REQUIRE(json["problems"].size() == 1);
    CHECK(contains(json["problems"][0], "evil.haptlib"));
    CHECK(contains(root.run("install none.haptlib").err, "none.haptlib: error: it does not exist"));
}

TEST_CASE("two major versions stand side by side, each for who needs it; a conflict is told")
{
    const LibraryRoot root;
    write_library(root, "wood1", "wood", "1.2.0", "1");
    write_library(root, "wood2", "wood", "2.0.0", "2");
    const auto needs = [&](const std::string& name, const std::string& least) {
        write_library(root, name, name, "1.0.0", "1", "[dependencies]\nwood = \"" + least + "\"\n");
        root.write(name + "/oak.haptel",
                   "import wood.oak as theirs;\n\n/// As wood has it.\ntexture board() { return theirs.board(); }\n");
    };
    needs("old", "1.1");
    needs("young", "2.0");
    needs("future", "2.1");
    Ran ran = root.run("install old");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "it needs wood 1.1.0 or one that can take its place, and none is installed"));
    CHECK(!fs::exists(root.libraries));
    for (const char* const library : {"wood1", "wood2", "old", "young"})
        CHECK(root.run(std::string("install ") + library).code == 0);
    CHECK(contains(root.run("install future").err, "there is 2.0.0 at most"));
    root.write("both.haptel", "import old.oak as old;\nimport young.oak as young;\nimport wood.oak as wood;\n"
                              "texture both() { return old.board() + 10.0 * young.board() + 100.0 * wood.board(); }\n");
    CHECK(height_of(root.run("eval both.haptel:both --at 0,0,0")) == "height_m 0.221");

    write_library(root, "wood1", "wood", "1.2.0", "3"); // other files of the same version
    const auto before = root.state();
    ran = root.run("install wood1");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "is there already, with other files"));
    CHECK(contains(ran.err, "haptel remove wood@1.2.0"));
    CHECK((root.state() == before));
    CHECK(root.json("install wood2")["was_there"] == true);

    ran = root.run("remove wood");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "name one of wood@2.0.0, wood@1.2.0"));
    CHECK(contains(root.run("remove wood@3.0.0").err, "there is wood@2.0.0, wood@1.2.0"));
    CHECK(contains(root.run("remove woood").err, "did you mean 'wood'?"));
    CHECK(root.run("remove wood@2").code == 2);
    CHECK(root.run("remove ../wood").code == 2);
    CHECK(root.json("remove wood@1.2.0")["problems"].empty());
    ran = root.run("check both.haptel");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "library 'old' needs wood 1.1.0 or one that can take its place, and there is 2.0.0 in "));
}

TEST_CASE("a project has libraries of its own, and a lock that holds it to them")
{
    const LibraryRoot root;
    write_library(root, "wood1", "wood", "1.0.0", "1");
    write_library(root, "wood2", "wood", "1.1.0", "2");
    root.write("project/textures/mine.haptel", "import wood.oak;\ntexture mine() { return board(); }\n");
    CHECK(root.run("install ../wood1 --project", "project").code == 0);
    CHECK(fs::exists(root.work / "project/haptel_libraries/wood/1.0.0/oak.haptel"));
    CHECK(contains(read_file(root.work / "project/haptel.lock"), "name = \"wood\"\nversion = \"1.0.0\"\nsha256 = \""));
    CHECK(root.run("install wood2").code == 0); // for the user
    const auto height = [&] { return height_of(root.run("eval project/textures/mine.haptel:mine --at 0,0,0")); };
    CHECK(height() == "height_m 0.001");
    CHECK(height_of(root.run("eval wood.oak:board --at 0,0,0")) == "height_m 0.002");
    CHECK(height_of(root.run("eval wood.oak:board --at 0,0,0", "project")) == "height_m 0.001");
    CHECK(contains(root.run("eval wood.oak --at 0,0,0").err, "no texture 'oak'")); // it has `board` alone
    CHECK(root.json("list", "project/textures")["libraries"].size() == 2);

    const Ran away = root.run("remove wood@1.0.0 --project", "project/textures"); // from within
    INFO(away.err);
    CHECK(away.code == 0);
    CHECK(!contains(read_file(root.work / "project/haptel.lock"), "wood"));
    CHECK(height() == "height_m 0.002");
    CHECK(root.run("install ../wood1 --project --user", "project").code == 2);

    root.write("project/haptel.lock", "what\n");
    const auto before = root.state();
    const Ran refused = root.run("install ../wood1 --project", "project");
    CHECK(refused.code == 1);
    CHECK(contains(refused.err, "haptel.lock:1:"));
    CHECK((root.state() == before));
}

TEST_CASE("an installed file that is edited is felt at once")
{
    const LibraryRoot root;
    write_library(root, "wood", "wood", "1.0.0", "1");
    CHECK(root.run("install wood").code == 0);
    root.write("mine.haptel", "import wood.oak;\ntexture mine() { return board(); }\n");
    const std::string object = "[[object]]\nshape = \"box\"\nsize_m = 0.05\ntexture = ";
    root.write("scene.toml", "[device]\nstroke = \"press\"\n" + object + "\"wood.oak:board\"\n" + object +
                                 "\"mine.haptel:mine\"\nposition_m = [1, 0, 0]\n");
    const std::string out = (root.work / "out").string(),
                      installed = (root.libraries / "wood/1.0.0/oak.haptel").string();
    const Ran ran =
        run_command("explore '" + (root.work / "scene.toml").string() + "' --seconds 3 --json --out '" + out + "'",
                    "(for i in $(seq 400); do [ -s '" + out +
                        "/trace.csv' ] && break; sleep 0.05; done; sleep 0.5; "
                        "echo '/// Flat.\ntexture board() { return 2mm; }' >'" +
                        installed + "') & env -u HAPTEL_PATH XDG_DATA_HOME='" + root.folder.file("data") + "'");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK(Json::parse(ran.out)["reloads"] == 2); // by its name in the scene, and by an import
}

TEST_CASE("pack writes a gallery that shows each texture, its name and its doc comment, and draws pictures of the size "
          "that is said")
{
    const LibraryRoot root;
    write_library(root, "wood", "wood", "1.0.0", "1", "[previews]\n\"oak:board\" = 0.012\n");
    fs::create_directories(root.work / "page/oak");
    root.write("page/oak/gone.png", "of a texture that is no more");
    Ran ran = root.run("pack wood -o wood.haptlib --gallery page.md");
    INFO(ran.err);
    CHECK(ran.code == 0);
    const std::string page = read_file(root.work / "page.md");
    CHECK(page.starts_with(
        "# wood\n\nFor tests.\n\nThese are the textures of version 1.0.0, under the licence CC0-1.0."));
    CHECK(contains(page, "### board\n\n![oak/board](page/oak/board.png)\n\n`wood.oak:board`, 12 mm wide\n\nFlat.\n"));
    CHECK(read_file(root.work / "page/oak/board.png").starts_with("\x89PNG"));
    CHECK_FALSE(fs::exists(root.work / "page/oak/gone.png"));
    root.write("wood/README.md", "# Wood of tests\n");
    CHECK(root.run("pack wood -o wood.haptlib --gallery page.md").code == 0);
    CHECK(read_file(root.work / "page.md").starts_with("# Wood of tests\n\nThese are the textures of version 1.0.0"));
    CHECK(root.run("pack wood -o wood.haptlib --gallery nowhere/page.md").code == 1);
}

TEST_CASE("test tries the tests of a library as pack does: they are flat where what they test holds")
{
    const LibraryRoot root;
    write_library(root, "wood", "wood", "1.0.0", "1");
    Ran ran = root.run("test wood");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "passed, is flat"));
    CHECK(contains(ran.out, "2 passed, 0 failed"));
    // Its gradient is that of its height, but a test has to be flat; and it steps, which a test may.
    root.write("wood/tests/oak.haptel",
               "import wood.oak as tested;\n\n/// It is 1 mm high.\ntexture board() { return p.x > 9mm ? 1um : "
               "tested.board() - 1mm; }\n");
    ran = root.run("test wood");
    CHECK(ran.code == 1);
    CHECK(contains(ran.out, "is not flat, as it is where what it tests holds: 1e-06 m"));
    root.write(
        "wood/tests/oak.haptel",
        "import wood.oak as tested;\n\n/// It steps where nothing is tried.\ntexture board() { return p.x > 1m ? 1um "
        ": tested.board() - 1mm; }\n");
    CHECK(root.run("test wood").code == 0);
}

TEST_CASE("info tells what a library says of itself: of its folder, its archive, and where it is installed")
{
    const LibraryRoot root;
    write_library(root, "wood", "wood", "1.2.0", "2.0");
    REQUIRE(root.run("pack wood").code == 0);
    REQUIRE(root.run("install wood-1.2.0.haptlib").code == 0);
    for (const char* what : {"./wood", "wood-1.2.0.haptlib"}) {
        CAPTURE(what);
        const Json said = root.json("info " + std::string(what));
        CHECK(said["name"] == "wood");
        CHECK(said["version"] == "1.2.0");
        CHECK(said["language"] == 1);
        REQUIRE(said["textures"].size() == 1);
        CHECK(said["textures"][0]["name"] == "oak:board");
        CHECK(said["textures"][0]["tagline"] != "");
    }
    CHECK(root.run("info wood", "wood/tests").out == root.run("info ./wood").out); // the installed one
    CHECK(contains(root.run("info ./wood").out, "wood 1.2.0"));
    CHECK(contains(root.run("info fbm").out, "fbm")); // functions keep their names
    const Ran absent = root.run("info none.haptlib");
    CHECK(absent.code == 1);
    CHECK(contains(absent.err, "none.haptlib"));
}
