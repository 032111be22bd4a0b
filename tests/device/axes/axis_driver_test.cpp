// How the driver of wheels and sticks finds out which way they push.
#include "device/axes/axis_driver.h"
#include "tests/support/catch.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

using namespace haptel::device;

namespace {

// Coasts towards greater values for a while, whatever its motor does, and then gives way to it. The motor is wired the
// other way round.
class CoastingPort final : public AxisPort {
public:
    explicit CoastingPort(std::atomic<double>& level) : level_(level) {}
    std::optional<AxisRange> axis(int number) const override
    {
        return number == 0 ? std::optional(AxisRange{-10'000, 10'000, -5000}) : std::nullopt;
    }
    std::string serve(WakeEvent&, AxisClient& client) override
    {
        const auto start = std::chrono::steady_clock::now();
        for (double value = -5000; client.wants_more();) {
            level_ = client.levels()[0];
            const bool coasts = std::chrono::steady_clock::now() - start < std::chrono::milliseconds(250);
            value += coasts ? 15 : -100 * level_;
            client.moved(0, static_cast<int64_t>(value));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return "";
    }

private:
    std::atomic<double>& level_;
};

} // namespace

TEST_CASE("an axis that coasts is not taken for one that was pushed")
{
    std::atomic<double> level{0};
    AxisDriver driver([&] { return OpenedAxes{std::make_unique<CoastingPort>(level), "", false}; },
                      {.watchdog_ms = 1000, .nudge_ms = 60, .again_ms = 20});
    AxisReading reading;
    for (int i = 0; i < 5000 && !(driver.newest(reading) && driver.phase() == AxisPhase::running); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    REQUIRE(driver.phase() == AxisPhase::running);
    driver.command({0.5, 0});
    for (int i = 0; i < 5000 && std::fabs(level) != 0.5; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(level == -0.5);
}
