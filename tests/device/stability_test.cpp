// Closed loops through the simulated device, against what sampled-data theory says of them.
#include "device/device_factory.h"
#include "device/simulated_device.h"
#include "tests/device/surfaces.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

// A wall below z = 0, felt as a spring.
glm::dvec3 wall_n(const DevicePose& pose, double stiffness_n_per_m)
{
    return {0, 0, stiffness_n_per_m * std::max(-pose.tip_m.z, 0.0)};
}

// Largest displacement in the last half second over that in the first, of a mass on a virtual spring after a push.
double growth(double stiffness_n_per_m, double mass_kg, double damping, int delay)
{
    SimulatedDevice::Options options;
    options.delay_periods = delay;
    SimulatedDevice device({}, {.mass_kg = mass_kg, .damping_n_s_per_m = damping, .force_max_n = 1e300},
                           Hand({}, resting(), 0, period_s), options);
    device.set_velocity({0.1, 0, 0});
    double first = 0, last = 0;
    const int ticks = 6000;
    for (int i = 0; i < ticks; ++i) {
        DevicePose pose;
        device.read(pose);
        device.write({-stiffness_n_per_m * pose.tip_m.x, 0, 0}, {});
        if (i < 500) first = std::max(first, std::abs(pose.tip_m.x));
        if (i >= ticks - 500) last = std::max(last, std::abs(pose.tip_m.x));
    }
    return last / first;
}

} // namespace

TEST_CASE("a virtual spring is stable up to 2b / ((2n+1) T) and not much beyond")
{
    // For masses and dampings of hands and devices the passivity bound is the linear limit to within 14 %.
    for (const double mass_kg : {0.05, 0.125, 0.3})
        for (const double damping : {1.0, 2.0, 5.0})
            for (const int delay : {0, 1}) {
                const double limit = 2 * damping / ((2 * delay + 1) * period_s);
                CAPTURE(mass_kg, damping, delay, limit);
                CHECK(growth(0.9 * limit, mass_kg, damping, delay) < 0.9);
                CHECK(growth(1.25 * limit, mass_kg, damping, delay) > 2);
            }
}

TEST_CASE("the premium device settles on a wall of moderate stiffness, where the forces balance")
{
    // Limit for device and hand, one period of delay: 2 * 5.1 / (3 * 1 ms) = 3400 N/m.
    const double stiffness = 800, hand = 500, press_n = 1;
    DeviceRequest request = request_on_plane("simulated:premium", "press");
    request.press_n = press_n;
    const DeviceResult opened = open_device(request);
    REQUIRE(opened.device);
    double low = 1, high = -1, deepest = 0;
    for (int i = 0; i < 1650; ++i) { // 0.7 s of coming down, then held for one second
        DevicePose pose;
        REQUIRE(opened.device->read(pose) == DeviceStatus::ok);
        opened.device->write(wall_n(pose, stiffness), {});
        deepest = std::min(deepest, pose.tip_m.z);
        if (i >= 1200 && i < 1600) {
            low = std::min(low, pose.tip_m.z);
            high = std::max(high, pose.tip_m.z);
        }
    }
    CHECK(high - low <= 2 * 30e-6); // two counts of the encoder
    // Balance, give or take one count and the friction of 0.04 N.
    const double balance = -press_n / (stiffness + hand);
    CHECK(std::abs((low + high) / 2 - balance) < 30e-6 + 0.04 / (stiffness + hand));
    CHECK(deepest > 2 * balance); // no impact to speak of
}

TEST_CASE("twin runs are bit-equal, with every stroke")
{
    for (const std::string_view stroke : stroke_names()) {
        std::vector<glm::dvec3> tips[2];
        for (auto& run : tips) {
            const DeviceResult opened = open_device(request_on_plane("simulated:touch", std::string(stroke)));
            REQUIRE(opened.device);
            for (int i = 0; i < 3000; ++i) {
                DevicePose pose;
                opened.device->read(pose);
                opened.device->write(wall_n(pose, 700) + glm::dvec3(0.1 * std::sin(1000 * pose.tip_m.x), 0, 0), {});
                run.push_back(pose.tip_m);
            }
        }
        CHECK(tips[0] == tips[1]);
        CHECK(tips[0].front() != tips[0].back());
    }
}

TEST_CASE("a hand that strokes a wall touches it most of the time and stays near its stroke")
{
    for (const std::string device : {"premium", "touch", "falcon", "omega", "harsh", "premium:light"}) {
        CAPTURE(device);
        const DeviceResult opened = open_device(request_on_plane("simulated:" + device));
        REQUIRE(opened.device);
        int touching = 0;
        double furthest = 0;
        for (int i = 0; i < 5000; ++i) {
            DevicePose pose;
            opened.device->read(pose);
            opened.device->write(wall_n(pose, 400), {});
            touching += pose.tip_m.z < 0;
            if (i > 1000) furthest = std::max(furthest, std::abs(glm::length(glm::dvec2(pose.tip_m)) - 0.009));
        }
        CHECK(touching > 4000);
        CHECK(furthest < 0.004); // circles of 9 mm; a light hand lags and swings out, dry friction holds it back
    }
}
