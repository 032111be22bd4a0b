// haptel bench, its kinds that take long: the front end grows with the text and not faster, what we are measured
// against computes the same textures, and every axis of a scene is measured. Not for sanitized programs, which take
// minutes over it and whose times mean nothing.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>
#include <sstream>

using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("bench compile: rows by length, with machine, commit and flags")
{
    const Folder folder;
    const Ran ran = run_command("bench compile --quick --json --out '" + folder.file("figures") + "'");
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    for (const char* field : {"machine", "isa", "commit", "flags"}) CHECK(!json[field].get<std::string>().empty());
    REQUIRE(json["rows"].size() >= 1 + 10 + 5); // one line, the examples, texts of five lengths
    double first_ms = 0, cached_ms = 0;
    for (const Json& row : json["rows"]) {
        CHECK(row["front_end_ms"]["median"].get<double>() > 0);
        CHECK(row["front_end_ms"]["p99"].get<double>() >= row["front_end_ms"]["median"].get<double>());
        for (const char* times : {"warm_ms", "binding_ms"}) CHECK(row[times]["median"].get<double>() > 0);
        for (const char* time : {"first_ms", "primed_ms", "cached_ms"}) CHECK(row[time].get<double>() > 0);
        first_ms += row["first_ms"].get<double>();
        cached_ms += row["cached_ms"].get<double>();
    }
    CHECK(cached_ms < 0.7 * first_ms); // what it is all for, with room for a busy machine
    for (const Json& row : json["rows"])
        if (row["texture"] == "field 400") CHECK(row["lines"].get<int>() >= 370);
    // a ratio of times side by side: a front end that grew with the square would be at 16
    CHECK(json["growth"].get<double>() < 6);
    CHECK(json["growth_to_code"].get<double>() < 6);
    CHECK(Json::parse(read_file(folder.path / "figures/compile.json")) == json);
    const std::string csv = read_file(folder.path / "figures/compile.csv");
    CHECK(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')) == 1 + json["rows"].size());
    for (const Json& row : json["rows"])
        CHECK(contains(csv, fmt::format("\n{},{},{},", row["texture"].get<std::string>(), row["lines"].get<int>(),
                                        row["front_end_ms"]["median"].get<double>())));
    CHECK(contains(csv.substr(0, csv.find('\n')), ",cached_ms,commit,isa,cpu"));
    for (const Json& row : json["rows"]) CHECK(row["felt_ms"]["median"] >= row["binding_ms"]["median"]);
    CHECK(run_command("bench nothing").code == 2);
    CHECK(run_command("bench --quick --out /proc/none").code == 1);
}

TEST_CASE("bench compile: a file of one's own, edited over and over; one that does not compile says why")
{
    const Folder folder;
    folder.write("two.haptel", "texture other() { return 1um; }\n"
                               "texture mine(float depth = 1um in 0um .. 2um) { return depth * sin(p.x / 1mm); }\n");
    folder.write("wrong.haptel", "texture wrong() { return dept; }\n");
    folder.write("slow.haptel", "texture slow() { float h = 0.0; for (int i = 0; i < 1000000; ++i) h += sin(p.x * i); "
                                "return h * 1um; }\n");
    const Ran ran = run_command("bench compile --quick --json '" + folder.file("two.haptel") + "'");
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    REQUIRE(json["rows"].size() == 1);
    const Json& row = json["rows"][0];
    CHECK(row["texture"] == "two");
    CHECK(row["lines"] == 2);
    CHECK((row["felt_ms"]["median"] > 0 && row["first_ms"].is_null()));
    CHECK(!json.contains("growth"));
    for (const char* file : {"wrong.haptel", "slow.haptel", "none.haptel"}) {
        const Ran bad = run_command("bench compile --quick '" + folder.file(file) + "'");
        CAPTURE(bad.err);
        CHECK(bad.code == 1);
        CHECK(contains(bad.err, file[0] == 'w' ? "dept" : file[0] == 's' ? "per call" : "cannot read"));
    }
    CHECK(run_command("bench tick '" + folder.file("two.haptel") + "'").code == 2);
}

TEST_CASE("bench scale: every axis from its first row on, for every probe, and what a surface costs")
{
    const Folder folder;
    const Ran ran = run_command("bench scale --quick --json --out '" + folder.file("figures") + "'");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    std::map<std::string, Json> first; // of an axis and a probe, with and without friction
    std::map<std::string, size_t> seen;
    for (const Json& row : json["rows"]) {
        const std::string axis = row["axis"], key = axis + " " + row["probe"].get<std::string>();
        CAPTURE(key, row["triangles"].get<int>(), row["objects"].get<int>());
        ++seen[key];
        const Json& base = first.try_emplace(key + (row["friction"].get<bool>() ? "" : " none"), row).first->second;
        for (const char* figure : {"median", "p99"}) {
            const double growth = row["growth"][figure],
                         by = row["tick_ns"][figure].get<double>() / base["tick_ns"][figure].get<double>();
            CHECK(std::fabs(growth / by - 1) < 1e-9);
        }
        for (const char* figure : {"median", "p99", "p999"}) // the least of several runs
            CHECK(row["tick_ns"][figure].get<double>() <= row["once_ns"][figure].get<double>());
        // All touch one, but for those that lie in one place.
        const double touched = axis == "contacts" ? row["objects"].get<double>() : 1;
        CHECK(std::fabs(row["contacts"].get<double>() - touched) < 0.05);
        if (touched == 8) CHECK(row["growth"]["median"].get<double>() > 2);
    }
    CHECK(seen.size() == 10);
    for (const char* probe : {"point", "sphere", "stylus"}) {
        CHECK(seen[std::string("triangles ") + probe] == 6);
        CHECK(seen[std::string("objects ") + probe] == 4);
        CHECK(seen[std::string("contacts ") + probe] == 4);
    }
    // Balls of a twentieth of the object's radius and of its diameter, on 20 * 187^2 triangles.
    std::set<std::pair<long, bool>> large; // micrometres
    for (const Json& row : json["rows"]) {
        if (row["axis"] != "radius") continue;
        CHECK(row["triangles"] == 699'380);
        large.emplace(std::lround(1e6 * row["probe_radius_m"].get<double>()), row["friction"].get<bool>());
    }
    CHECK(large == std::set<std::pair<long, bool>>{{2500, false}, {2500, true}, {5000, false}, {5000, true}});
    REQUIRE(json["builds"].size() == 6);
    for (const Json& row : json["builds"]) {
        CHECK(row["build_ms"].get<double>() > 0);
        REQUIRE(row["bytes_per_triangle"].is_number());
        const double bytes = row["bytes_per_triangle"];
        CHECK((bytes > 150 && bytes < 1500)); // a face, its links and half a vertex take 150
    }
    CHECK(json["builds"].back()["triangles"] == 1'310'720);
    const std::string csv = read_file(folder.path / "figures/scale.csv");
    std::istringstream lines(csv);
    const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    std::string line;
    std::getline(lines, line);
    for (const auto commas = columns(line); std::getline(lines, line);) CHECK(columns(line) == commas);
    CHECK(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')) == 1 + json["rows"].size() + 6);
    CHECK(Json::parse(read_file(folder.path / "figures/scale.json")) == json);
}

TEST_CASE("bench accuracy: every way computes the same texture, each as closely as it can")
{
    const Folder folder;
    const Ran ran = run_command("bench accuracy --quick --json --out '" + folder.file("figures") + "'");
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    std::map<std::string, double> errors;
    std::map<std::string, int> frontier;
    std::map<std::string, std::set<std::string>> plain_levels; // of the instruction set, by texture
    for (const Json& row : json["rows"]) {
        const std::string texture = row["texture"], method = row["method"], precision = row["precision"];
        CHECK(row["time_ns"]["median"].get<double>() > 0);
        CHECK(row["errors"].size() == 3);
        errors[texture + " " + method + " " + precision] = row["gradient_error_max"].get<double>();
        if (method.starts_with("cpp_")) {
            plain_levels[texture].insert(row["level"]);
            CHECK(contains(row["flags"], "-O3"));
            CHECK(contains(row["flags"], "-ffp-contract="));
            CHECK((row["level"] == "default" || contains(row["flags"], "-march=" + row["level"].get<std::string>())));
        } else
            CHECK(row["level"] == json["isa"]);
        if (row["frontier"].get<bool>()) ++frontier[texture + " " + row["mode"].get<std::string>()];
        // at 1e6 wavelengths the place within a wavelength has 33 bits left in f64, and those of its multiples fewer
        if (precision != "f32" && !contains(method, "difference") && !contains(method, "sine"))
            CHECK(row["errors"][2]["gradient_error_max"].get<double>() < 1e-5);
    }
    for (const std::string texture : {"noise", "perlin", "fbm1", "fbm2", "fbm4", "fbm8", "gardner7"}) {
        CAPTURE(texture);
        // Ours has what this processor has; so has one of the plain ways.
        CHECK(plain_levels[texture].count("default") == 1);
        if (contains(json["isa"], "avx")) CHECK(plain_levels[texture].count("x86-64-v3") == 1);
        CHECK((frontier[texture + " point"] > 0 && frontier[texture + " batch"] > 0));
        for (const std::string method : {"haptel", "cpp_analytic", "cpp_dual"}) {
            CHECK(errors[texture + " " + method + " f64"] < 1e-12);
            CHECK(errors[texture + " " + method + " f32"] < 1e-3);
        }
        CHECK(errors[texture + " haptel mixed"] < 3e-6);
        CHECK(errors[texture + " haptel_difference f64"] < 1e-7);
        CHECK(errors[texture + " cpp_difference_4 f64"] < 0.1);
    }
    // Two degrees more buy some two digits, until rounding is what is left.
    for (int degree = 5; degree <= 11; degree += 2) {
        const auto error = [&](int of) { return errors["gardner7 cpp_sine_" + std::to_string(of) + " f64"]; };
        CAPTURE(degree, error(degree));
        CHECK(error(degree) < error(degree - 2) / 30);
    }
    CHECK(errors["gardner7 cpp_sine_15 f64"] < 1e-12);
    CHECK(Json::parse(read_file(folder.path / "figures/accuracy.json")) == json);
    CHECK(read_file(folder.path / "figures/accuracy.csv").starts_with("texture,mode,method,precision"));
    CHECK(std::filesystem::file_size(folder.path / "figures/accuracy.png") > 10'000);
    CHECK(std::filesystem::file_size(folder.path / "figures/accuracy_height.png") > 10'000);

    // The verdict, drawn from the rows once more.
    std::map<std::string, size_t> plain_ways;
    size_t all_ways = 0;
    for (const Json& way : json["alternatives"]) {
        const Json& rows = json["rows"];
        const auto is_same = [&](const Json& row, const char* field) { return row[field] == way[field]; };
        const auto error_of = [&](const Json& row) {
            for (const Json& error : row["errors"])
                if (error["wavelengths"] == way["wavelengths"]) return error["gradient_error_max"].get<double>();
            return HUGE_VAL;
        };
        const auto time_of = [](const Json& row) { return row["time_ns"]["median"].get<double>(); };
        const auto plain = std::find_if(rows.begin(), rows.end(), [&](const Json& row) {
            return is_same(row, "texture") && is_same(row, "mode") && is_same(row, "method") &&
                   is_same(row, "precision") && is_same(row, "level") && is_same(row, "step_wavelengths");
        });
        REQUIRE(plain != rows.end());
        const bool one_holds = std::any_of(rows.begin(), rows.end(), [&](const Json& row) {
            return row["method"] == "haptel" && is_same(row, "texture") && is_same(row, "mode") &&
                   time_of(row) <= 1.1 * time_of(*plain) && error_of(row) <= std::max(1.25 * error_of(*plain), 1e-14);
        });
        CHECK(one_holds != way["holds"].is_null());
        ++all_ways;
    }
    for (const Json& row : json["rows"])
        if (row["method"].get<std::string>().starts_with("cpp_")) plain_ways[row["texture"]] += 3;
    size_t expected = 0;
    for (const auto& [texture, count] : plain_ways) expected += count;
    CHECK((all_ways == expected && expected > 500));
    for (const Json& difference : json["differences"]) {
        CHECK(contains(difference["method"], "cpp_difference"));
        if (difference["precision"] == "f64") CHECK_FALSE(difference["ours"].is_null());
    }
}
