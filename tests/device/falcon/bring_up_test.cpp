#include "device/falcon/falcon_bring_up.h"
#include "tests/device/falcon/fake_transport.h"
#include "tests/device/falcon/firmware_image.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <chrono>

using namespace haptel::device;

namespace {

const std::atomic<bool> go_on{false};
constexpr BringUpLimits short_limits{.probes = 2, .calls = 10, .reads = 25, .transfer_ms = 10, .seconds = 5};

BringUpResult bring_up_once(FakeFalcon& falcon, const std::vector<uint8_t>& image,
                            const std::atomic<bool>& quit = go_on)
{
    FakeTransport transport(falcon, 1);
    return bring_up_falcon(transport, image, short_limits, quit);
}

} // namespace

TEST_CASE("a Falcon that runs its program needs no firmware")
{
    FakeFalcon falcon(true);
    const BringUpResult result = bring_up_once(falcon, {});
    CHECK(result.end == BringUpEnd::ready);
    CHECK(!result.loaded);
    CHECK(falcon.violations() == 0);
    CHECK(falcon.packets_with_force() == 0);
}

TEST_CASE("one that runs none is given the whole image, byte for byte, and then answers")
{
    FakeFalcon falcon(false);
    const auto image = synthetic_firmware();
    const BringUpResult result = bring_up_once(falcon, image);
    CHECK(result.reason == "");
    CHECK(result.end == BringUpEnd::ready);
    CHECK(result.loaded);
    CHECK(falcon.image() == image);
    CHECK(falcon.packets_with_force() == 0);

    // Its power stays on: another program finds it running.
    CHECK(!bring_up_once(falcon, {}).loaded);
}

TEST_CASE("one that runs none and is given none is told of as that")
{
    FakeFalcon falcon(false);
    const BringUpResult result = bring_up_once(falcon, {});
    CHECK(result.end == BringUpEnd::no_program);
    CHECK(result.reason.find("it runs no program, and there is no firmware to load") == 0);
}

TEST_CASE("the boot loader is called in the order that is known to work")
{
    FakeFalcon falcon(false);
    REQUIRE(bring_up_once(falcon, synthetic_firmware(30)).loaded);
    const std::vector<std::string> normal = {"0 0001", "0 0002", "9 0001", "3 0002", "0 0001", "0 0002"};
    std::vector<std::string> expected = normal;
    for (int probe = 0; probe < short_limits.probes; ++probe) expected.push_back("write 16");
    for (const char* step : {"0 0001", "0 0002", "9 0010", "3 4138", "4 0008", "2 0000", "1 0200", "1 0100", "1 0101",
                             "write 3", "1 0100", "3 0015", "write 1"})
        expected.push_back(step);
    for (std::size_t left = synthetic_firmware(30).size(); left > 0; left -= std::min<std::size_t>(left, 62))
        expected.push_back("write " + std::to_string(std::min<std::size_t>(left, 62)));
    expected.insert(expected.end(), normal.begin(), normal.end());
    expected.push_back("write 16");
    CHECK(falcon.requests() == expected);
}

// Each fault at each step. Whoever comes to an end in time with a reason, and never asks for a force, has passed; after
// a fault that passes, the next try succeeds, unless the device was unplugged.
TEST_CASE("whatever goes wrong at whichever step of bringing it up, it ends, says why, and can be tried again")
{
    const auto image = synthetic_firmware(100);
    FakeFalcon clean(false);
    REQUIRE(bring_up_once(clean, image).end == BringUpEnd::ready);
    const uint64_t steps = clean.operations();
    int runs = 0, recovered = 0, untouched = 0;
    uint64_t most_operations = 0;
    for (const FakeFault fault : all_fake_faults)
        for (uint64_t step = 0; step < steps; ++step)
            for (const uint64_t lasts : {uint64_t{1}, uint64_t{40}, uint64_t{1} << 60}) {
                INFO(name_of(fault) << " at operation " << step << " for " << lasts);
                FakeFalcon falcon(false);
                falcon.inject(fault, step, lasts);
                BringUpResult result = bring_up_once(falcon, image);
                ++runs;
                REQUIRE(result.reason.empty() == (result.end == BringUpEnd::ready));
                REQUIRE(falcon.packets_with_force() + falcon.violations() == 0);
                REQUIRE((result.error == UsbError::gone) == (fault == FakeFault::unplug));
                untouched += result.end == BringUpEnd::ready;
                if (fault == FakeFault::unplug) falcon.plug_in();
                falcon.inject(FakeFault::none, 0, 0);
                for (int again = 0; again < 10 && result.end != BringUpEnd::ready; ++again)
                    result = bring_up_once(falcon, image);
                recovered += result.end == BringUpEnd::ready;
                most_operations = std::max(most_operations, falcon.operations());
            }
    WARN(runs << " runs of " << steps << " steps: " << untouched << " ready in spite of the fault, all " << recovered
              << " after it; at most " << most_operations << " operations");
    CHECK(recovered == runs);
    CHECK(most_operations < 5000);
}

TEST_CASE("bringing up ends soon when the driver ends")
{
    FakeFalcon falcon(false);
    const std::atomic<bool> quit{true};
    CHECK(bring_up_once(falcon, synthetic_firmware(), quit).end == BringUpEnd::try_again);
    CHECK(falcon.operations() < 20);
}

TEST_CASE("bringing up ends at its deadline when each transfer takes its time")
{
    // A converter that answers everything and never sends a byte, slowly.
    struct Slow final : Transport {
        Transferred control(const ControlRequest&, std::span<uint8_t>, int) override { return {}; }
        Transferred out(uint8_t, std::span<const uint8_t> bytes, int) override
        {
            return {UsbError::none, bytes.size()};
        }
        Transferred in(uint8_t, std::span<uint8_t>, int timeout_ms) override
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
            return {UsbError::timeout, 0};
        }
        UsbError stream(const StreamSettings&, WakeEvent&, StreamClient&) override { return UsbError::failed; }
    } slow;
    const auto start = std::chrono::steady_clock::now();
    const BringUpLimits limits{.probes = 10, .calls = 100, .reads = 100, .transfer_ms = 10, .seconds = 0.2};
    const BringUpResult result = bring_up_falcon(slow, synthetic_firmware(), limits, go_on);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    CHECK(result.end == BringUpEnd::try_again);
    CHECK(result.reason == "its boot loader does not answer");
    CHECK(took.count() < 2);
}
