// Devices with fewer axes than three, against closed forms: of where the imagined finger lies, and of what is felt of a
// grating.
#include "runtime/hand/fewer_axes.h"
#include "runtime/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double stiffness = 800, press_n = 1, press_depth_m = press_n / stiffness;
constexpr double rate_hz = 1000;
constexpr int laid_down = 100; // ticks after which the finger lies still, and more

// Goes where it is told and keeps what it is sent.
class Told final : public HapticDevice {
public:
    Told(DeviceAxes axes, std::function<dvec3(int tick)> path_to_go) : path(std::move(path_to_go))
    {
        info_.axes = axes;
    }

    const DeviceInfo& info() const override { return info_; }
    DeviceStatus read(DevicePose& pose) noexcept override
    {
        pose.tip_m = pose.tail_m = path(tick++);
        pose.periods = 1;
        return status;
    }
    DeviceStatus write(const dvec3& force_n, const dvec3&) noexcept override
    {
        sent_n.push_back(force_n);
        return DeviceStatus::ok;
    }
    void stop() noexcept override {}

    std::function<dvec3(int)> path;
    DeviceStatus status = DeviceStatus::ok;
    int tick = 0;
    std::vector<dvec3> sent_n;

private:
    DeviceInfo info_;
};

const DeviceAxes in_plane{{true, true, false}, {true, true, false}},
    on_line{{true, false, false}, {true, false, false}};

struct Finger {
    Told* told;
    FewerAxes device;

    Finger(DeviceAxes axes, std::function<dvec3(int)> path, SurfaceBelow below)
        : Finger(std::make_unique<Told>(axes, std::move(path)), std::move(below))
    {
    }
    DevicePose read()
    {
        DevicePose pose;
        status = device.read(pose);
        return pose;
    }
    DeviceStatus status = DeviceStatus::ok;

private:
    Finger(std::unique_ptr<Told> made, SurfaceBelow below)
        : told(made.get()), device(std::move(made), std::move(below), press_depth_m, rate_hz)
    {
    }
};

std::optional<SurfaceHit> flat(double x_m, double y_m)
{
    return SurfaceHit{{x_m, y_m, 0}, {0, 0, 1}};
}

// A ball of 50 mm round the origin, from above.
std::optional<SurfaceHit> ball(double x_m, double y_m)
{
    const double r = 0.05, z = std::sqrt(r * r - x_m * x_m - y_m * y_m);
    return SurfaceHit{{x_m, y_m, z}, dvec3(x_m, y_m, z) / r};
}

constexpr double wavelength_m = 2e-3, amplitude_m = 20e-6, speed_m_per_s = 0.05;
constexpr double wave_per_m = 2 * std::numbers::pi / wavelength_m;

dvec3 along_grating(int tick)
{
    return {speed_m_per_s * tick / rate_hz - 0.06, 0, tick < laid_down ? 1e-3 : -press_depth_m};
}

// What a device is sent in its tangential axis while it goes over a grating, by the servo's steps; one turn of a sine
// takes 40 ticks, 50 of them are looked at.
std::complex<double> fundamental_n(DeviceAxes axes)
{
    Scene scene = bare_scene(plane_mesh(0.2), sine_texture(amplitude_m, wavelength_m));
    scene.objects[0].material = {stiffness, 0, 0, 0};
    scene.servo.force.lateral_depth_m = 1e-3; // above which, 1.25 mm deep, it does not grow
    HandSettings hand;
    Finger finger(axes, along_grating, flat);
    hand.slopes_only = finger.device.info().slopes_only;
    if (axes.all()) scene.servo.force.model = ForceModel::lateral;
    Renderer renderer(shared(std::move(scene)), hand);
    std::complex<double> sum = 0;
    const int first = 400, count = 2000;
    for (int i = 0; i < first + count; ++i) {
        const DevicePose pose = finger.read();
        const TickResult result = renderer.tick(pose);
        finger.device.write(result.force_n, result.torque_n_m);
        const dvec3 sent = finger.told->sent_n.back();
        if (!axes.pushes.z) REQUIRE(sent.z == 0);
        REQUIRE(sent.y == 0);
        if (i >= first) sum += sent.x * std::polar(2.0 / count, -wave_per_m * pose.tip_m.x);
    }
    return sum;
}

} // namespace

TEST_CASE("a finger that is not sensed is laid down at 40 mm/s and presses as deep as it is to")
{
    Finger finger(in_plane, [](int) { return dvec3(0.01, 0.02, 7); }, flat);
    double before = finger.read().tip_m.z;
    CHECK(std::abs(before - 1e-3) < 1e-12);
    for (int i = 1; i < laid_down; ++i) {
        const dvec3 tip = finger.read().tip_m;
        CHECK((tip.x == 0.01 && tip.y == 0.02));
        CHECK(before - tip.z < 40e-6 + 1e-12);
        CHECK(tip.z >= -press_depth_m);
        before = tip.z;
    }
    CHECK(before == -press_depth_m);
}

TEST_CASE("a finger on a ball presses along its normal")
{
    Finger finger(in_plane, [](int tick) { return dvec3(0.02, 1e-5 * tick, 0); }, ball);
    DevicePose pose;
    for (int i = 0; i < laid_down; ++i) pose = finger.read();
    CHECK(std::abs(glm::length(pose.tip_m) - (0.05 - press_depth_m)) < 1e-12);
    CHECK(std::abs(pose.tip_m.x / pose.tip_m.y - 0.02 / (1e-5 * (laid_down - 1))) < 1e-9);
}

TEST_CASE("one axis is a line through the workspace's origin, whatever the device says of the others")
{
    Finger finger(on_line, [](int) { return dvec3(0.01, 3, -3); }, flat);
    CHECK(finger.read().tip_m.y == 0);
    finger.device.write({1, 2, 3}, {});
    CHECK(finger.told->sent_n.back() == dvec3(1, 0, 0));
}

TEST_CASE("a finger is lifted at a step, beside everything and after an interruption, and laid down anew")
{
    const auto step_at_1mm = [](double x, double) -> std::optional<SurfaceHit> {
        if (x > 2e-3) return std::nullopt;
        return SurfaceHit{{x, 0, x > 1e-3 ? 5e-3 : 0}, {0, 0, 1}};
    };
    double x = 0.95e-3;
    Finger finger(in_plane, [&](int) { return dvec3(x, 0, 0); }, step_at_1mm);
    for (int i = 0; i < laid_down; ++i) finger.read();
    x = 1.05e-3;
    CHECK(std::abs(finger.read().tip_m.z - 6e-3) < 1e-12); // a millimetre above the upper level
    for (int i = 0; i < laid_down; ++i) finger.read();
    CHECK(finger.read().tip_m.z == 5e-3 - press_depth_m);
    x = 3e-3;
    for (int i = 0; i < laid_down; ++i) CHECK(std::abs(finger.read().tip_m.z - 6e-3) < 1e-12);
    x = 1.05e-3;
    for (int i = 0; i < laid_down; ++i) finger.read();
    CHECK(finger.read().tip_m.z == 5e-3 - press_depth_m);

    finger.told->status = DeviceStatus::not_ready;
    finger.read();
    CHECK(finger.status == DeviceStatus::not_ready);
    finger.told->status = DeviceStatus::ok;
    CHECK(std::abs(finger.read().tip_m.z - 6e-3) < 1e-12);

    x = std::numeric_limits<double>::quiet_NaN();
    CHECK(!(finger.read().tip_m.x == finger.read().tip_m.x)); // for the renderer to refuse
}

TEST_CASE("a device of one axis or two feels of a grating what one of three does: period, amplitude, phase")
{
    // K l A k cos(k x) against the slope, of A sin(k x): the same at each depth beyond l = 1 mm
    const double expected_n = stiffness * 1e-3 * amplitude_m * wave_per_m;
    for (const DeviceAxes& axes : {DeviceAxes(), in_plane, on_line}) {
        const std::complex<double> felt_n = fundamental_n(axes);
        CAPTURE(axes.senses.y, axes.senses.z, felt_n.real(), felt_n.imag());
        CHECK(std::abs(felt_n.real() + expected_n) < 1e-6 * expected_n);
        CHECK(std::abs(felt_n.imag()) < 1e-6 * expected_n);
    }
}
