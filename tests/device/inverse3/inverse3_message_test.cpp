// What is said to the Inverse3 service and understood of what it says.
#include "device/inverse3/inverse3_message.h"
#include "device/inverse3/service_socket.h"
#include "tests/support/catch.h"

#include <clocale>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

using namespace haptel::device;
using glm::dvec3;

namespace {

std::string state_text(const std::string& position, const std::string& more = "")
{
    return R"({"inverse3":[{"device_id":"A"},{"device_id":"B","state":{"cursor_position":)" + position + more + "}}]}";
}

Inverse3Heard heard(const std::string& text)
{
    return read_inverse3_state(text, "B").heard;
}

} // namespace

TEST_CASE("what is said to an Inverse3 is JSON with every digit of the force, in any locale")
{
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* locale : {"C", "de_DE.UTF-8", "fr_FR.UTF-8"}) {
        if (!std::setlocale(LC_ALL, locale)) continue; // the system has none
        for (const dvec3& force_n : {dvec3(0), dvec3(0.1, -2.5, 1e-300), dvec3(-9.876543210123456, 1e-5, -0.0)}) {
            const auto message = nlohmann::json::parse(inverse3_force("049D", force_n).view());
            const auto& values = message["inverse3"][0]["commands"]["set_cursor_force"]["values"];
            CHECK(message["inverse3"][0]["device_id"] == "049D");
            CHECK(dvec3(values["x"], values["y"], values["z"]) == force_n);
        }
        CHECK(read_inverse3_state(state_text(R"({"x":0.5,"y":-1.25e-1,"z":3})"), "B").state.position_m ==
              dvec3(0.5, -0.125, 3));
    }
    std::setlocale(LC_ALL, before.c_str());
    CHECK(inverse3_force("B", {1, 0, -2.5}).view() ==
          R"({"inverse3":[{"device_id":"B","commands":{"set_cursor_force":{"values":{"x":1,"y":0,"z":-2.5}}}}]})");
    const auto first = nlohmann::json::parse(inverse3_first_message("B").view());
    CHECK(first["session"]["configure"]["profile"]["name"] == "haptel");
    CHECK(first["inverse3"][0]["commands"]["set_cursor_force"]["values"]["z"] == 0);
}

TEST_CASE("the longest message fits, and what is no number is said as no force")
{
    const std::string id(inverse3_id_bytes_max, 'W');
    const double longest = -2.2250738585072014e-308;
    const std::string text(inverse3_force(id, dvec3(longest)).view());
    CHECK(text.ends_with("}}}}]}"));
    CHECK(nlohmann::json::parse(text)["inverse3"][0]["device_id"] == id);
    CHECK(inverse3_first_message(id).view().ends_with("}}}}]}"));
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity})
        CHECK(inverse3_force("B", {1, bad, 1}).view() == inverse3_force("B", dvec3(0)).view());
    CHECK(inverse3_force("\"", dvec3(0)).view() == inverse3_force("", dvec3(0)).view());
}

TEST_CASE("a state of an Inverse3 is one with a place that a device can reach")
{
    const std::string place = R"({"x":0.01,"y":-0.12,"z":0.15})";
    const Inverse3Reply reply =
        read_inverse3_state(state_text(place, R"(,"cursor_velocity":{"x":1,"y":2,"z":-3.5})"), "B");
    CHECK(reply.heard == Inverse3Heard::state);
    CHECK(reply.state.position_m == dvec3(0.01, -0.12, 0.15));
    CHECK(reply.state.velocity_m_per_s == dvec3(1, 2, -3.5));
    CHECK(heard(state_text(place)) == Inverse3Heard::state);
    CHECK(read_inverse3_state(state_text(place), "C").heard == Inverse3Heard::no_device);
    CHECK(heard("{}") == Inverse3Heard::no_device);
    CHECK(heard(R"({"inverse3":[]})") == Inverse3Heard::no_device);
    CHECK(heard(R"({"inverse3":[1,null,"B",[],{"device_id":7}]})") == Inverse3Heard::no_device);
    for (const std::string& bad :
         {std::string(), std::string("[]"), std::string("7"), std::string(R"({"inverse3":{}})"),
          std::string(R"({"inverse3":[{"device_id":"B"}]})"), state_text("{}"), state_text("null"),
          state_text(R"({"x":0,"y":0})"), state_text(R"({"x":0,"y":0,"z":"0"})"), state_text(R"({"x":0,"y":0,"z":11})"),
          state_text(R"({"x":0,"y":0,"z":1e999})"), state_text(R"({"x":0,"y":0,"z":NaN})"),
          state_text(R"({"x":0,"y":0,"z":-1e308})"), state_text(place, R"(,"cursor_velocity":{"x":1})"),
          state_text(place) + "x", std::string(100'000, '['), state_text(place).substr(0, 60)}) {
        CAPTURE(bad.substr(0, 100));
        CHECK(heard(bad) == Inverse3Heard::malformed);
    }
}

TEST_CASE("an inventory of the Inverse3 service names its devices, or is told of as none")
{
    const auto read =
        read_inverse3_inventory(R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"preset":"defaults"}},)"
                                R"({"device_id":"x-1","config":{"preset":"led_front_centered"}}]})");
    REQUIRE(read.devices.size() == 2);
    CHECK(read.devices[0].id == "049D");
    CHECK(!read.devices[0].is_centred);
    CHECK(read.devices[1].is_centred);
    CHECK(read_inverse3_inventory("{}").error.empty());
    for (const char* bad : {"", "[]", R"({"inverse3":7})", R"({"inverse3":[7]})", R"({"inverse3":[{"device_id":""}]})",
                            R"({"inverse3":[{"device_id":"a b"}]})"}) {
        CAPTURE(bad);
        CHECK(read_inverse3_inventory(bad).devices.empty());
        CHECK(!read_inverse3_inventory(bad).error.empty());
    }
}

TEST_CASE("whatever bytes the Inverse3 service sends, a state of them has a finite place")
{
    std::mt19937 random(3);
    const std::string good = state_text(R"({"x":0.01,"y":-0.12,"z":0.15})");
    int states = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::string text = good;
        for (uint32_t changes = 1 + random() % 4; changes > 0; --changes) {
            const std::size_t at = random() % text.size();
            switch (random() % 4) {
            case 0: text[at] = static_cast<char>(random() % 256); break;
            case 1: text.erase(at, random() % 8); break;
            case 2: text.insert(at, text.substr(random() % text.size(), random() % 20)); break;
            case 3: text[at] = "0123456789eE+-.{}[]\",:"[random() % 22]; break;
            }
            if (text.empty()) break;
        }
        const Inverse3Reply reply = read_inverse3_state(text, "B");
        read_inverse3_inventory(text);
        states += reply.heard == Inverse3Heard::state;
        if (reply.heard == Inverse3Heard::state && !(glm::length(reply.state.position_m) <= 10)) FAIL(text);
    }
    CHECK(states > 300);
}

TEST_CASE("the place of the Inverse3 service is localhost or an address, with a port or without")
{
    const auto text_of = [](std::string_view text) {
        const ServiceAddressText read = read_service_address(text);
        return read.error.empty() ? read.address.text() : "refused";
    };
    CHECK(text_of("") == "localhost:10001");
    CHECK(text_of("localhost") == "localhost:10001");
    CHECK(text_of("localhost:9") == "localhost:9");
    CHECK(text_of(":9") == "localhost:9");
    CHECK(text_of("192.168.1.5") == "192.168.1.5:10001");
    CHECK(text_of("127.0.0.1:65535") == "127.0.0.1:65535");
    CHECK(text_of("::1") == "[::1]:10001");
    CHECK(text_of("[::1]:7") == "[::1]:7");
    for (const char* bad : {"example.org", "localhost:", "localhost:0", "localhost:65536", "localhost:1x", "1.2.3:4",
                            "[::1", "[::1]7", "[::1]:", "ws://localhost:10001", "localhost:-1", "a:b:c"}) {
        CAPTURE(bad);
        CHECK(text_of(bad) == "refused");
    }
}
