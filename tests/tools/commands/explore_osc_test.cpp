// haptel explore --osc: what another program does to it while it runs.
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/tools/commands/explore_stage.h"
#include "tests/tools/control/osc_client.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <thread>

using namespace haptel::test;
using namespace std::chrono_literals;
using haptel::tools::Json;

namespace {

// That nobody had a moment ago.
uint16_t free_port()
{
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const int made = socket(AF_INET, SOCK_DGRAM, 0);
    bind(made, reinterpret_cast<const sockaddr*>(&address), size);
    getsockname(made, reinterpret_cast<sockaddr*>(&address), &size);
    close(made);
    return ntohs(address.sin_port);
}

// The answer to a message, which is sent again until there is one.
OscHeard answered(const OscClient& client, const std::string& bytes)
{
    const std::string address = bytes.c_str(); // up to its first zero
    for (int patience = 0; patience < 400; ++patience) {
        client.send(bytes);
        while (const auto heard = client.hear(50ms))
            if ((heard->address == "/haptel/ok" || heard->address == "/haptel/error") && !heard->values.empty() &&
                heard->values[0] == address)
                return *heard;
    }
    return {};
}

// A run, with what is said to it meanwhile.
Ran explored(const std::string& arguments, uint16_t port, const std::function<void(const OscClient&)>& talk)
{
    Ran ran;
    std::thread run([&] { ran = run_command("explore " + arguments + " --osc " + std::to_string(port)); });
    const OscClient client(port);
    const OscHeard first = answered(client, osc_bytes("/haptel/list"));
    CHECK(first.address == "/haptel/ok");
    if (first.address == "/haptel/ok") talk(client);
    run.join();
    return ran;
}

struct TracedForce {
    double force_n;
    bool is_interrupted, is_touching;
};

std::vector<TracedForce> traced(const std::string& file)
{
    std::istringstream in(read_file(file));
    std::string line;
    std::getline(in, line);
    const auto column_of = [header = line](const std::string& name) {
        return std::count(header.begin(),
                          header.begin() + static_cast<long>(("," + header + ",").find("," + name + ",")), ',');
    };
    const auto x = column_of("fx_n"), interrupted = column_of("interrupted"), contact = column_of("contact");
    std::vector<TracedForce> ticks;
    while (std::getline(in, line)) {
        std::vector<double> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, ',');) cells.push_back(std::strtod(cell.c_str(), nullptr));
        const auto at = [&](long column) { return cells.at(static_cast<size_t>(column)); };
        ticks.push_back({std::hypot(at(x), at(x + 1), at(x + 2)), at(interrupted) != 0, at(contact) != 0});
    }
    return ticks;
}

} // namespace

TEST_CASE("explore --osc: parameters, stop and start, recordings; told on standard error where it listens")
{
    const Stage stage;
    const uint16_t port = free_port();
    const std::string run = stage.out("run.haptrace");
    const Ran ran = explored(
        stage.scene + " --seconds 4 --json --out " + stage.out("out") + " --record " + run, port,
        [&](const OscClient& client) {
            const auto says_ok = [&](const std::string& bytes) {
                CHECK(answered(client, bytes).address == "/haptel/ok");
            };
            const std::string depth = "/haptel/object/1/parameter/depth";
            says_ok(osc_string_message(depth, "150um"));
            const OscHeard wrong = answered(client, osc_string_message(depth, "3kg"));
            CHECK(wrong.address == "/haptel/error");
            CHECK(contains(wrong.values.at(1), "unknown unit 'kg'"));
            says_ok(osc_bytes("/haptel/subscribe", "i", osc_word(60)));
            const auto force = client.hear_of("/haptel/state/hand/1/force");
            REQUIRE(force);
            CHECK(force->values.size() == 3);
            const auto value = client.hear_of("/haptel/state/object/1/parameter/depth");
            REQUIRE(value);
            std::this_thread::sleep_for(300ms);
            says_ok(osc_bytes("/haptel/stop"));
            client.drop_what_came();
            CHECK(client.hear_of("/haptel/state/running")->values == std::vector<std::string>{"stopped"});
            says_ok(osc_bytes("/haptel/record/stop"));
            CHECK(answered(client, osc_bytes("/haptel/record/start")).values.at(1) == stage.out("run_take_2.haptrace"));
            std::this_thread::sleep_for(400ms);
            says_ok(osc_bytes("/haptel/start"));
            client.drop_what_came();
            CHECK(client.hear_of("/haptel/state/running")->values == std::vector<std::string>{"running"});
            const auto last = client.hear_of("/haptel/state/running");
            for (auto heard = last; heard; heard = client.hear(1s))
                if (heard->address == "/haptel/state/running" && heard->values[0].starts_with("ended")) return;
            FAIL("it did not say that it ended");
        });
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(ran.err, "osc: listens on 127.0.0.1:" + std::to_string(port)));
    const Json json = json_of(ran);
    CHECK(json["textures_compiled"] == 1); // at the start
    CHECK(json["reloads"] >= 1);
    CHECK((json["allocations_in_tick"] == 0 || json["allocations_in_tick"].is_null()));

    const std::vector<TracedForce> ticks = traced(stage.out("out") + "/trace.csv");
    size_t withheld = 0, touched = 0, last_withheld = 0;
    for (size_t i = 1; i < ticks.size(); ++i) {
        if (!ticks[i].is_interrupted) continue;
        ++withheld;
        touched += ticks[i].is_touching;
        last_withheld = i;
        CHECK(ticks[i].force_n == 0);
    }
    CHECK(withheld >= 300);
    CHECK(touched > 0); // the hand is followed all the same
    REQUIRE(last_withheld + 500 < ticks.size());
    double most_n = 0;
    for (size_t i = last_withheld; i < ticks.size(); ++i) most_n = std::max(most_n, ticks[i].force_n);
    CHECK(most_n > 0.1);
    for (size_t i = last_withheld; i < last_withheld + 100; ++i) // within force_rise_s = 0.1
        CHECK(ticks[i].force_n <= 8.5 * static_cast<double>(i - last_withheld) / 100);
    CHECK(std::filesystem::file_size(run) > 1000);
    CHECK(run_command("replay " + stage.out("run_take_2.haptrace") + " --csv " + stage.out("take.csv")).code != 2);
    CHECK(traced(stage.out("take.csv")).size() > 400);
}

TEST_CASE("explore --osc: the program in docs/control.md turns a knob")
{
    const std::string page = read_file(project_path("docs/control.md")), fence = "```python\n";
    const size_t begin = page.find(fence) + fence.size();
    const Stage stage;
    const std::string program = stage.folder.write("knob.py", page.substr(begin, page.find("```\n", begin) - begin));
    const uint16_t port = free_port();
    int ended = -1;
    const Ran ran = explored(stage.scene + " --seconds 3 --json", port, [&](const OscClient&) {
        const std::string line =
            "python3 '" + program + "' " + std::to_string(port) + " > '" + stage.folder.file("heard") + "'";
        ended = std::system(line.c_str());
    });
    INFO(ran.err);
    CHECK(ended == 0);
    const std::string heard = read_file(stage.folder.file("heard"));
    CHECK(std::count(heard.begin(), heard.end(), '\n') == 3);
    CHECK(!contains(heard, "error"));
    CHECK(json_of(ran)["reloads"] >= 1);
}

TEST_CASE("explore --osc: another scene of the folder is felt, others are refused")
{
    const Stage stage;
    stage.folder.write("smooth.toml", "[[object]]\nshape = \"icosphere\"\nsize_m = 0.1\n");
    stage.folder.write("wrong.toml", "[[object]]\nshap = \"icosphere\"\n");
    const Ran ran = explored(stage.scene + " --seconds 4 --json", free_port(), [&](const OscClient& client) {
        const auto load = [&](const std::string& name) {
            return answered(client, osc_string_message("/haptel/scene/load", name));
        };
        for (const char* name : {"../scene.toml", "/etc/passwd", "grooves.haptel", "none.toml", "", "."})
            CHECK(load(name).address == "/haptel/error");
        CHECK(load("wrong.toml").address == "/haptel/ok"); // it is looked at
        std::this_thread::sleep_for(300ms);
        CHECK(answered(client, osc_string_message("/haptel/object/1/parameter/depth", "70um")).address == "/haptel/ok");
        CHECK(load("smooth.toml").address == "/haptel/ok");
        std::this_thread::sleep_for(500ms);
        CHECK(contains(answered(client, osc_string_message("/haptel/object/1/parameter/depth", "70um")).values.at(1),
                       "object 1 (icosphere) has no texture"));
    });
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(json_of(ran)["scenes_swapped"] == 1);
    CHECK(contains(ran.err, "wrong.toml: not used; what was felt stays"));
    CHECK(contains(ran.err, "smooth.toml: reloaded"));
}

TEST_CASE("explore --osc: thousands of hostile datagrams change nothing of what is felt, and it answers afterwards")
{
    const Stage stage;
    const Ran ran = explored(stage.scene + " --seconds 4 --json", free_port(), [&](const OscClient& client) {
        std::mt19937_64 random(9);
        const std::string set = osc_string_message("/haptel/object/1/parameter/depth", "60um");
        for (int i = 0; i < 5000; ++i) {
            std::string bytes = set.substr(0, random() % set.size());
            if (i % 3 == 0) bytes.resize(random() % 30000, '\xff');
            if (i % 3 == 1)
                for (char& byte : bytes) byte = static_cast<char>(random());
            client.send(bytes);
            if (i % 50 == 0) client.drop_what_came(), std::this_thread::sleep_for(1ms);
        }
        client.drop_what_came();
        CHECK(answered(client, osc_bytes("/haptel/list")).address == "/haptel/ok");
    });
    INFO(ran.err);
    CHECK(ran.code == 0);
    const Json json = json_of(ran);
    CHECK(json["reloads"] == 0);
    CHECK((json["allocations_in_tick"] == 0 || json["allocations_in_tick"].is_null()));
}

TEST_CASE("explore --osc: a port that is none is misuse, one that is taken is a finding")
{
    const Stage stage;
    for (const char* port : {"70000", "-1", "x", "''"})
        CHECK(run_command("explore " + stage.scene + " --seconds 0.1 --clock virtual --osc " + port).code == 2);
    const int taken = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(taken, reinterpret_cast<const sockaddr*>(&address), size) == 0);
    getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size);
    const Ran ran = run_command("explore " + stage.scene + " --seconds 0.1 --clock virtual --osc " +
                                std::to_string(ntohs(address.sin_port)));
    close(taken);
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "choose another port"));
}
