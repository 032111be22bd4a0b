// haptel devices: what it lists on a machine without devices, when a device counts as opened, and what it says of an
// Inverse3 service that is not as it should be.
#include "tests/device/inverse3/fake_service.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

using haptel::device::FakeService;
using haptel::device::ServiceFault;
using namespace haptel::test;
using haptel::tools::Json;

TEST_CASE("devices: lists what is supported, by the names that open it")
{
    const Ran ran = run_command("devices --json");
    REQUIRE(ran.code == 0);
    const Json all = Json::parse(ran.out);
    // No board is in the machine that tests, and the simulated ones are in all.
    std::map<std::string, Json> listed;
    for (const Json& one : all["devices"]) listed[one["name"]] = one;
    REQUIRE(listed.count("falcon") == 1);
    CHECK(listed["falcon"]["state"] == "absent");
    CHECK(listed["falcon"]["transport"] == "usb");
    CHECK(listed["falcon"]["cure"] == "Plug it in and switch it on");
    const Json wheel = listed["simulated:wheel"]; // 15 N on a rim, an effect every 2 ms
    CHECK(wheel["state"] == "ready");
    CHECK(wheel["reason"].is_null());
    CHECK(wheel["axes"] == Json::parse(R"({"sensed": ["x"], "pushed": ["x"]})"));
    CHECK(wheel["rate_hz"] == 500);
    CHECK(wheel["force_max_n"] == 15);
    bool has_falcon = false;
    for (const Json& one : all["supported"]) has_falcon |= one["name"] == "falcon[:SERIAL]";
    CHECK(has_falcon);
    const Ran text = run_command("devices");
    CHECK(text.code == 0);
    CHECK(text.out.find("simulated[:PRESET[:HAND]]") != std::string::npos);
}

TEST_CASE("devices: one that moves is opened; its axes, its range and its readings are told")
{
    const Ran ran = run_command("devices --open simulated:wheel --seconds 2 --json");
    REQUIRE(ran.code == 0);
    const Json said = Json::parse(ran.out);
    CHECK(said["opened"] == true);
    CHECK(said["axes"] == Json::parse(R"({"sensed": ["x"], "pushed": ["x"]})"));
    CHECK(said["reads"] == 2000); // two seconds at 1 kHz
    CHECK(said["poses"] == 2000);
    CHECK(said["range_m"][0] > 1e-4);
    CHECK(said["range_m"][1] == 0);
}

TEST_CASE("devices: one that is not there, or unknown, is told with what to do")
{
    const Ran unknown = run_command("devices --open falkon");
    CHECK(unknown.code == 1);
    CHECK(unknown.err.find("did you mean 'falcon'?") != std::string::npos);
    CHECK(run_command("devices --open simulated --seconds -1").code == 2);
}

TEST_CASE(
    "devices: an Inverse3 is listed and opened through its service; what answers otherwise is told with what to do")
{
    FakeService service;
    const std::string place = "127.0.0.1:" + std::to_string(service.port());
    const std::string before = "HAPTEL_INVERSE3_SERVICE=" + place;
    CHECK(contains(run_command("devices", before).out,
                   "  inverse3:049D              Haply Inverse3, service at " + place + "\n"));
    const Json served = Json::parse(run_command("devices --json", before).out);
    for (const Json& one : served["devices"])
        if (one["kind"] == "inverse3") {
            CHECK(one["name"] == "inverse3:049D");
            CHECK(one["transport"] == "service");
            CHECK(one["state"] == "ready");
            CHECK(one["force_max_n"] == 10); // its maker's
        }
    const Ran still = run_command("devices --open inverse3:049D --seconds 1", before);
    CHECK(contains(still.out, "inverse3:049D: senses xyz, pushes xyz, at most 10 N"));
    CHECK(contains(still.err, "move it while this looks"));
    CHECK(contains(run_command("devices --open inverse3:77", before).err, "has no Inverse3 '77': there are 049D"));
    CHECK(service.messages_with_force() == 0);

    const std::string name_it = "HAPTEL_INVERSE3_SERVICE=HOST:PORT";
    const std::tuple<ServiceFault, std::string, std::string> faults[] = {
        {ServiceFault::mute, "what listens at " + place + " does not answer within", name_it},
        {ServiceFault::web_page, "what listens at " + place + " is no WebSocket service (", name_it},
        {ServiceFault::bad_inventory, "what listens at " + place + " is no Inverse3 service: it lists", name_it},
        {ServiceFault::no_inventory, "does not say within", "restart it"}};
    for (const auto& [fault, found, to_do] : faults) {
        CAPTURE(found);
        service.inject(fault);
        const std::string error = run_command("devices --open inverse3", before).err;
        CHECK(contains(error, found));
        CHECK(contains(error, to_do));
        if (is_sanitized && fault != ServiceFault::mute) continue; // each is waited for in each command
        const Json faulty = Json::parse(run_command("devices --json", before).out)["devices"];
        CHECK(std::ranges::count(faulty, "faulty", [](const Json& one) { return one["state"]; }) == 1);
        const std::string listed = run_command("devices", before).out;
        CHECK(contains(listed, "  not looked for: Haply Inverse3: "));
        CHECK(contains(listed, found));
        CHECK(contains(listed, to_do));
    }
    service.inject(ServiceFault::no_device);
    CHECK(
        contains(run_command("devices --open inverse3", before).err, "has no Inverse3: is it plugged in and switched"));
    service.inject(ServiceFault::bad_state);
    CHECK(contains(run_command("devices --open inverse3 --seconds 3", before).err,
                   "it sends what is no state of an Inverse3: restart Haply's Inverse service"));
    service.stop();
    CHECK(contains(run_command("devices --open inverse3", before).err, "start Haply's Inverse service, or name its"));
    CHECK(contains(run_command("devices", before).out, "no service answers at " + place));
    CHECK(contains(run_command("devices --open inverse3", "HAPTEL_INVERSE3_SERVICE=example.org").err,
                   "is localhost or an IP address, as in"));
}
