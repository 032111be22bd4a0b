#include "device/falcon/falcon_link.h"
#include "tests/support/catch.h"

#include <chrono>
#include <string>
#include <thread>

using namespace haptel::device;

namespace {

constexpr FalconTimes unhurried{.keep_alive_ms = 60'000, .watchdog_ms = 60'000, .silence_ms = 60'000};
constexpr FalconCounts some_force{100, -200, 4095};

// What the link would send now, as text: empty if nothing.
std::string said(FalconLink& link)
{
    std::array<uint8_t, 64> room{};
    const std::size_t size = link.next_out(room);
    return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
}

void hear(FalconLink& link, bool homed)
{
    const std::string reply = std::string("1`<AAAAAAAAAAAA") + (homed ? "\xb1" : "\x91") + "A>";
    link.received({reinterpret_cast<const uint8_t*>(reply.data()), reply.size()});
}

void pause_ms(int milliseconds)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// Nibbles from the lowest: 100 is 4 6 0 0, -200 is 8 3 f f, 4095 is f f f 0. Flags: 4 blue, 2 green, 9 homing and red.
const std::string force_in_blue = "<EGAAIDPPPPPAEA>", none_in_green = "<AAAAAAAAAAAACA>",
                  none_homing = "<AAAAAAAAAAAAJA>";

} // namespace

TEST_CASE("no force is sent to arms that are not homed, nor once they are no longer")
{
    FalconLink link(unhurried);
    link.begin_session();
    link.command(some_force);
    CHECK(said(link) == none_homing);
    hear(link, true);
    CHECK(said(link) == force_in_blue);
    hear(link, false);
    CHECK(said(link) == none_homing); // at once, without waiting for the servo
    link.command(some_force);
    CHECK(said(link) == none_homing);
}

TEST_CASE("a command is sent once, the newest of several, and again when nothing else comes")
{
    FalconLink link({.keep_alive_ms = 5, .watchdog_ms = 60'000, .silence_ms = 60'000});
    link.begin_session();
    hear(link, true);
    link.command({1, 1, 1});
    link.command(some_force);
    CHECK(said(link) == force_in_blue);
    CHECK(link.counters().skipped == 1);
    pause_ms(10);
    CHECK(said(link) == force_in_blue);
    CHECK(link.counters().sent == 2);
}

TEST_CASE("a reply tells how long ago the packet that it answers was sent")
{
    FalconLink link(unhurried);
    link.begin_session();
    const auto send = [&] {
        link.command(some_force);
        CHECK(!said(link).empty());
    };
    const auto link_ms = [&] {
        FalconLink::Reading reading;
        REQUIRE(link.newest(reading));
        return 1e-6 * static_cast<double>(reading.link_ns);
    };
    send();
    pause_ms(30);
    send();
    pause_ms(30);
    hear(link, true); // the first of two
    const double first_ms = link_ms();
    hear(link, true);
    const double second_ms = link_ms();
    CHECK(first_ms >= 60);
    CHECK(second_ms >= 30);
    CHECK(first_ms - second_ms >= 29);
    hear(link, true); // answers nothing
    CHECK(link_ms() == 0);

    link.begin_session();
    send();
    const std::string broken = "1`<AAAA<";
    link.received({reinterpret_cast<const uint8_t*>(broken.data()), broken.size()}); // the answer to the first
    pause_ms(30);
    send();
    hear(link, true);
    CHECK(link_ms() < 30);
    for (int i = 0; i < 40; ++i) send(); // more than a device would leave unanswered
    hear(link, true);
    CHECK(link_ms() == 0);
}

TEST_CASE("a link whose thread stood still says no force at once, and none again until a servo asks for one")
{
    FalconLink link(unhurried);
    link.begin_session();
    hear(link, true);
    link.command(some_force);
    CHECK(said(link) == force_in_blue);
    link.was_silenced();
    CHECK(said(link) == none_in_green);
    CHECK(link.force_was_dropped());
    CHECK(link.counters().dropped == 1);
    CHECK(said(link).empty());
    link.was_silenced(); // under no force there is nothing to tell
    CHECK(!link.force_was_dropped());
    link.command(some_force);
    CHECK(said(link) == force_in_blue);
    std::array<uint8_t, 64> room{};
    const std::size_t size = link.last_word(room);
    CHECK(std::string(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)) == none_in_green);
}

TEST_CASE("a force is taken away when its servo is silent, and that is told once")
{
    FalconLink link({.keep_alive_ms = 60'000, .watchdog_ms = 200, .silence_ms = 60'000});
    link.begin_session();
    hear(link, true);
    link.command(some_force);
    CHECK(said(link) == force_in_blue);
    CHECK(!link.force_was_dropped());
    pause_ms(250);
    CHECK(said(link) == none_in_green);
    CHECK(said(link).empty());
    CHECK(link.force_was_dropped());
    CHECK(!link.force_was_dropped());
    CHECK(link.counters().dropped == 1);
}

TEST_CASE("after halt() no command has a force")
{
    FalconLink link(unhurried);
    link.begin_session();
    hear(link, true);
    link.command(some_force);
    CHECK(said(link) == force_in_blue);
    link.halt();
    CHECK(said(link) == none_in_green);
    link.command(some_force);
    CHECK(said(link) == none_in_green);
}

TEST_CASE("a command for a stream that is over is none for the next")
{
    FalconLink link(unhurried);
    link.begin_session();
    hear(link, true);
    link.command(some_force);
    link.end_session();
    link.begin_session();
    hear(link, true);
    CHECK(said(link) == none_in_green);
}

TEST_CASE("a stream in which nothing is heard ends")
{
    FalconLink link({.keep_alive_ms = 1, .watchdog_ms = 1, .silence_ms = 100});
    link.begin_session();
    CHECK(link.wants_more());
    pause_ms(150);
    CHECK(!link.wants_more());
    hear(link, true);
    CHECK(link.wants_more());
    link.quit();
    CHECK(!link.wants_more());
}
