// haptel check: what it finds out about a texture. Costs, bounds, slopes, and where it is not smooth.
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/near.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <set>

using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("check: what each line costs adds up to the whole")
{
    const Folder folder;
    const std::string file = folder.write("cost.haptel", "float twice(float x)\n{\n    return sin(x) * sin(x);\n}\n"
                                                         "texture t(int n = 4 in 1 .. 10)\n{\n"
                                                         "    float h = 0.0;\n"
                                                         "    for (int i = 0; i < n; ++i)\n"
                                                         "        h += twice(p.x / 1mm * i);\n"
                                                         "    return 1um * (h + fbm(p / 1mm, 8));\n}\n");
    const Ran ran = run_command("check --cost --json '" + file + "'");
    REQUIRE(ran.code == 0);
    const Json texture = Json::parse(ran.out)["textures"][0];
    uint64_t sum = 0;
    std::map<int, uint64_t> lines;
    for (const Json& cost : texture["cost"]) {
        CHECK(cost["file"] == file); // the library counts for the call
        sum += cost["operations"].get<uint64_t>();
        lines[cost["line"].get<int>()] = cost["operations"].get<uint64_t>();
    }
    CHECK(sum == texture["operations_max"].get<uint64_t>());
    CHECK(lines[3] % 10 == 0); // ten times at most
    CHECK(lines[3] >= 30);
    CHECK(lines[10] > 1000);         // eight octaves
    CHECK(texture["call_s"] > 1e-9); // hundreds of operations take more than a few cycles
    CHECK(texture["call_s"] < 1e-3); // and no servo period
    const std::string text = run_command("check --cost '" + file + "'").out;
    CHECK(text.find("return 1um * (h + fbm") < text.find("return sin(x) * sin(x);"));
    CHECK(contains(text, " ns a call on this machine, measured"));
}

TEST_CASE("check: a constant that is not finite is found")
{
    const Folder folder;
    const std::string file = folder.write("never.haptel", "const float A = 1.0 / 0.0;\n"
                                                          "texture t() { return 1um * A; }\n");
    const Json found = Json::parse(run_command("check --json '" + file + "'").out)["diagnostics"];
    REQUIRE(found.size() == 1);
    CHECK(found[0]["code"] == "domain");
    CHECK(found[0]["line"] == 2);
    CHECK(contains(found[0]["message"], "not a finite number"));
}

TEST_CASE("check: a verdict that rests on declared facts says so")
{
    const Folder folder;
    const std::string file = folder.write("said.haptel", "/// @facts value 0 .. 1, slope 2, class C0\n"
                                                         "float saw(float x) { return abs(mod(x, 2.0) - 1.0); }\n"
                                                         "texture t() { return 1mm * saw(p.x / 1mm); }\n"
                                                         "texture u() { return 1mm * noise(p / 1mm); }\n");
    const Json textures = Json::parse(run_command("check --json '" + file + "'").out)["textures"];
    CHECK(textures[0]["continuity"] == "C0");
    CHECK(textures[0]["declared"] == Json::array({"saw"}));
    CHECK(textures[1]["declared"] == Json::array()); // what the library says is proven
    CHECK(contains(run_command("check '" + file + "'").out, "believes the facts of saw(); haptel test tries them"));
}

TEST_CASE("check: jumps, kinks and what may be undefined are found with their place")
{
    const Folder folder;
    const std::string file = folder.write("rough.haptel", "texture a() { return 1um * floor(p.x / 1mm); }\n"
                                                          "texture b() { return 0.1 * abs(p.x - 3mm); }\n"
                                                          "texture c() { return 1mm * 1mm / (p.x + 10mm); }\n"
                                                          "texture d() { return 1um * sqrt(p.x / 1mm); }\n"
                                                          "texture e() { return 0.1 * abs(p.x + 1m); }\n");
    const Ran ran = run_command("check --json '" + file + "'");
    CHECK(ran.code == 0);
    const Json found = Json::parse(ran.out)["diagnostics"];
    REQUIRE(found.size() == 4);
    const auto check = [&](size_t index, const std::string& code, int line, int column, int end) {
        CAPTURE(index);
        CHECK(found[index]["code"] == code);
        CHECK(found[index]["line"] == line);
        CHECK(found[index]["column"] == column);
        CHECK(found[index]["end_column"] == end);
    };
    check(0, "jump", 1, 28, 44);
    check(1, "kink", 2, 28, 42);
    check(2, "division", 3, 22, 46);
    check(3, "domain", 4, 28, 43);
    CHECK(contains(found[2]["message"], "-0.09 .. 0.11"));
    CHECK(run_command("check --strict '" + file + "'").code == 1);
}

TEST_CASE("check: a picture of 8 bits is noted where its steps may be felt")
{
    const Folder folder;
    const std::string file = folder.write(
        "deep.haptel", "texture deep(image dents, float depth = 1mm) { return depth * sample(dents, p.xy / 1m); }\n");
    const std::string picture = folder.write("dents.pgm", std::string("P5\n3 1\n255\n") + "\x10\x50\xff");
    const std::string set = "check --json --set 'dents=" + picture + "' ";
    const Ran ran = run_command(set + "'" + file + "'");
    CHECK(ran.code == 0);
    const Json findings = Json::parse(ran.out)["diagnostics"];
    REQUIRE(findings.size() == 1);
    CHECK(findings[0]["code"] == "coarse-picture");
    CHECK(findings[0]["severity"] == "note");
    CHECK(contains(findings[0]["message"], "has 256 levels, so heights go in steps of 3.9 um"));
    CHECK(contains(ran.err, "note: --set dents for deep: "));
    CHECK(run_command("check --strict --set 'dents=" + picture + "' '" + file + "'").code == 0); // no warning
    CHECK(Json::parse(run_command(set + "--set depth=0.1mm '" + file + "'").out)["diagnostics"].empty());
}

TEST_CASE("check: bounds without a picture are those of any, and say so; one end alone may be unbounded")
{
    const Folder folder;
    const std::string file =
        folder.write("pressed.haptel", "texture pressed(image dents) { return 1mm * sample(dents, uv); }\n"
                                       "texture up() { return 1mm * abs(uv.x); }\n");
    const Ran ran = run_command("check '" + file + "'");
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "height     unbounded (unbounded)\n"));
    CHECK(contains(ran.out, "picture    any, no file is set: --set dents=FILE\n"));
    CHECK(contains(ran.out, "height     0 .. unbounded (0 .. unbounded)\n"));
}

TEST_CASE(
    "check: what reads the normal is as steep as normals turn: those of a ball that fills the box, or --normal-turn")
{
    const Folder folder;
    const std::string file = folder.write("lean.haptel", "texture lean() { return 1um * n.z; }\n");
    const auto slope = [&](const std::string& options) {
        return Json::parse(run_command("check --json " + options + " '" + file + "'").out)["textures"][0];
    };
    CHECK(near(slope("--box 0.1m")["slope_max"], 1e-6 * 20));
    CHECK(near(slope("--box 0.1m --normal-turn 50")["slope_max"], 1e-6 * 50));
    CHECK(slope("--box 0.1m --normal-turn 50")["normal_turn_max_per_m"] == 50);
    CHECK(contains(run_command("check --box 0.1m '" + file + "'").out, "normals    turn at most 20 per metre"));
    CHECK(run_command("check --normal-turn -1 '" + file + "'").code == 2);
}

TEST_CASE("check: octaves that fade along a surface leave no jump, and a choice that does not fade is one")
{
    if (is_sanitized) return; // which takes long to measure
    const Folder folder;
    const std::string file = folder.write(
        "fades.haptel", "vec3 bent() { return p / 5mm * (1.0 + 0.1 * sinturn(p.x / 5mm)); }\n"
                        "texture one() { return 50um * fbm(noise, bent(), 4, 2.0, 0.5); }\n"
                        "texture two() { return 50um * hybrid(perlin, bent(), 4, 2.0, 0.5); }\n"
                        "texture cut() { return footprint_in(bent()) < 1.0 ? 50um * noise(p / 5mm) : 0.0; }\n");
    const Ran ran = run_command("check --json --footprint 3mm '" + file + "'");
    const Json textures = Json::parse(ran.out)["textures"];
    CHECK(textures[0]["continuity"] == "C1");
    CHECK(textures[1]["continuity"] == "C1");
    CHECK(textures[2]["continuity"] == "jump");
    CHECK(run_command("test --footprint 3mm '" + file + "'").code == 0); // nothing rougher than that is measured
}

TEST_CASE("check: material outputs are bounded like the height, and those that cannot be meant are told")
{
    const Folder folder;
    const std::string file = folder.write(
        "scales.haptel",
        "texture sound(float rise = 0.5 in 0.0 .. 1.0, out float stiffness_scale, out float friction_scale)\n"
        "{\n"
        "    stiffness_scale = 1.0 + 0.5 * sinturn(p.x / 1mm);\n"
        "    friction_scale = 1.0 + rise * smoothstep(0.0, 1.0, p.y / 1mm);\n"
        "    return 0.0;\n"
        "}\n"
        "texture pulls(out float stiffness_scale) { stiffness_scale = p.x / 1m; return 0.0; }\n"
        "texture bursts(out float friction_scale) { friction_scale = abs(1mm / p.x); return 0.0; }\n");
    const Ran ran = run_command("check --json --box 0.2m '" + file + "'");
    CHECK(ran.code == 0);
    const Json json = Json::parse(ran.out);
    const Json& sound = json["textures"][0]["output_bounds"];
    CHECK(near(sound["stiffness_scale"]["minimum"], 0.5));
    CHECK(near(sound["stiffness_scale"]["maximum"], 1.5));
    CHECK(near(sound["friction_scale"]["maximum"], 1.5));
    CHECK(near(sound["friction_scale"]["over_ranges"]["maximum"], 2));
    CHECK(near(json["textures"][1]["output_bounds"]["stiffness_scale"]["minimum"], -0.1));
    CHECK(json["textures"][2]["output_bounds"]["friction_scale"]["maximum"].is_null());
    std::vector<std::pair<int, std::string>> scales;
    for (const Json& finding : json["diagnostics"])
        if (finding["code"] == "scale") scales.emplace_back(finding["line"], finding["message"]);
    REQUIRE(scales.size() == 2);
    CHECK(scales[0] == std::pair(7, std::string("stiffness_scale of 'pulls' may be negative: it lies in -0.1 .. 0.1")));
    CHECK(scales[1].first == 8);
    CHECK(contains(scales[1].second, "friction_scale of 'bursts' may be not finite"));
    CHECK(contains(run_command("check '" + file + "'").out, "friction_scale 1 .. 1.5 (1 .. 2)\n"));
}

TEST_CASE("check: patterns that jump are told so with height and place, the others have a note at most")
{
    const std::string file = project_path("tests/lang/patterns.haptel"); // docs say which jump
    const Json report = Json::parse(run_command("check '" + file + "' --json").out);
    int jumps = 0, seams = 0;
    for (const Json& texture : report["textures"]) {
        const std::string name = texture["name"], doc = texture["doc"];
        const bool does_jump = doc.starts_with("Jumps");
        bool is_told = false;
        for (const Json& finding : report["diagnostics"]) {
            const std::string message = finding["message"];
            if (!contains(message, "'" + name + "'")) continue;
            is_told |= finding["code"] == "jump" && contains(message, " jumps by ") && contains(message, ") mm");
            seams += finding["code"] == "seam";
        }
        CAPTURE(name);
        CHECK(is_told == does_jump);
        CHECK((texture["continuity"] == "jump") == (does_jump || texture["no_jump_found"] == true));
        jumps += does_jump;
    }
    CHECK(jumps == 8);
    CHECK(seams == 3);
}

TEST_CASE("check: a jump is told where it is, as high as it is")
{
    const Folder folder;
    // At x = 3 mm alone, by 30 um beside a slope.
    const std::string file = folder.write(
        "t.haptel", "texture t() { return 0.01 * p.x + 30um * step(3mm, p.x) + 50um * sin(p.y / 10mm); }\n");
    const Json report = Json::parse(run_command("check '" + file + "' --box 50mm --json").out);
    const std::string message = report["diagnostics"][0]["message"];
    double height_um = 0, x_mm = 0;
    REQUIRE(std::sscanf(message.c_str(), "the height of 't' jumps by %lf um at (%lf,", &height_um, &x_mm) == 2);
    CHECK(std::abs(height_um - 30) < 0.01);
    CHECK(std::abs(x_mm - 3) < 1e-3);
}

TEST_CASE("check: a jump that was seen is told beside what may be not a number, and with the time of one that moves")
{
    const Folder folder;
    const std::string domain = folder.write(
        "domain.haptel", "texture t() { vec2 q = p.xy / 10mm; return 50um * mod(q.y * 7.0, sin(q.x)); }\n");
    const auto findings_of = [](const std::string& file) {
        const Json all = Json::parse(run_command("check --json '" + file + "'").out);
        return all["diagnostics"];
    };
    std::set<std::string> codes;
    const Json of_domain = findings_of(domain);
    for (const Json& said : of_domain) codes.insert(said["code"]);
    CHECK((codes.contains("jump") && codes.contains("domain")));

    const std::string moving =
        folder.write("moving.haptel", "texture t() { return 50um * floor(p.x / 10mm + 0.37 * time / 1s); }\n");
    double x = 0, y = 0, z = 0, time = 0;
    const Json of_moving = findings_of(moving);
    for (const Json& said : of_moving)
        if (said["code"] == "jump") {
            const auto message = said["message"].get<std::string>();
            CAPTURE(message);
            REQUIRE(std::sscanf(message.c_str() + message.find('('), "(%lf, %lf, %lf) mm at %lf s", &x, &y, &z,
                                &time) == 4);
        }
    REQUIRE(time != 0);
    const auto height = [&](double to_the_right_mm) {
        char place[160];
        std::snprintf(place, sizeof place, " --at '%.9gmm,%.9gmm,%.9gmm' --time %.9g", x + to_the_right_mm, y, z, time);
        return Json::parse(run_command("eval --json '" + moving + ":t'" + place).out)["height_m"].get<double>();
    };
    CHECK(std::fabs(height(0.05) - height(-0.05) - 50e-6) < 1e-12);
}
