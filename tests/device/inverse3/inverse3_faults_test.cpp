// Whatever becomes of the Inverse3 service: a reason in words, soon, and no force that nobody wants.
#include "tests/device/inverse3/quick_inverse3.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <limits>
#include <random>

using namespace haptel::device;
using namespace haptel::runtime;
using glm::dvec3;

namespace {

using Inverse3Clock = std::chrono::steady_clock;
const dvec3 push_n(0, 0, 4);

double seconds_since(Inverse3Clock::time_point start)
{
    return std::chrono::duration<double>(Inverse3Clock::now() - start).count();
}

bool tells(Inverse3Device& device, const std::string& words)
{
    return tick_until(device, push_n, [&](auto, auto&) { return device.state().find(words) != std::string::npos; });
}

} // namespace

TEST_CASE("an Inverse3 that cannot be had is told of in words")
{
    constexpr std::pair<ServiceFault, const char*> faults[] = {
        {ServiceFault::mute, "does not answer within 300 ms"},
        {ServiceFault::web_page, "is no WebSocket service"},
        {ServiceFault::no_inventory, "does not say within 300 ms which devices it has"},
        {ServiceFault::bad_inventory, "lists a device without a `device_id`"},
        {ServiceFault::no_device, "has no Inverse3: is it plugged in"},
        {ServiceFault::other_device, "has no Inverse3 '049D': there are 1234"}};
    for (const auto& [fault, words] : faults) {
        CAPTURE(name_of(fault));
        FakeService service;
        service.inject(fault);
        Inverse3Times times = quick_times();
        times.connect_ms = 300;
        times.tries = std::numeric_limits<int>::max();
        Inverse3Device device("inverse3", address_of(service), "049D", times);
        CHECK(tells(device, words));
        DevicePose pose;
        CHECK(device.read(pose) == DeviceStatus::not_ready);
        service.inject(ServiceFault::none); // it is found when it is there
        CHECK(tick_until(device, dvec3(0), DeviceStatus::ok));
        CHECK(service.violations() == 0);
    }
}

TEST_CASE("an Inverse3 that stays away is disconnected, and one that talks nonsense is a fault")
{
    FakeService service;
    service.stop();
    Inverse3Times times = quick_times();
    times.patience_s = 0.2;
    times.tries = 3;
    {
        Inverse3Device device("inverse3", address_of(service), "", times);
        CHECK(tick_until(device, push_n, DeviceStatus::disconnected));
        CHECK(device.state().find("no service answers at 127.0.0.1:") == 0);
    }
    service.start();
    service.inject(ServiceFault::bad_json);
    Inverse3Device device("inverse3", address_of(service), "", times);
    CHECK(tick_until(device, push_n, DeviceStatus::fault));
    CHECK(device.state() == "the Inverse3 cannot be used: it sends what is no state of an Inverse3: restart Haply's "
                            "Inverse service");
    CHECK(service.messages_with_force() == 0);
}

TEST_CASE("an Inverse3 whose service says what is no state has no force, and comes back")
{
    for (int i = 0; i < service_faults; ++i) {
        const auto fault = static_cast<ServiceFault>(i);
        if (!ends_connection(fault)) continue;
        CAPTURE(name_of(fault));
        FakeService service;
        Inverse3Device device("inverse3", address_of(service), "", quick_times());
        REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
        bool is_interrupted = false;
        const auto ticks_until = [&](const dvec3& force_n, auto happens) {
            return tick_until(device, force_n, [&](auto status, const DevicePose& pose) {
                is_interrupted |= status == DeviceStatus::ok && pose.interrupted;
                return happens(status);
            });
        };
        service.inject(fault, 0, 1);
        REQUIRE(ticks_until(push_n, [&](auto) { return service.has_met_fault(); }));
        // Nobody wants a force from here on.
        CHECK(ticks_until(dvec3(0), [&](auto) { return service.force_n() == dvec3(0) && service.connections() > 1; }));
        CHECK(ticks_until(push_n,
                          [&](auto status) { return status == DeviceStatus::ok && service.force_n() == push_n; }));
        CHECK(is_interrupted);
        CHECK(service.violations() == 0);
    }
}

TEST_CASE("the force is taken from an Inverse3 before its late service has answered")
{
    FakeService service;
    Inverse3Times times = quick_times();
    times.pose_age_max_ms = 30;
    times.silence_ms = 10'000;
    Inverse3Device device("inverse3", address_of(service), "", times);
    REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
    service.answer_after_ms(1500);
    service.inject(ServiceFault::slow, 0, 2);
    REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.has_met_fault(); }));
    const uint64_t states = service.states();
    CHECK(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == dvec3(0); }));
    CHECK(service.states() == states);
    CHECK(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
    CHECK(service.connections() == 1);
}

TEST_CASE("a force that a lost connection leaves on an Inverse3 is taken away at once")
{
    FakeService service;
    Inverse3Times times = quick_times();
    times.again_ms = 60'000;
    Inverse3Device device("inverse3", address_of(service), "", times);
    REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
    service.inject(ServiceFault::reset, 0, 1);
    REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.has_met_fault(); }));
    CHECK(tick_until(device, dvec3(0), [&](auto, auto&) { return service.force_n() == dvec3(0); }));
}

TEST_CASE("a servo that did not look while its Inverse3 came back has no force, and is told when it does")
{
    FakeService service;
    Inverse3Device device("inverse3", address_of(service), "", quick_times());
    REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
    service.stop();
    service.start();
    const uint64_t forces = service.messages_with_force(), states = service.states();
    for (int i = 0; i < 5000 && service.states() < states + 20; ++i) {
        device.write(push_n, dvec3(0));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    CHECK(service.states() >= states + 20);
    CHECK(service.messages_with_force() == forces);
    DevicePose pose;
    CHECK(device.read(pose) == DeviceStatus::ok);
    CHECK(pose.interrupted);
}

TEST_CASE("a restarted service finds its Inverse3 without a force, and the hand is told")
{
    FakeService service;
    Inverse3Device device("inverse3", address_of(service), "", quick_times());
    REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
    service.stop();
    CHECK(tick_until(device, push_n, DeviceStatus::not_ready));
    CHECK(service.force_n() == push_n); // what no driver can help
    service.start();
    DevicePose first;
    CHECK(tick_until(device, dvec3(0), [&](auto status, const DevicePose& pose) {
        first = pose;
        return status == DeviceStatus::ok;
    }));
    CHECK(first.interrupted);
    CHECK(service.force_n() == dvec3(0));
    CHECK(service.violations() == 0);
}

TEST_CASE("an Inverse3 that is let go while its connection is lost has its force taken away once more")
{
    for (int i = 0; i < 20; ++i) {
        FakeService service;
        {
            Inverse3Times times = quick_times();
            times.again_ms = 2000;
            times.rescue_ms = 3000;
            Inverse3Device device("inverse3", address_of(service), "", times);
            REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.force_n() == push_n; }));
            service.inject(ServiceFault::reset, 0, 1 + static_cast<uint64_t>(i % 3));
            REQUIRE(tick_until(device, push_n, [&](auto, auto&) { return service.has_met_fault(); }));
        }
        service.inject(ServiceFault::none);
        CHECK(service.force_n() == dvec3(0));
    }
}

namespace {

void run_with_service_faults(uint32_t runs)
{
    double longest_s = 0;
    for (uint32_t seed = 1; seed <= runs; ++seed) {
        std::mt19937 random(seed);
        const auto fault = static_cast<ServiceFault>(random() % service_faults);
        INFO("seed " << seed << ": " << name_of(fault));
        FakeService service;
        Inverse3Times times = quick_times();
        times.connect_ms = times.silence_ms = 60;
        times.close_ms = 100;
        times.rescue_ms = 5000; // this machine may be busy
        times.pose_age_max_ms = 30;
        times.tries = 1000;
        const auto start = Inverse3Clock::now();
        uint64_t without_pose = 0;
        {
            Inverse3Device device("inverse3", address_of(service), "049D", times);
            if (random() % 4 != 0) tick_until(device, push_n, DeviceStatus::ok);
            service.inject(fault, random() % 60, random() % 2 == 0 ? 1 + random() % 20 : uint64_t{1} << 60);
            const bool is_killed = random() % 8 == 0;
            uint64_t limit = std::numeric_limits<uint64_t>::max(); // of messages with a force: one may be on its way
            for (int i = 0; i < 100; ++i) {
                DevicePose pose;
                const bool has_pose = device.read(pose) == DeviceStatus::ok;
                device.write(push_n, dvec3(0));
                if (has_pose)
                    limit = std::numeric_limits<uint64_t>::max();
                else if (limit == std::numeric_limits<uint64_t>::max())
                    limit = service.messages_with_force() + 1;
                std::this_thread::sleep_for(std::chrono::microseconds(300));
                without_pose += service.messages_with_force() > limit;
                if (is_killed && i == 50) service.stop();
            }
            service.inject(ServiceFault::none);
            service.start();
            if (random() % 2 == 0) CHECK(tick_until(device, push_n, DeviceStatus::ok));
        }
        CHECK(service.force_n() == dvec3(0));
        CHECK(without_pose == 0);
        CHECK(service.violations() == 0);
        longest_s = std::max(longest_s, seconds_since(start));
    }
    WARN(runs << " runs, the longest " << longest_s << " s");
    CHECK(longest_s < 20);
}

} // namespace

TEST_CASE("faults of an Inverse3 service at random moments: never a force without a pose, and a pose again afterwards")
{
    run_with_service_faults(haptel::test::is_sanitized ? 50 : 200); // each waits
}

TEST_CASE("faults of an Inverse3 service at random moments, two thousand times", "[.long]")
{
    run_with_service_faults(2000);
}
