// The server on real sockets of this machine: who can reach it, and what hostile datagrams do to it.
#include "tests/support/catch.h"
#include "tests/tools/control/fake_controlled.h"
#include "tests/tools/control/osc_client.h"
#include "tools/control/osc_server.h"

#include <algorithm>
#include <random>

using namespace haptel;
using namespace haptel::test;
using tools::OscServer;

namespace {

// Until the answer is there.
std::optional<OscHeard> answer_of(OscServer& server, const OscClient& client, std::string_view address)
{
    for (int patience = 0; patience < 2000; ++patience) {
        server.wait(std::chrono::milliseconds(1));
        server.serve();
        while (std::optional<OscHeard> heard = client.hear(std::chrono::milliseconds(0)))
            if (heard->values.size() > 0 && heard->values[0] == address) return heard;
    }
    return std::nullopt;
}

std::vector<std::string> sensible_messages()
{
    return {
        osc_string_message("/haptel/object/2/parameter/depth", "60um"),
        osc_bytes("/haptel/object/2/parameter/depth", "f", osc_float(0.25f)),
        osc_string_message("/haptel/object/2/preset", "rock"),
        osc_bytes("/haptel/subscribe", "ii", osc_word(30) + osc_word(7001)),
        osc_bundle({osc_bytes("/haptel/list"), osc_bytes("/haptel/list")}), // what is left of a cut one is a message
        osc_bytes("/haptel/record/start")};
}

} // namespace

TEST_CASE("osc: the server listens on the loopback address alone")
{
    FakeControlled controlled;
    const OscServer server(0, controlled);
    REQUIRE(server.error().empty());
    const std::vector<std::string> bound = server.bound_addresses();
    REQUIRE(!bound.empty());
    for (const std::string& address : bound) {
        CAPTURE(address);
        CHECK((address.starts_with("127.0.0.1:") || address.starts_with("[::1]:")));
        CHECK(address.ends_with(":" + std::to_string(server.port())));
    }
    CHECK(bound[0].starts_with("127.0.0.1:"));
    const OscServer another(server.port(), controlled);
    CHECK(another.error().find("choose another port") != std::string::npos);
}

TEST_CASE("osc: a message to the server is done and answered; one with the server's own port is dropped")
{
    FakeControlled controlled;
    OscServer server(0, controlled);
    const OscClient client(server.port());
    client.send(osc_string_message("/haptel/object/2/parameter/depth", "60um"));
    const auto heard = answer_of(server, client, "/haptel/object/2/parameter/depth");
    REQUIRE(heard);
    CHECK(heard->address == "/haptel/ok");
    CHECK(controlled.done == std::vector<std::string>{"set 2 depth 60um"});

    // Subscribed to itself: what it tells itself is dropped, and nothing goes round.
    client.send(osc_bytes("/haptel/subscribe", "ii", osc_word(60) + osc_word(server.port())));
    REQUIRE(answer_of(server, client, "/haptel/subscribe"));
    for (int i = 0; i < 100; ++i) {
        server.wait(std::chrono::milliseconds(1));
        server.serve();
    }
    CHECK(controlled.done.size() == 1);
}

TEST_CASE("osc: thousands of hostile datagrams change nothing, and it answers afterwards")
{
    FakeControlled controlled;
    OscServer server(0, controlled);
    const OscClient hostile(server.port()), client(server.port());
    std::mt19937_64 random(12);
    const std::vector<std::string> corpus = sensible_messages();
    for (int i = 0; i < 6000; ++i) {
        std::string bytes = corpus[random() % corpus.size()];
        switch (random() % 4) {
        case 0: // noise
            bytes.assign(random() % 600, '\0');
            for (char& byte : bytes) byte = static_cast<char>(random());
            break;
        case 1: // cut short: the end of the address, or of the values, is gone
            bytes.resize(random() % bytes.size());
            break;
        case 2: // more than there may be, up to the most that UDP carries
            bytes.resize(tools::osc_bytes_max + 1 + random() % 50000, static_cast<char>(random()));
            break;
        default: // the address of nothing, with types of anything
            bytes[1 + random() % 6] ^= static_cast<char>(1 + random() % 255);
            bytes[bytes.size() - 1 - random() % 8] ^= static_cast<char>(random());
            break;
        }
        hostile.send(bytes);
        if (i % 8 == 0) {
            server.serve();
            hostile.drop_what_came();
        }
    }
    CHECK(controlled.done.empty());
    CHECK(!controlled.withheld);
    client.send(osc_string_message("/haptel/object/2/preset", "rock"));
    const auto heard = answer_of(server, client, "/haptel/object/2/preset");
    REQUIRE(heard);
    CHECK(heard->address == "/haptel/ok");
    CHECK(controlled.done.size() == 1);
}
