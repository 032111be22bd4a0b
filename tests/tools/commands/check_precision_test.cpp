// haptel check --max-error: the choice follows from the figures beside it, and these from the 113-bit oracle.
#include "tests/support/catch.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <cmath>

using namespace haptel::test;
using haptel::tools::Json;

namespace {

const char* const fractal = "texture fractal(float depth = 50um in 0um .. 1mm, int octaves = 5 in 1 .. 8)\n"
                            "{ return depth * fbm(p / 10mm, octaves); }\n";

Json texture_of(const Ran& ran)
{
    INFO(ran.err);
    const Json json = Json::parse(ran.out);
    REQUIRE(json["textures"].size() == 1);
    return json["textures"][0];
}

// The name of the fastest row that is close enough; null if none is.
Json fastest(const Json& precision, const char* time)
{
    Json best = nullptr;
    double best_ns = HUGE_VAL;
    for (const Json& row : precision["measured"])
        if (row["gradient_error"].get<double>() <= precision["error_max"].get<double>() &&
            row[time].get<double>() < best_ns)
            best = row["precision"], best_ns = row[time].get<double>();
    return best;
}

} // namespace

TEST_CASE("check --max-error picks the fastest precision that is close enough on this texture over its box")
{
    const Folder folder;
    const std::string file = folder.write("fractal.haptel", fractal);
    for (const std::string wanted : {"1e-2", "1e-5", "1e-12"})
        for (const std::string box : {"50mm", "1000m"}) {
            if (is_sanitized && wanted != "1e-5") continue; // which takes long to measure
            const Ran ran = run_command("check '" + file + "' --max-error " + wanted + " --json --box " + box);
            CAPTURE(wanted, box, ran.err);
            const Json precision = texture_of(ran)["precision"];
            REQUIRE(precision["measured"].size() == 3);
            CHECK(precision["error_max"].get<double>() == std::stod(wanted));
            CHECK(precision["one_point"] == fastest(precision, "one_point_ns"));
            CHECK(precision["many_points"] == fastest(precision, "many_points_ns"));
            CHECK(ran.code == (precision["one_point"].is_null() ? 1 : 0));
            const auto error_of = [&](size_t i) { return precision["measured"][i]["gradient_error"].get<double>(); };
            CHECK(error_of(0) < error_of(1));
            CHECK(error_of(1) < 2e-6);
            // 1e5 wavelengths away f32 has no digits left for the place within the finest octave's
            CHECK((error_of(2) > 1e-3) == (box == "1000m"));
        }
}

TEST_CASE("check --max-error measures f64 as haptel test does")
{
    const Folder folder;
    const std::string file = folder.write("fractal.haptel", fractal);
    const Json precision =
        texture_of(run_command("check '" + file + "' --max-error 1e-3 --json --box 50mm"))["precision"];
    const double tested =
        texture_of(run_command("test '" + file + "' --json --box 50mm"))["gradient_error_oracle"].get<double>();
    const double measured = precision["measured"][0]["gradient_error"].get<double>();
    CAPTURE(tested, measured);
    CHECK(tested > 0);
    CHECK(std::fabs(measured - tested) <= 0x1p-52); // the truth as an f64
    CHECK(texture_of(run_command("check '" + file + "' --json"))["precision"].is_null());
}

TEST_CASE("check --max-error: values are those that --set gives, and where nothing is close enough that is a finding")
{
    const Folder folder;
    const std::string file = folder.write("fractal.haptel", fractal);
    const auto rms_of = [&](const std::string& octaves) {
        return texture_of(run_command("check '" + file + "' --max-error 1e-3 --json --set octaves=" +
                                      octaves))["precision"]["measured"][2]["gradient_error"]
            .get<double>();
    };
    CHECK(rms_of("8") > 3 * rms_of("1")); // each octave doubles what a coordinate's rounding does

    const Ran ran = run_command("check '" + file + "' --max-error 1e-18 --json");
    CHECK(ran.code == 1);
    const Json json = Json::parse(ran.out);
    REQUIRE(json["diagnostics"].size() == 1);
    CHECK(json["diagnostics"][0]["code"] == "not-close-enough");
    CHECK(contains(json["diagnostics"][0]["message"], "f64 is off by "));
    CHECK(!json["diagnostics"][0]["hint"].get<std::string>().empty());
    CHECK(json["textures"][0]["precision"]["one_point"].is_null());
    CHECK(contains(run_command("check '" + file + "' --max-error 1e-18").out, "precision  none for one point"));
    CHECK(contains(run_command("check --explain not-close-enough").out, "--max-error"));
    CHECK(run_command("check '" + file + "' --max-error 0").code == 2);
    const std::string broken = folder.write("broken.haptel", "texture t() { return x; }\n");
    CHECK(run_command("check '" + broken + "' --max-error 1e-3").code == 1);
}

TEST_CASE("check --max-error: what is no share is misuse, and said in words")
{
    const Folder folder;
    const std::string file = folder.write("t.haptel", "texture t() { return 1mm * noise(p / 3mm); }");
    for (const auto& [text, message] :
         std::vector<std::pair<std::string, std::string>>{{"0", "--max-error: expected a number above 0, found '0'"},
                                                          {"-1", "found '-1'"},
                                                          {"nan", "'nan' is not a number that can be computed with"},
                                                          {"inf", "'inf' is not a number"},
                                                          {"small", "expected a number, found 'small'"}}) {
        const Ran ran = run_command("check '" + file + "' --max-error=" + text);
        INFO(ran.err);
        CHECK(ran.code == 2);
        CHECK(contains(ran.err, message));
    }
    CHECK(run_command("check '" + file + "' --normal-turn 0").code == 0);
    CHECK(run_command("check '" + file + "' --normal-turn=-1").code == 2);
    CHECK(run_command("check '" + file + "' --normal-turn nan").code == 2);
}

TEST_CASE("check --max-error: where only f64 is close enough because of a hash of a sine, it is named")
{
    const Folder folder;
    const auto checked = [&](const std::string& hash, const std::string& options) {
        const std::string file =
            folder.write("cells.haptel", "float of_cell(float n)\n{\n    return " + hash +
                                             ";\n}\ntexture cells() { return 1mm * of_cell(floor(p.x / "
                                             "1mm)) * sinturn(p.x / 1mm); }\n");
        return run_command("check '" + file + "' --max-error 1e-5" + options);
    };
    const std::string sine = "fract(sin(n) * 43758.5453)";
    const Ran named = checked(sine, "");
    INFO(named.out << named.err);
    CHECK(named.code == 0);
    CHECK(contains(named.out, "precision  f64 for one point, f64 for many"));
    CHECK(contains(named.out, "rounding is amplified at " + folder.file("cells.haptel") + ":3:12: " + sine + "\n"));
    CHECK(contains(named.out, "hash() of the library is the same in all"));
    const auto json = [&](const std::string& hash) {
        return Json::parse(checked(hash, " --json").out)["textures"][0]["precision"];
    };
    CHECK(json(sine)["amplified_rounding"] == folder.file("cells.haptel") + ":3:12: " + sine);
    const Json mended = json("hash(int(n))");
    CHECK(mended["amplified_rounding"].is_null());
    CHECK(mended["many_points"] != "f64"); // which is what naming it is for
}
