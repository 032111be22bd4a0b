// haptel check: the promise to scripts (fields, exit codes) and the help to people.
#include "tests/support/catch.h"
#include "tests/tools/commands/near.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <sys/stat.h>

using namespace haptel::test;
using haptel::tools::Json;

namespace {

const std::string waves = "/// Waves.\n"
                          "texture waves(\n"
                          "    /// Crest to crest.\n"
                          "    float pitch = 2mm in 1mm .. 5mm,\n"
                          "    float depth = 40um in 0um .. 100um,\n"
                          "    int n = 3 in 1 .. 8,\n"
                          "    bool on = true)\n"
                          "{\n"
                          "    return on ? depth * sin(p.x / pitch * n) : 0.0;\n"
                          "}\n";

} // namespace

TEST_CASE("check: a sound file is exit code 0, its textures are described")
{
    const Folder folder;
    const std::string file = folder.write("waves.haptel", waves);
    const Ran ran = run_command("check --json '" + file + "'");
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    const Json json = Json::parse(ran.out);
    CHECK(json["diagnostics"].empty());
    REQUIRE(json["textures"].size() == 1);
    const Json& texture = json["textures"][0];
    CHECK(texture["file"] == file);
    CHECK(texture["name"] == "waves");
    CHECK(texture["doc"] == "Waves.");
    CHECK(texture["inputs"] == Json::array({"p"}));
    REQUIRE(texture["parameters"].size() == 4);
    const Json pitch = {{"name", "pitch"},  {"type", "float"},          {"default", 0.002}, {"minimum", 0.001},
                        {"maximum", 0.005}, {"choices", Json::array()}, {"unit", "m"},      {"doc", "Crest to crest."}};
    CHECK(texture["parameters"][0] == pitch);
    CHECK(texture["parameters"][2]["type"] == "int");
    CHECK(texture["parameters"][2]["default"].is_number_integer());
    CHECK(texture["parameters"][3]["default"] == true);
    CHECK(texture["parameters"][3]["minimum"].is_null());
    // |sine| <= 1: the bound is the depth, but for rounding outward
    CHECK(near(texture["height_m"]["minimum"], -40e-6));
    CHECK(near(texture["height_m"]["maximum"], 40e-6));
    CHECK(near(texture["over_ranges"]["height_m"]["minimum"], -100e-6));
    CHECK(near(texture["over_ranges"]["height_m"]["maximum"], 100e-6));
    CHECK(texture["operations_max"].get<int>() > 0);
    // of depth * sin(n x / pitch)
    CHECK(near(texture["slope_max"], 40e-6 * 3 / 0.002));
    CHECK(near(texture["curvature_max_per_m"], 40e-6 * (3 / 0.002) * (3 / 0.002)));
    CHECK(texture["continuity"] == "C1");
    CHECK(near(texture["over_ranges"]["slope_max"], 100e-6 * 8 / 0.001));
    CHECK(near(texture["over_ranges"]["curvature_max_per_m"], 100e-6 * (8 / 0.001) * (8 / 0.001)));
    // promised and not built: null, never absent
    REQUIRE(texture.contains("stability"));
    CHECK(texture["stability"].is_null());
}

TEST_CASE("check: parameters are set by name and in their units")
{
    const Folder folder;
    const std::string file = folder.write("waves.haptel", waves);
    const Ran ran = run_command("check --json --set depth=10um '" + file + "'");
    CHECK(ran.code == 0);
    CHECK(near(Json::parse(ran.out)["textures"][0]["height_m"]["maximum"], 10e-6));

    const Ran unknown = run_command("check --json --set depht=10um '" + file + "'");
    CHECK(unknown.code == 1);
    const Json finding = Json::parse(unknown.out)["diagnostics"][0];
    CHECK(finding["code"] == "unknown-parameter");
    CHECK(finding["hint"] == "did you mean 'depth'?");
    CHECK(finding["line"] == 1);
    CHECK(finding["column"] == 1);

    CHECK(run_command("check --set n=9 '" + file + "'").code == 1);
    CHECK(run_command("check --set n '" + file + "'").code == 2);
}

TEST_CASE("check: findings have places by code points, and errors are exit code 1")
{
    const Folder folder;
    const std::string file =
        folder.write("bad.haptel", "// \xC3\xA9t\xC3\xA9\n/* \xC3\xA9 */ texture bad() { return p; }\n");
    const Ran ran = run_command("check --json '" + file + "'");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "type-mismatch"));
    const Json json = Json::parse(ran.out);
    CHECK(json["textures"].empty());
    REQUIRE(json["diagnostics"].size() == 1);
    const Json expected = {{"severity", "error"},
                           {"code", "type-mismatch"},
                           {"message", "expected float from 'bad', found vec3"},
                           {"file", file},
                           {"line", 2},
                           {"column", 32},
                           {"end_line", 2},
                           {"end_column", 33},
                           {"hint", "pick a component, p.x, or take length(p)"}};
    CHECK(json["diagnostics"][0] == expected);
}

TEST_CASE("check: warnings change the exit code only with --strict")
{
    const Folder folder;
    const std::string file = folder.write("warn.haptel", "texture warn(float unused = 1.0) { return 0.0; }\n");
    CHECK(run_command("check '" + file + "'").code == 0);
    CHECK(run_command("check --strict '" + file + "'").code == 1);
    const std::string good = folder.write("good.haptel", "texture good() { return 0.0; }\n");
    CHECK(run_command("check --strict '" + good + "'").code == 0);
}

TEST_CASE("check: several files, what they import is said once")
{
    const Folder folder;
    folder.write("shared.haptel", "float shared(float x) { return y; }\n");
    const std::string a = folder.write("a.haptel", "import \"shared.haptel\";\ntexture a() { return shared(p.x); }\n");
    const std::string b = folder.write("b.haptel", "import \"shared.haptel\";\ntexture b() { return shared(p.x); }\n");
    const Ran ran = run_command("check --json '" + a + "' '" + b + "'");
    CHECK(ran.code == 1);
    const Json json = Json::parse(ran.out);
    size_t errors = 0;
    for (const Json& finding : json["diagnostics"]) errors += finding["severity"] == "error";
    CHECK(errors == 1);
}

TEST_CASE("check: a folder stands for the texture files in it, at any depth")
{
    const Folder folder;
    for (const char* name : {"deep", "empty"}) std::filesystem::create_directory(folder.file(name));
    folder.write("fine.haptel", "texture fine() { return 0.0; }\n");
    folder.write("deep/functions.haptel", "float lost(float x) { return x + y; }\n");
    folder.write("deep/notes.txt", "no texture\n");
    const Ran ran = run_command("check --json '" + folder.path.string() + "'");
    CHECK(ran.code == 1);
    const Json json = Json::parse(ran.out);
    CHECK(json["textures"].size() == 1);
    REQUIRE(json["diagnostics"].size() == 1);
    CHECK(json["diagnostics"][0]["file"] == folder.file("deep/functions.haptel"));
    const Ran empty = run_command("check '" + folder.file("empty") + "'");
    CHECK(empty.code == 1);
    CHECK(contains(empty.err, "it is a folder"));
}

TEST_CASE("check: what cannot be read is a finding at 1:1, and JSON stays JSON")
{
    const Folder folder;
    const std::string binary = folder.write("binary.haptel", std::string("\xff\xfe\x00\x80garbage", 11));
    const std::string empty = folder.write("empty.haptel", "");
    const Ran ran =
        run_command("check --json '" + folder.file("nowhere.haptel") + "' '" + binary + "' '" + empty + "'");
    CHECK(ran.code == 1);
    const Json json = Json::parse(ran.out);
    REQUIRE(json["diagnostics"].size() == 3);
    CHECK(json["diagnostics"][0]["code"] == "unreadable-file");
    CHECK(json["diagnostics"][0]["line"] == 1);
    CHECK(json["diagnostics"][0]["column"] == 1);
    CHECK(json["diagnostics"][1]["code"] == "not-text");
    CHECK(json["diagnostics"][2]["code"] == "empty-file");
    CHECK(json["diagnostics"][2]["severity"] == "warning");
    CHECK(run_command("check '" + empty + "'").code == 0);
    CHECK(run_command("check").code == 2);
    const Ran scene = run_command("check ball.toml");
    CHECK(scene.code == 2);
    CHECK(contains(scene.err, "ball.toml is a scene: haptel explore feels it"));
    CHECK(run_command("check --box -1mm '" + empty + "'").code == 2);
}

TEST_CASE("check: a file that is not there is told with where it was looked for, and what is there")
{
    const Folder folder;
    const auto hint = [&](const std::string& file) {
        const std::string said = run_command("check '" + folder.file(file) + "'").err;
        const std::size_t at = said.find("hint: ");
        return at == std::string::npos ? "" : said.substr(at + 6, said.find('\n', at) - at - 6);
    };
    const std::string here = "'" + folder.path.string() + "'";
    CHECK(hint("granite.haptel") == "it was looked for in " + here + ", which holds no texture file (*.haptel)");
    CHECK(hint("no/granite.haptel") == "there is no folder '" + folder.file("no") + "'");
    for (const char* name : {"wood", "brick", "note.txt"}) folder.write(std::string(name) + ".haptel", waves);
    CHECK(hint("granite.haptel") ==
          "it was looked for in " + here + ", which holds brick.haptel, note.txt.haptel, wood.haptel");
    for (const char* name : {"zinc", "cork", "leather"}) folder.write(std::string(name) + ".haptel", waves);
    CHECK(hint("granite.haptel") == "it was looked for in " + here +
                                        ", which holds brick.haptel, cork.haptel, leather.haptel, note.txt.haptel, "
                                        "wood.haptel, ...");
    CHECK(hint("bric.haptel") == "did you mean 'brick.haptel'?");
}

TEST_CASE("check: --fix writes exact synonyms and near names, until nothing is left to write")
{
    const Folder folder;
    const std::string file = folder.write("fix.haptel", "float f(float widht) { return widht; }\n"
                                                        "texture fix(int n = 3 in 1 .. 8)\n"
                                                        "{\n"
                                                        "    int i = 2 * n;\n"
                                                        "    return lerp(f(1.0), f(witdh()), 0.5) * i;\n"
                                                        "}\n"
                                                        "float width() { return 1.0; }\n");
    const Ran ran = run_command("check --fix '" + file + "'");
    CHECK(ran.code == 0);
    CHECK(contains(ran.err, "2 fixed"));
    CHECK(read_file(file) == "float f(float widht) { return widht; }\n"
                             "texture fix(int n = 3 in 1 .. 8)\n"
                             "{\n"
                             "    int i = 2 * n;\n"
                             "    return mix(f(1.0), f(width()), 0.5) * i;\n"
                             "}\n"
                             "float width() { return 1.0; }\n");
}

TEST_CASE("check: --strict makes warnings errors, in the exit code and in JSON")
{
    const Folder folder;
    const std::string file = folder.write("t.haptel", "texture t() { return 1mm * sin(p.x); }\n");
    const Ran lenient = run_command("check --json '" + file + "'"),
              strict = run_command("check --strict --json '" + file + "'");
    CHECK(lenient.code == 0);
    CHECK(strict.code == 1);
    Json expected = {{"severity", "warning"},
                     {"code", "dimension"},
                     {"message", "sin() expects a plain number, got a length: divide by a wavelength"},
                     {"file", file},
                     {"line", 1},
                     {"column", 32},
                     {"end_line", 1},
                     {"end_column", 35},
                     {"hint", "write p.x / 1m, with the quantity you mean instead of 1m"}};
    CHECK(Json::parse(lenient.out)["diagnostics"] == Json::array({expected}));
    CHECK(Json::parse(lenient.out)["textures"].size() == 1);
    expected["severity"] = "error";
    CHECK(Json::parse(strict.out)["diagnostics"] == Json::array({expected}));
    CHECK(Json::parse(strict.out)["textures"] == Json::parse(lenient.out)["textures"]);
}

TEST_CASE("check: --explain tells what a code means, lists all, and knows a slip of the pen")
{
    const Ran one = run_command("check --explain unbounded-loop");
    CHECK(one.code == 0);
    CHECK(contains(one.out, "unbounded-loop (error): a loop that is not known to end\n"));
    CHECK(contains(one.out, "\nWrong:\n    texture t(int n = 3) { float h = 0.0; for (int i = 0; i < n; ++i)"));
    CHECK(contains(one.out, "\nRight:\n    texture t(int n = 3 in 1 .. 8)"));
    const Ran all = run_command("check --explain"), data = run_command("check --json --explain");
    CHECK(all.code == 0);
    CHECK(contains(all.out, "\ndimension                warning  lengths, times"));
    const Json codes = Json::parse(data.out)["codes"];
    CHECK(codes.size() == static_cast<size_t>(std::count(all.out.begin(), all.out.end(), '\n')));
    CHECK(codes[0]["code"] == "not-text");
    const Ran slip = run_command("check --explain dimenson");
    CHECK(slip.code == 2);
    CHECK(contains(slip.err, "did you mean 'dimension'?"));
    CHECK(run_command("check --explain dimension --json").out == run_command("check --json --explain dimension").out);
}

TEST_CASE("check: --fix leaves a file that it cannot write as it is, and says so")
{
    const Folder folder;
    const std::string file = folder.write("t.haptel", "texture t(float depth = 1mm) { return dpeth; }\n");
    const std::string before = read_file(file);
    std::filesystem::permissions(file, std::filesystem::perms::owner_read);
    if (std::ofstream(file, std::ios::app)) return; // this user may write anything
    const Ran ran = run_command("check --fix --json '" + file + "'");
    CHECK(ran.code == 1);
    CHECK(Json::parse(ran.out)["diagnostics"][0]["code"] == "unwritable-file");
    CHECK(read_file(file) == before);
}

TEST_CASE("check: a few lines per texture for people")
{
    const Folder folder;
    const std::string file = folder.write("waves.haptel", waves + "texture free() { return p.x / time; }\n");
    const Ran ran = run_command("check '" + file + "'");
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, file + ":waves in a cube of 200 mm"));
    CHECK(contains(ran.out, "height     -40 um .. 40 um (-100 um .. 100 um)\n"));
    CHECK(contains(ran.out, "slope      at most 0.06 (0.8)\n"));
    CHECK(contains(ran.out, "curvature  at most 90 /m (6.4e+03 /m)\n"));
    CHECK(contains(ran.out, "reads p\n"));
    CHECK(contains(ran.out, "height     unbounded (unbounded)\n"));
    CHECK(contains(ran.out, "slope      unbounded (unbounded)\n"));
    CHECK(contains(ran.out, "reads p, time\n"));
}

TEST_CASE("check: a height that is proven too wide is told as it is felt")
{
    const Folder folder;
    const std::string file = folder.write("folded.haptel", R"(texture folded()
{
    vec3 q = p / 2mm;
    return 40um / (1.0 + q.x * q.x - 2.0 * q.x * sin(q.y) + sin(q.y) * sin(q.y));
}
texture plain() { return 50um * sin(p.x / 1mm); }
)");
    // 40 um / (1 + (x - sin y)^2) lies in 0 .. 40 um.
    const Ran ran = run_command("check '" + file + "' --json");
    CHECK(ran.code == 0);
    const Json textures = Json::parse(ran.out)["textures"];
    const Json &folded = textures[0], &plain = textures[1];
    CHECK(folded["height_m"]["maximum"] > 80e-6);
    CHECK(folded["height_found_m"]["maximum"] > 39e-6);
    CHECK(folded["height_found_m"]["maximum"] < 40.1e-6);
    CHECK(folded["height_felt_m"]["maximum"] > 40e-6);
    CHECK(folded["height_felt_m"]["maximum"] < 60e-6);
    CHECK(plain["height_felt_m"] == plain["height_m"]);
    const Ran text = run_command("check '" + file + "'");
    CHECK(contains(text.out, "and what lies beyond is bent to stay within\n"));
    CHECK(text.out.find("bent") == text.out.rfind("bent")); // of folded alone
}

TEST_CASE("check: an import that is no file says what it is, or which file was meant")
{
    const Folder folder;
    REQUIRE(mkfifo(folder.file("pipe.haptel").c_str(), 0600) == 0);
    folder.write("oak.haptel", "float f(float x) { return x; }\n");
    const std::string file =
        folder.write("t.haptel", "import \"pipe.haptel\";\nimport \"oka.haptel\";\ntexture t() { return 0.0; }\n");
    const Ran ran = run_command("check '" + file + "'", "timeout 20");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err + ran.out, "1:1: error: cannot read \"pipe.haptel\": it is a pipe, not a regular file"));
    CHECK(contains(ran.err + ran.out, "2:1: error: cannot read \"oka.haptel\": it does not exist"));
    CHECK(contains(ran.err + ran.out, "did you mean 'oak.haptel'?"));
}
