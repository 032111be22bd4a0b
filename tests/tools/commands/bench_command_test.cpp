// haptel bench: what scripts rely on, that the front end grows with the text and not faster, and that what we are
// measured against computes the same textures.
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
#include <thread>

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
    CHECK(run_command("bench nothing").code == 2);
    CHECK(run_command("bench --quick --out /proc/none").code == 1);
}

TEST_CASE("bench --help: its first line, which haptel --help has too, names every kind there is")
{
    const std::string help = run_command("bench --help").out, first = help.substr(0, help.find('\n'));
    CHECK(contains(run_command("--help").out, first));
    std::string kinds = help.substr(help.find('{') + 1);
    kinds = kinds.substr(0, kinds.find('}')) + ",";
    int count = 0;
    for (size_t end; (end = kinds.find(',')) != std::string::npos; kinds.erase(0, end + 1), ++count) {
        CAPTURE(kinds, first);
        CHECK(contains(first, kinds.substr(0, end)));
    }
    CHECK(count == 7);
}

TEST_CASE("bench tick: what a tick looks at does not grow with the mesh or the scene")
{
    const Ran ran = run_command("bench tick --quick --json");
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    int faster = 0;
    for (const Json& row : json["rows"]) {
        CAPTURE(row["scene"].get<std::string>(), row["triangles"].get<int>(), row["objects"].get<int>());
        CHECK(row["tick_ns"]["median"].get<double>() > 0);
        CHECK(row["tree_ns"]["median"].get<double>() > 0);
        for (const char* figure : {"median", "p99", "p999"}) // the least of several runs
            CHECK(row["tick_ns"][figure].get<double>() <= row["once_ns"][figure].get<double>());
        faster += row["tick_ns"]["p99"].get<double>() < row["once_ns"]["p99"].get<double>();
        CHECK(row["contact"].get<double>() == (row["scene"] == "free" ? 0 : 1));
        REQUIRE(row.contains("nodes"));
        CHECK(row["nodes"].is_null()); // not told
        if (row["scene"] != "fbm4") continue;
        // In contact a proxy walks, and asks no tree; of other objects one wakes now and then.
        CHECK(row["queries"]["p99"].get<double>() <= (row["objects"] == 1 ? 0 : 3));
        CHECK(row["queries"]["median"].get<double>() == 0);
        CHECK(row["triangles_stepped"]["median"].get<double>() == 1);
        CHECK(row["triangles_stepped"]["p99"].get<double>() <= 6);
        CHECK(row["triangles_touched"]["median"].get<double>() == 11); // and ten ahead
    }
    CHECK(faster > 0);
    REQUIRE(json["growth"].size() == 6);
    for (const Json& growth : json["growth"])
        if (growth["scene"] == "fbm4") CHECK(growth["touched_p99"].get<double>() < 1.2);
}

TEST_CASE("bench skip: what a tick leaves out nobody feels, and it is counted")
{
    const Folder folder;
    const Ran ran = run_command("bench skip --quick --json --out '" + folder.file("figures") + "'");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    std::map<std::string, int> seen;
    for (const Json& row : json["rows"]) {
        const std::string skip = row["skip"];
        CAPTURE(row["scene"].get<std::string>(), skip);
        ++seen[skip];
        CHECK(row["force_difference_max_n"] == 0);
        for (const std::string time : {"with_ns", "without_ns"}) {
            CHECK(row[time].get<double>() > 0);
            CHECK(row[time + "_p99"].get<double>() >= row[time].get<double>());
        }
        const double counted = row["counted_per_tick"];
        if (skip == "objects")
            CHECK((counted > 990 && counted <= 1000));
        else
            CHECK((counted > 0.9 && counted <= 1));
        // A thousand objects looked at every tick cost more than one, by any clock.
        if (skip == "objects" || skip == "all")
            CHECK(row["without_ns"].get<double>() > 3 * row["with_ns"].get<double>());
    }
    for (const char* skip : {"free_space", "objects", "texture", "octaves", "mapping", "all"}) CHECK(seen[skip] > 0);
    const std::string csv = read_file(folder.path / "figures/skip.csv");
    CHECK(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')) == 1 + json["rows"].size());
    CHECK(csv.starts_with("scene,skip,with_ns"));
    CHECK(Json::parse(read_file(folder.path / "figures/skip.json")) == json);
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
#if defined(__SANITIZE_ADDRESS__) // whose memory is resident as it likes
        continue;
#endif
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

TEST_CASE("bench batch: every texture that paths name, on one thread and on all, with the means of its rows")
{
    const Folder folder;
    std::filesystem::create_directories(folder.path / "more");
    const std::string file = folder.write(
        "hills.haptel", "texture hills(float depth = 1mm in 0mm .. 2mm) { return depth * perlin(p / 3mm); }\n"
                        "texture seen(float depth = 1mm in 0mm .. 2mm) { return depth * (n.x * n.z + uv.x); }\n");
    folder.write("more/waves.haptel", "texture waves() { return 1mm * sinturn(p.x / 3mm); }\n");
    folder.write("more/shapes.haptel", "float twice(float x) { return 2.0 * x; }\n"); // nothing to measure
    const Ran ran = run_command("bench batch --quick --points 3000 --precision f32 --set depth=0.5mm --json '" +
                                folder.path.string() + "' --out '" + folder.file("figures") + "'");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    const size_t thread_counts = std::thread::hardware_concurrency() > 1 ? 2 : 1;
    std::map<std::string, size_t> seen;
    std::map<unsigned, double> log_ratios;
    for (const Json& row : json["rows"]) {
        ++seen[row["texture"]];
        CHECK(row["precision"] == "f32");
        CHECK(row["lanes"].get<int>() > 1);
        for (const std::string name : {"ns_per_point", "height_only_ns_per_point"}) {
            CHECK(row[name].get<double>() > 0);
            CHECK(row[name + "_p99"].get<double>() >= row[name].get<double>());
        }
        log_ratios[row["threads"].get<unsigned>()] +=
            std::log(row["ns_per_point"].get<double>() / row["height_only_ns_per_point"].get<double>());
    }
    const std::map<std::string, size_t> expected{{"hills.haptel:hills", thread_counts},
                                                 {"hills.haptel:seen", thread_counts},
                                                 {"waves.haptel:waves", thread_counts}};
    CHECK(seen == expected);
    CHECK(json["points"] == 3000);
    REQUIRE(json["means"].size() == thread_counts);
    for (const Json& mean : json["means"]) {
        const double geometric = std::exp(log_ratios[mean["threads"].get<unsigned>()] / 3);
        CHECK(std::fabs(mean["gradient_over_height"].get<double>() / geometric - 1) < 1e-9);
    }
    const std::string csv = read_file(folder.path / "figures/batch.csv");
    CHECK(contains(csv.substr(0, csv.find('\n')), ",commit,isa,cpu"));
    CHECK(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')) == 1 + 3 * thread_counts);
    CHECK(contains(csv, "," + json["commit"].get<std::string>() + "," + json["isa"].get<std::string>() + ",\""));

    const Ran none = run_command("bench batch '" + folder.file("more/shapes.haptel") + "'");
    CHECK(none.code == 1);
    CHECK(contains(none.err, "there is no texture in"));
    const Ran broken =
        run_command("bench batch '" + folder.write("broken.haptel", "texture t() { return x; }\n") + "'");
    CHECK(broken.code == 1);
    CHECK(contains(broken.err, "broken.haptel:1:"));
}

TEST_CASE("bench: what is for batch alone is refused by the others, in words")
{
    const std::map<std::string, std::string> given{{"stdlib", "texture files are for haptel bench batch"},
                                                   {"--points 5", "--points is for haptel bench batch"},
                                                   {"--precision f32", "--precision is for haptel bench batch"},
                                                   {"--box 5mm", "--box is for haptel bench batch"},
                                                   {"--set depth=1mm", "--set is for haptel bench batch"}};
    for (const std::string kind : {"compile", "accuracy", "math", "tick", "scale", "skip"})
        for (const auto& [option, words] : given) {
            const Ran ran = run_command("bench " + kind + " " + option + " --quick");
            CAPTURE(kind, option, ran.err);
            CHECK(ran.code == 2);
            CHECK(contains(ran.err, words));
        }
}

TEST_CASE("bench math: every elementary function is as exact as promised, with its times")
{
    const Folder folder;
    const Ran ran = run_command("bench math --quick --json --out '" + folder.file("figures") + "'");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    CHECK(json["rows"].size() == 19);
    for (const Json& row : json["rows"]) {
        INFO(row["function"]);
        CHECK(row["lanes"].get<int>() > 1);
        for (const char* format : {"f64", "f32"}) {
            const Json& figures = row[format];
            CHECK(figures["error_ulp"].get<double>() > 0.4);
            CHECK(figures["error_ulp"].get<double>() <= row["promised_ulp"].get<double>());
            CHECK(figures["library_error_ulp"].get<double>() > 0.4);
            for (const char* times : {"alone_ns", "lanes_ns", "library_ns"})
                CHECK(figures[times]["median"].get<double>() > 0);
            CHECK(figures["lanes_ns"]["median"].get<double>() < figures["alone_ns"]["median"].get<double>());
        }
    }
    const std::string csv = read_file(folder.path / "figures/math.csv");
    CHECK(contains(csv.substr(0, csv.find('\n')), ",commit,isa,cpu"));
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 19);
}
