// haptel bench: what scripts rely on.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

using namespace haptel::test;
using haptel::tools::Json;

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
    CHECK(count == 8);
}

TEST_CASE("bench tick: what a tick looks at does not grow with the mesh or the scene")
{
    const Ran ran = run_command("bench tick --quick --json");
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    int faster = 0;
    for (const Json& row : json["rows"]) {
        CAPTURE(row["scene"].get<std::string>(), row["triangles"].get<int>(), row["objects"].get<int>());
        CHECK(row["tick_ns"]["p99"].get<double>() > 0); // a median of some may be less than a clock can tell
        CHECK(row["tree_ns"]["p99"].get<double>() > 0);
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
            if (kind == "compile" && option == "stdlib") continue; // it takes files, too
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
