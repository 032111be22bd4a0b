// A gripper in the simulated hand, through the command: what pushes its fingers apart, in report, trace and replay.
#include "runtime/servo/recording.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

using namespace haptel::test;
using haptel::runtime::TickRecord;
using haptel::tools::Json;

namespace {

std::vector<TickRecord> records_of(const std::string& trace)
{
    const haptel::runtime::TraceResult read = haptel::runtime::read_trace(trace);
    REQUIRE(read.error == "");
    return read.records;
}

} // namespace

TEST_CASE("explore pinches with a gripper, says how hard, and feels the same when its trace is replayed")
{
    const Folder folder;
    const std::string explore = "explore " + project_path("examples/scenes/pinch.toml") + " --clock virtual --json";
    const Ran ran = run_command(explore + " --out " + folder.file("run") + " --seconds 2.2");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    CHECK(ran.err.empty()); // the fingers reach round the cube
    const std::vector<TickRecord> felt = records_of(folder.file("run/trace.csv"));
    REQUIRE(felt.size() == 2200);

    double squares = 0, largest_n = 0;
    for (const TickRecord& tick : felt) {
        squares += tick.grip_force_n * tick.grip_force_n;
        largest_n = std::max(largest_n, std::fabs(tick.grip_force_n));
    }
    const Json json = Json::parse(ran.out);
    CHECK(std::abs(json["grip_force_n"]["max"].get<double>() - largest_n) < 1e-12);
    CHECK(std::abs(json["grip_force_n"]["rms"].get<double>() - std::sqrt(squares / 2200)) < 1e-12);
    CHECK(felt[300].grip_force_n == 0);                    // still open
    CHECK(std::abs(felt[1500].grip_force_n - 1.2) < 0.05); // press_n, but for the device's dry friction of 0.04 N
    CHECK(felt[2150].grip_force_n == 0);                   // open again
    CHECK(contains(
        run_command("explore " + project_path("examples/scenes/pinch.toml") + " --clock virtual --seconds 1.5").out,
        "\n  grip         rms "));

    // Replayed, and from a trace that has no column for it, as older ones.
    std::istringstream in(read_file(folder.file("run/trace.csv")));
    std::string older;
    std::ptrdiff_t columns = -1; // before it; nor those behind it
    for (std::string line; std::getline(in, line);) {
        if (columns < 0)
            columns =
                std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(line.find("grip_force_n")), ',');
        std::size_t end = std::string::npos;
        for (std::ptrdiff_t i = 0; i < columns; ++i) end = line.find(',', end + 1);
        older += line.substr(0, end) + "\n";
    }
    REQUIRE(older.find("grip") == std::string::npos);
    folder.write("older.csv", older);
    for (const std::string trace : {"run/trace.csv", "older.csv"}) {
        CAPTURE(trace);
        // Recorded: a folder's pictures take longer than all the ticks.
        const std::string recording = folder.file("again.haptrace");
        REQUIRE(run_command(explore + " --record " + recording + " --device replay:" + folder.file(trace)).code == 0);
        const std::vector<TickRecord> again = records_of(recording);
        REQUIRE(again.size() == felt.size());
        int different = 0;
        for (size_t i = 0; i < felt.size(); ++i)
            different += again[i].grip_force_n != felt[i].grip_force_n || again[i].force_n != felt[i].force_n;
        CHECK(different == 0);
    }
}
