// haptel info and haptel new: what they say agrees with the sources that it is about.
#include "lang/compile.h"
#include "stdlib/stdlib.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <cmath>
#include <set>
#include <sstream>

using namespace haptel;
using namespace haptel::test;
using tools::Json;

namespace {

size_t findings_of(const std::string& text)
{
    lang::CompileOptions options;
    for (const stdlib::LibraryFile& file : stdlib::library())
        options.library.push_back({std::string(file.name), std::string(file.text)});
    return lang::compile({"t.haptel", text}, options).diagnostics.all().size();
}

// Names of functions that a line right behind a doc comment declares, by the look of the text alone.
std::set<std::string> documented_names()
{
    std::set<std::string> names;
    for (const stdlib::LibraryFile& file : stdlib::library()) {
        std::istringstream lines{std::string(file.text)};
        bool documented = false;
        for (std::string line; std::getline(lines, line);) {
            const size_t paren = line.find('('), space = line.find(' ');
            const bool head =
                !line.empty() && line[0] >= 'a' && line[0] <= 'z' && space < paren && line.rfind("const", 0) != 0;
            if (documented && head) names.insert(line.substr(space + 1, paren - space - 1));
            const bool is_doc = line.rfind("///", 0) == 0;
            documented = (is_doc && line.rfind("/// @facts", 0) != 0) || (is_doc && documented);
        }
    }
    return names;
}

} // namespace

TEST_CASE("info: lists every documented function of the library and every built-in, each with a line")
{
    const Ran ran = run_command("info");
    REQUIRE(ran.code == 0);
    const std::set<std::string> names = documented_names();
    CHECK(names.count("perlin") == 1);
    for (const std::string& name : names) {
        CAPTURE(name);
        CHECK(contains(ran.out, "\n  " + name + " "));
    }
    for (const char* name : {"sin", "smoothstep", "transpose", "detach"})
        CHECK(contains(ran.out, "\n  " + std::string(name) + " "));
    CHECK(!contains(ran.out, "..\n")); // a sentence does not end within "0 .. 1"
    const Json all = Json::parse(run_command("info --json").out);
    size_t of_library = 0;
    for (const Json& entry : all["functions"]) of_library += entry["group"] != "built in";
    CHECK(of_library == names.size());
}

TEST_CASE("info: a function with its overloads, doc, facts and an example that compiles")
{
    const Json json = Json::parse(run_command("info perlin --json").out)["functions"][0];
    CHECK(json["group"] == "perlin");
    REQUIRE(json["overloads"].size() == 4);
    CHECK(json["overloads"][0]["signature"] == "float perlin(vec3 q, int seed)");
    CHECK(contains(json["overloads"][0]["doc"], "0 at every whole point"));
    CHECK(json["overloads"][0]["facts"]["class"] == "C2");
    CHECK(json["overloads"][0]["facts"]["slope"].get<double>() > 2.0);
    const Ran text = run_command("info perlin");
    CHECK(contains(text.out, "float perlin(vec3 q, int seed)\n    Smooth random heights"));
    CHECK(contains(text.out, "    facts: value "));
    const Ran built_in = run_command("info clamp");
    CHECK(contains(built_in.out, "int clamp(int, int, int)\n"));
    CHECK(contains(built_in.out, "Built into the language."));

    size_t examples = 0;
    const Json all = Json::parse(run_command("info --json").out);
    for (const Json& entry : all["functions"]) {
        if (entry["example"].is_null()) continue;
        ++examples;
        CAPTURE(entry["name"]);
        CHECK(contains(entry["example"], entry["name"]));
        if (is_sanitized && examples % 4 != 0) continue; // each is compiled with all of the library
        CHECK(findings_of(entry["example"]) == 0);
    }
    CHECK(examples > 15);
}

TEST_CASE("info: an unknown name is misuse, with the one that was meant")
{
    const Ran ran = run_command("info perlim");
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK(contains(ran.err, "did you mean 'perlin'?"));
    CHECK(run_command("info $'\\xff'").code == 2);
}

TEST_CASE("info: the textures of a file, values as written and as numbers")
{
    const Folder folder;
    const std::string file = folder.write(
        "a.haptel",
        "/// Soft.\ntexture soft(\n    /// How high.\n    float depth = 60um in 0um .. 200um,\n"
        "    out float friction_scale)\n{\n    friction_scale = 2.0;\n    return depth * sinturn(time / 1s) * n.z;\n}\n"
        "texture flat()\n{\n    return 1mm;\n}\n");
    const Ran text = run_command("info '" + file + "'");
    CHECK(text.code == 0);
    CHECK(text.out == "texture soft\n  Soft.\n  float depth = 60um in 0um .. 200um  // How high.\n  reads n, time\n  "
                      "writes friction_scale\n"
                      "\ntexture flat\n  reads nothing\n");
    const Json json = Json::parse(run_command("info '" + file + ":soft' --json").out);
    REQUIRE(json["textures"].size() == 1);
    CHECK(json["textures"][0]["parameters"][0]["default"] == 60e-6);
    CHECK(json["textures"][0]["parameters"][0]["unit"] == "m");
    CHECK(json["textures"][0]["inputs"] == Json::array({"n", "time"}));
    const Ran wrong = run_command("info '" + file + ":flet'");
    CHECK(wrong.code == 1);
    CHECK(contains(wrong.err, "did you mean 'flat'?"));
    const Ran none = run_command("info '" + folder.file("none.haptel") + "'");
    CHECK(none.code == 1);
    CHECK(contains(run_command("info '" + folder.write("b.haptel", "texture t() { return 1mm }") + "'").err,
                   "b.haptel:1:"));
}

TEST_CASE("info --json: the manifest of a file, version 1, is what docs/control.md promises, field by field")
{
    const Folder folder;
    const std::string file = folder.write(
        "a.haptel", "/// Grooves.\ntexture grooves(\n    /// Apart.\n    float pitch = 2mm in 1mm .. 5mm,\n"
                    "    int octaves = 4 in 1 .. 8, uint seed = 3u in 0 .. 9,\n    bool worn = true,\n"
                    "    int kind = soft in {soft, sharp},\n    vec2 size = vec2(1cm, 2cm),\n"
                    "    image relief, out float friction_scale)\n"
                    "{\n    friction_scale = worn ? 2.0 : 1.0;\n    float h = kind == sharp ? size.x : size.y;\n"
                    "    return 0.01 * h * fbm(p / pitch, octaves + int(seed)) + 1um * sample(relief, uv);\n}\n"
                    "/// Fine.\ntexture fine = grooves(pitch = 1mm);\ntexture finest = fine(octaves = 8);\n");
    const Ran ran = run_command("info '" + file + ":grooves' --json");
    REQUIRE(ran.code == 0);
    Json written = Json::parse(R"({
        "schema": "haptel-textures", "version": 1,
        "textures": [{
            "file": "FILE", "name": "grooves", "doc": "Grooves.",
            "parameters": [
                {"name": "pitch", "type": "float", "default": 0.002, "minimum": 0.001, "maximum": 0.005,
                 "choices": [], "unit": "m", "doc": "Apart."},
                {"name": "octaves", "type": "int", "default": 4, "minimum": 1, "maximum": 8,
                 "choices": [], "unit": "", "doc": ""},
                {"name": "seed", "type": "uint", "default": 3, "minimum": 0, "maximum": 9,
                 "choices": [], "unit": "", "doc": ""},
                {"name": "worn", "type": "bool", "default": true, "minimum": null, "maximum": null,
                 "choices": [], "unit": "", "doc": ""},
                {"name": "kind", "type": "int", "default": 0, "minimum": 0, "maximum": 1,
                 "choices": ["soft", "sharp"], "unit": "", "doc": ""},
                {"name": "size.x", "type": "float", "default": 0.01, "minimum": null, "maximum": null,
                 "choices": [], "unit": "m", "doc": ""},
                {"name": "size.y", "type": "float", "default": 0.02, "minimum": null, "maximum": null,
                 "choices": [], "unit": "m", "doc": ""},
                {"name": "relief", "type": "image", "default": null, "minimum": null, "maximum": null,
                 "choices": [], "unit": "", "doc": ""}],
            "inputs": ["p", "uv", "footprint"], "outputs": ["friction_scale"],
            "preset_of": null, "presets": ["fine", "finest"]}]})");
    written["textures"][0]["file"] = file;
    CHECK(Json::parse(ran.out).dump(1) == written.dump(1));
    const Json presets = Json::parse(run_command("info '" + file + "' --json").out)["textures"];
    REQUIRE(presets.size() == 3);
    CHECK(presets[1]["preset_of"] == "grooves");
    CHECK(presets[1]["presets"] == Json::array({"finest"}));
    CHECK(presets[1]["parameters"][0]["default"] == 0.001);
    CHECK(presets[2]["preset_of"] == "fine");
    CHECK(presets[2]["presets"].empty());
}

TEST_CASE("info: a doc comment is shown whole, with ranges, dots and further lines")
{
    const Folder folder;
    const std::string doc = "Ripples of 1mm .. 5mm, or ..more, at 0.5.. 2 Hz. Another sentence... (a..b).";
    const std::string file = folder.write("a.haptel", "/// " + doc +
                                                          "\n/// From 0 .. 1.\ntexture a(\n    /// 0um .. 200um.\n"
                                                          "    /// Not more.\n    float d = 60um in 0um .. 200um)\n"
                                                          "{\n    return d;\n}\n");
    CHECK(run_command("info '" + file + "'").out == "texture a\n  " + doc +
                                                        "\n  From 0 .. 1.\n  float d = 60um in 0um .. 200um  "
                                                        "// 0um .. 200um.\n    // Not more.\n  reads nothing\n");
    const Json json = Json::parse(run_command("info '" + file + "' --json").out);
    CHECK(json["textures"][0]["doc"] == doc + "\nFrom 0 .. 1.");
}

TEST_CASE("info: choices and vectors, as written and by components")
{
    const Folder folder;
    const std::string file = folder.write(
        "w.haptel",
        "texture wall(int bond = stack in {running, stack}, vec2 size = vec2(2cm, 1cm) in 1cm .. 5cm) { return "
        "bond == stack ? 0.1 * size.x : 0.1 * size.y; }\n");
    CHECK(run_command("info '" + file + "'").out ==
          "texture wall\n  int bond = stack in {running, stack}\n  vec2 size = vec2(2cm, 1cm) in 1cm .. 5cm\n  reads "
          "nothing\n");
    const Json parameters = Json::parse(run_command("info '" + file + "' --json").out)["textures"][0]["parameters"];
    REQUIRE(parameters.size() == 3);
    CHECK(parameters[0]["choices"] == Json::array({"running", "stack"}));
    CHECK(parameters[0]["default"] == 1);
    CHECK(parameters[0]["maximum"] == 1);
    CHECK(parameters[1]["name"] == "size.x");
    CHECK(parameters[2]["name"] == "size.y");
    CHECK(parameters[2]["default"] == 0.01);
    CHECK(parameters[2]["maximum"] == 0.05);
    CHECK(parameters[2]["choices"].empty());
    // Of one tenth of a side: 3 cm is 3 mm high.
    const std::string eval = "eval '" + file + ":wall' --at 0,0,0 --json ";
    CHECK(Json::parse(run_command(eval + "--set size=3cm,4cm").out)["height_m"] == 0.1 * 0.03);
    CHECK(Json::parse(run_command(eval + "--set size=3cm,4cm --set bond=running").out)["height_m"] == 0.1 * 0.04);
    CHECK(Json::parse(run_command(eval + "--set size.x=3cm").out)["height_m"] == 0.1 * 0.03);
    const Ran wrong = run_command(eval + "--set bond=runing");
    CHECK(wrong.code == 1);
    CHECK(contains(wrong.err, "expected running or stack, found 'runing'"));
    CHECK(contains(wrong.err, "did you mean 'running'?"));
    const Json checked =
        Json::parse(run_command("check --json --set size=3cm,4cm --set bond=running '" + file + "'").out);
    CHECK(checked["diagnostics"].empty());
    CHECK(std::abs(checked["textures"][0]["height_m"]["maximum"].get<double>() - 0.004) <= 1e-15);
    CHECK(std::abs(checked["textures"][0]["over_ranges"]["height_m"]["maximum"].get<double>() - 0.005) <= 1e-15);
    CHECK(std::abs(checked["textures"][0]["over_ranges"]["height_m"]["minimum"].get<double>() - 0.001) <= 1e-15);
    CHECK(run_command("check --set bond=rock --set size=1cm '" + file + "'").code == 1);
}

TEST_CASE("info: docs/stdlib.md is what --markdown prints (./dev docs makes it anew), and its pictures are there")
{
    const std::filesystem::path docs = project_path("docs");
    const std::string page = run_command("info --markdown").out;
    CHECK(page == read_file(docs / "stdlib.md"));
    size_t pictures = 0;
    for (size_t at = 0; (at = page.find("](pictures/", at)) != std::string::npos; ++at, ++pictures) {
        const std::string path = page.substr(at + 2, page.find(')', at) - at - 2);
        CAPTURE(path);
        CHECK(std::filesystem::exists(docs / path));
    }
    CHECK(pictures > 15);
}

TEST_CASE("new: a texture in which nothing is found, in the one style, never over a file that exists")
{
    const Folder folder;
    const Ran ran = run_command("new oak --out '" + folder.file("a/b") + "'");
    CHECK(ran.code == 0);
    const std::string file = folder.file("a/b/oak.haptel");
    CHECK(ran.out == file + "\n");
    CHECK(findings_of(read_file(file)) == 0);
    CHECK(run_command("check --strict '" + file + "'").code == 0);
    CHECK(run_command("fmt --check '" + file + "'").code == 0);
    CHECK(contains(run_command("info '" + file + "'").out, "texture oak\n"));

    folder.write("a/b/oak.haptel", "mine");
    const Ran again = run_command("new oak --out '" + folder.file("a/b") + "'");
    CHECK(again.code == 1);
    CHECK(contains(again.err, "exists already"));
    CHECK(read_file(file) == "mine");
    CHECK(run_command("new 2oak --out '" + folder.file("a") + "'").code == 2);
    CHECK(run_command("new for --out '" + folder.file("a") + "'").code == 2);
    CHECK(run_command("new ../oak --out '" + folder.file("a") + "'").code == 2);
}
