#include "device/device_factory.h"
#include "device/presets.h"
#include "tests/device/surfaces.h"
#include "tests/support/catch.h"

#include <limits>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

std::string error_of(const DeviceRequest& request)
{
    const DeviceResult result = open_device(request);
    REQUIRE(!result.device);
    return result.error;
}

} // namespace

TEST_CASE("every simulated device opens by its name, with its limits")
{
    for (const DevicePreset& preset : device_presets())
        for (const HandPreset& hand : hand_presets()) {
            const std::string name = "simulated:" + std::string(preset.name) + ":" + std::string(hand.name);
            const DeviceResult opened = open_device(request_on_plane(name));
            REQUIRE(opened.device);
            CHECK(opened.device->info().name == name);
            CHECK(opened.device->info().force_max_n == preset.model.force_max_n);
            CHECK(opened.device->info().stiffness_max_n_per_m > 0);
            CHECK(opened.device->info().position_resolution_m == preset.model.encoder_m);
        }
    DeviceRequest request = request_on_plane("simulated");
    request.exact_positions = true;
    CHECK(open_device(request).device->info().position_resolution_m == 0);
    request.press_n = 9;
    const DeviceResult opened = open_device(request);
    CHECK(opened.device->info().force_max_n == 8.5);
    CHECK(opened.device->info().press_n == 9); // told where it is too much
}

TEST_CASE("unknown names are answered with what was meant, or with what there is")
{
    CHECK(contains(error_of(request_on_plane("simulatd:premium")), "did you mean 'simulated'?"));
    CHECK(contains(error_of(request_on_plane("simulated:premum")), "did you mean 'premium'?"));
    CHECK(contains(error_of(request_on_plane("simulated:premium:frm")), "did you mean 'firm'?"));
    CHECK(contains(error_of(request_on_plane("simulated:premium", "circle")), "did you mean 'circles'?"));
    CHECK(open_device(request_on_plane("simulated:premium", "circle")).about == DeviceKey::stroke);
    CHECK(open_device(request_on_plane("simulated:premum")).about == DeviceKey::name);
    CHECK(contains(error_of(request_on_plane("teapot")), "there are simulated, replay, falcon, inverse3, openffboard, "
                                                         "hid, evdev; `haptel devices` lists what is connected"));
    CHECK(contains(error_of(request_on_plane("")),
                   "there are simulated, replay, falcon, inverse3, openffboard, hid, evdev"));
    CHECK(contains(error_of(request_on_plane("audio")), "`haptel render SCENE --play`"));
    CHECK(contains(error_of(request_on_plane("replay:")), "replay:trace.csv"));
    CHECK(error_of(request_on_plane(std::string(1'000'000, 'x'))).size() < 300);
}

TEST_CASE("a stylus that a workspace makes too long is told of by its length in the hand")
{
    DeviceRequest request = request_on_plane("simulated:premium");
    request.stylus_length_m = 150;
    CHECK(contains(error_of(request), "found 150 m: its length over the scale of the workspace"));
    CHECK(open_device(request).about == DeviceKey::stylus_length);
}

TEST_CASE("a gripper that cannot reach round its object is told of")
{
    DeviceRequest request = request_on_plane("simulated:premium");
    request.box_minimum_m.z = -0.03;
    request.gripper = true;
    request.stylus_length_m = 0.041; // from 1 cm above the plane to 1 mm below the object
    CHECK(open_device(request).warning.empty());
    request.stylus_length_m = 0.039;
    CHECK(contains(open_device(request).warning, "0.039 m apart, do not reach round the object, which takes more than "
                                                 "0.04 m"));
    request.gripper = false;
    CHECK(open_device(request).warning.empty());
}

TEST_CASE("requests out of range are refused, not simulated")
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -1.0, 1e9}) {
        CAPTURE(bad);
        for (double DeviceRequest::* const field : {&DeviceRequest::speed_m_per_s, &DeviceRequest::press_n,
                                                    &DeviceRequest::rate_hz, &DeviceRequest::stylus_length_m}) {
            DeviceRequest request = request_on_plane("simulated:premium");
            request.*field = bad;
            CHECK(!error_of(request).empty());
        }
    }
    DeviceRequest request = request_on_plane("simulated:premium");
    request.surface_below = plane_where([](double, double) { return false; });
    CHECK(contains(error_of(request), "finds no surface"));
    request.surface_below = nullptr;
    CHECK(contains(error_of(request), "needs a surface"));
}
