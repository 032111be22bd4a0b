// An OpenFFBoard made of bytes is brought up, felt and pushed; what may go wrong does.
#include "device/hid/open_hid.h"
#include "runtime/servo/allocation_count.h"
#include "tests/device/hid/board_ticks.h"
#include "tests/support/catch.h"

#include <cmath>
#include <limits>
#include <optional>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

struct Board {
    FakeBoard fake;
    std::optional<AxisDevice> device;

    Board() = default;
    void start(const AxisTimes& times = quick_axes)
    {
        device.emplace("openffboard", open_board(fake), board_settings, times);
    }
    bool pushes_until(const glm::dvec3& force_n, const std::function<bool()>& happens)
    {
        return ticks_until(*device, force_n, [&](auto, auto&) { return happens(); });
    }
};

} // namespace

TEST_CASE("an OpenFFBoard pushes as commanded to a count, whichever way its motors are wired")
{
    for (const double x_sign : {1.0, -1.0})
        for (const double y_sign : {1.0, -1.0}) {
            CAPTURE(x_sign, y_sign);
            Board board;
            board.fake.wire(0, x_sign);
            board.fake.wire(1, y_sign);
            board.start();
            REQUIRE(becomes(*board.device, DeviceStatus::ok));
            CHECK(board.fake.strongest() <= 0.2 * 1.001); // so far it was nudged alone
            // Force of its motors after the wiring: to the right, and away from the user, as y of a stick grows the
            // other way.
            for (const glm::dvec3 force_n : {glm::dvec3(5, 0, 3), glm::dvec3(-7, 11, 0), glm::dvec3(0, -3.3, 0)}) {
                const auto off = [&](int axis, double share) {
                    return std::fabs(share - (axis == 0 ? x_sign : y_sign) * board.fake.force(axis)) * 32767;
                };
                CHECK(board.pushes_until(
                    force_n, [&] { return off(0, force_n.x / 20) <= 1.01 && off(1, -force_n.y / 20) <= 1.01; }));
            }
            board.fake.turn_to(0, 0);
            board.fake.turn_to(1, 0);
            CHECK(board.pushes_until({5, 5, 0},
                                     [&] { return board.fake.place(0) > 0.05 && board.fake.place(1) < -0.05; }));
            CHECK(board.pushes_until(no_force, [&] { return board.fake.force(0) == 0 && board.fake.force(1) == 0; }));
            board.fake.hold(0, true);
            board.fake.hold(1, true);
            board.fake.turn_to(0, 0.25);
            board.fake.turn_to(1, -0.125);
            CHECK(ticks_until(*board.device, no_force, [](DeviceStatus, const DevicePose& pose) {
                return std::fabs(pose.tip_m.x - 0.1) < 1e-5 && std::fabs(pose.tip_m.y - 0.05) < 1e-5;
            }));
            CHECK(board.fake.mistakes() == std::vector<std::string>{});
            board.device.reset();
            CHECK(board.fake.magnitude(0) == 0);
            CHECK(board.fake.magnitude(1) == 0);
            CHECK(!board.fake.active());
        }
}

TEST_CASE("more than a board can do keeps its direction, and what is no number is no force")
{
    Board board;
    board.start();
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    CHECK(board.pushes_until({30, 40, 0}, [&] {
        return std::abs(std::abs(board.fake.magnitude(0)) - 19660) <= 1 &&
               std::abs(std::abs(board.fake.magnitude(1)) - 26214) <= 1;
    }));
    CHECK(board.pushes_until({std::numeric_limits<double>::quiet_NaN(), 1, 0},
                             [&] { return board.fake.force(0) == 0 && board.fake.force(1) == 0; }));
    CHECK(board.fake.strongest() <= 1);
    CHECK(board.fake.mistakes() == std::vector<std::string>{});
}

TEST_CASE("a board whose axis is held fast has no force until it was felt to move")
{
    Board board;
    board.fake.hold(1, true);
    board.start();
    CHECK(ticks_until(*board.device, {9, 9, 0}, [&](DeviceStatus status, auto&) {
        return status == DeviceStatus::not_ready && board.device->state().find("let go of it") != std::string::npos;
    }));
    CHECK(board.fake.strongest() <= 0.2 * 1.001);
    board.fake.hold(1, false);
    CHECK(becomes(*board.device, DeviceStatus::ok));
}

TEST_CASE("the force on a board is taken away when its servo is silent, and when it is stopped")
{
    Board board;
    AxisTimes times = quick_axes;
    times.watchdog_ms = 20;
    board.start(times);
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    REQUIRE(board.pushes_until({9, 0, 0}, [&] { return board.fake.force(0) != 0; }));
    const auto start = std::chrono::steady_clock::now();
    while (board.fake.force(0) != 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(5))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(board.fake.force(0) == 0);
    DevicePose pose;
    CHECK(board.device->read(pose) == DeviceStatus::ok);
    CHECK(pose.interrupted);
    REQUIRE(board.pushes_until({9, 0, 0}, [&] { return board.fake.force(0) != 0; }));
    board.device->stop();
    CHECK(board.pushes_until({9, 0, 0}, [&] { return board.fake.force(0) == 0; }));
}

TEST_CASE("a board that is unplugged is waited for, comes back without force, and is disconnected in the end")
{
    Board board;
    board.start();
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    REQUIRE(board.pushes_until({9, 0, 0}, [&] { return board.fake.force(0) != 0; }));
    board.fake.plug(false);
    CHECK(becomes(*board.device, DeviceStatus::not_ready));
    board.fake.plug(true);
    bool interrupted = false;
    CHECK(ticks_until(*board.device, no_force, [&](DeviceStatus status, const DevicePose& pose) {
        interrupted = pose.interrupted;
        return status == DeviceStatus::ok;
    }));
    CHECK(interrupted);
    CHECK(board.pushes_until({9, 0, 0}, [&] { return std::fabs(board.fake.force(0)) > 0.4; }));
    board.fake.plug(false);
    CHECK(becomes(*board.device, DeviceStatus::disconnected));
    CHECK(board.device->state() == "it is not there");
}

TEST_CASE("whichever transfer to a board is refused, it is ready in the end and no force stays")
{
    for (uint64_t at = 0; at < 30; ++at) {
        CAPTURE(at);
        Board board;
        board.fake.inject(BoardFault::stall, at, 1);
        board.start();
        REQUIRE(ticks_until(*board.device, {5, 0, 0}, [&](DeviceStatus status, auto&) {
            return status == DeviceStatus::ok && board.fake.operations() > at + 20 && board.fake.force(0) != 0;
        }));
        board.device.reset();
        CHECK(board.fake.magnitude(0) == 0);
        CHECK(!board.fake.active());
        CHECK(board.fake.mistakes() == std::vector<std::string>{});
    }
}

TEST_CASE("a force that a board refused is sent again")
{
    Board board;
    board.start();
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    for (int round = 1; round <= 20; ++round) {
        const double force_n = 20.0 * round / 32767 * 100;
        board.fake.inject(BoardFault::stall, 0, 3);
        CHECK(board.pushes_until({force_n, 0, 0}, [&] { return std::abs(board.fake.magnitude(0)) == 100 * round; }));
    }
}

TEST_CASE("a board that answers wrongly for a while is ready afterwards; one that does for good is told of in words")
{
    for (const auto& [fault, why] : std::initializer_list<std::pair<BoardFault, const char*>>{
             {BoardFault::stall, "the device refused the request"},
             {BoardFault::garbage, ""},
             {BoardFault::short_reports, ""},
             {BoardFault::silence, "let go of it"},
             {BoardFault::full, "Block Load: it has no room for an effect"},
             {BoardFault::wrong_block, "Block Load: it made no effect"},
             {BoardFault::slow_block, ""},
             {BoardFault::bad_descriptor, "its report descriptor cannot be read: it is cut off"}})
        for (const bool from_the_start : {true, false}) {
            CAPTURE(static_cast<int>(fault), from_the_start);
            Board board;
            AxisTimes times = quick_axes;
            times.patience_s = 60;
            if (from_the_start) board.fake.inject(fault, 0, 1'000'000'000);
            board.start(times);
            if (!from_the_start) {
                REQUIRE(becomes(*board.device, DeviceStatus::ok));
                board.fake.inject(fault, 0, 1'000'000'000);
            } else if (*why != '\0') {
                CHECK(board.pushes_until({9, 0, 0},
                                         [&] { return board.device->state().find(why) != std::string::npos; }));
                CHECK(board.fake.strongest() <= 0.2 * 1.001);
            }
            int ticks = 0;
            board.pushes_until({9, 0, 0}, [&] { return ++ticks == 50; });
            board.fake.inject(BoardFault::none, 0, 0);
            board.fake.turn_to(0, 0);
            board.fake.turn_to(1, 0);
            CHECK(ticks_until(*board.device, {9, 0, 0}, [&](DeviceStatus status, auto&) {
                return status == DeviceStatus::ok && std::fabs(board.fake.force(0)) > 0.4;
            }));
            const auto start = std::chrono::steady_clock::now();
            board.device.reset();
            CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
            CHECK(board.fake.force(0) == 0);
        }
}

TEST_CASE("a board is read and written without an allocation")
{
    Board board;
    board.start();
    REQUIRE(becomes(*board.device, DeviceStatus::ok));
    DevicePose pose;
    const uint64_t before = allocations_of_this_thread();
    for (int i = 0; i < 1000; ++i) {
        board.device->read(pose);
        board.device->write({1, 0, 0}, no_torque);
    }
    CHECK(allocations_of_this_thread() == before);
}

TEST_CASE("what is written behind hid: is read, or told with what it should be")
{
    const HidText read = read_hid_text("1209:ffb0:00A1,travel_m=0.5,force_max_n=12");
    CHECK(read.error == "");
    CHECK(read.ids == openffboard_ids);
    CHECK(read.serial == "00A1");
    CHECK(read.settings.travel_m == 0.5);
    CHECK(read.settings.force_max_n == 12);
    CHECK(read_hid_text("1209:FFB0").error == "");
    for (const char* wrong :
         {"", "1209", "1209:", "1209:ffb", "1209:ffb00", "12g9:ffb0", "-209:ffb0", "1209;ffb0", "+123:ffb0"})
        CHECK(read_hid_text(wrong).error.find("hid needs the ids of a USB device") == 0);
    CHECK(read_hid_text("1209:ffb0,travel=1").error ==
          "unknown 'travel': there are travel_m and force_max_n, as in hid:VID:PID,travel_m=0.4");
    CHECK(open_openffboard("no such board,force_max_n=0", {}).error ==
          "`force_max_n` must be a number from 0.1 to 100, found '0'");
    const std::string absent = open_openffboard("no such board", {}).error;
    CHECK((absent.find("serial number 'no such board'") != std::string::npos ||
           absent.find("this system gives no access to USB") != std::string::npos));
    CHECK(open_hid("1209", {}).error.find("hid needs") == 0);
}
