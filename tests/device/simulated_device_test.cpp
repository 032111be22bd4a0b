// The simulated device against the closed forms of the mechanics it claims to simulate.
#include "device/simulated_device.h"
#include "tests/device/surfaces.h"
#include "tests/support/catch.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace haptel::device;
using namespace haptel::runtime;

namespace {

const glm::dvec3 none(0);

SimulatedDevice make(const DeviceModel& model, const HandImpedance& hand = {}, double press_n = 0, int delay = 0)
{
    SimulatedDevice::Options options;
    options.delay_periods = delay;
    return SimulatedDevice({}, model, Hand(hand, resting(), press_n, period_s), options);
}

DevicePose tick(SimulatedDevice& device, const glm::dvec3& force_n = none)
{
    DevicePose pose;
    REQUIRE(device.read(pose) == DeviceStatus::ok);
    REQUIRE(device.write(force_n, none) == DeviceStatus::ok);
    return pose;
}

} // namespace

TEST_CASE("a free mass with damping runs out as exp(-b t / m)")
{
    const double m = 0.2, b = 2, v0 = 0.1, seconds = 0.1;
    SimulatedDevice device = make({.mass_kg = m, .damping_n_s_per_m = b});
    tick(device);
    device.set_velocity({0, v0, 0});
    const double start = device.position_m().y;
    for (int i = 0; i < 100; ++i) tick(device);
    // Substeps of h = 10 us: the relative error of n implicit steps is n (h b / m)^2 / 2 = 5e-5.
    CHECK(std::abs(device.velocity_m_per_s().y / (v0 * std::exp(-b * seconds / m)) - 1) < 1e-4);
    CHECK(std::abs((device.position_m().y - start) / (v0 * m / b * (1 - std::exp(-b * seconds / m))) - 1) < 1e-4);
    CHECK(device.velocity_m_per_s().x == 0);
}

TEST_CASE("a constant force ends at the velocity where damping balances it")
{
    SimulatedDevice device = make({.mass_kg = 0.1, .damping_n_s_per_m = 4, .force_max_n = 10});
    for (int i = 0; i < 2000; ++i) tick(device, {2, 0, 0});
    CHECK(std::abs(device.velocity_m_per_s().x - 0.5) < 1e-12);
}

TEST_CASE("dry friction stops a sliding mass after v^2 m / 2c, along its path, and then holds it")
{
    const double m = 0.1, c = 0.05;
    const glm::dvec3 v0(0.03, -0.04, 0); // 0.05 m/s
    SimulatedDevice device = make({.mass_kg = m, .coulomb_n = c});
    tick(device);
    device.set_velocity(v0);
    const glm::dvec3 start = device.position_m();
    for (int i = 0; i < 99; ++i) tick(device); // stops after v m / c = 0.1 s
    CHECK(glm::length(device.velocity_m_per_s()) > 0);
    tick(device);
    tick(device);
    CHECK(device.velocity_m_per_s() == none);
    const glm::dvec3 path = device.position_m() - start;
    CHECK(std::abs(glm::length(path) - 0.05 * 0.05 * m / (2 * c)) < 1e-6); // one substep at full speed is 0.5 um
    CHECK(glm::length(glm::cross(path, v0)) < 1e-12);
}

TEST_CASE("friction holds exactly: nothing moves below it, and what exceeds it accelerates the mass")
{
    const DeviceModel model{.mass_kg = 0.1, .coulomb_n = 0.04, .force_max_n = 8};
    SimulatedDevice held = make(model);
    const glm::dvec3 start = held.position_m();
    for (int i = 0; i < 1000; ++i) tick(held, 0.04 * glm::dvec3(0.6, 0, 0.79999));
    CHECK(held.position_m() == start);

    SimulatedDevice moved = make(model);
    for (int i = 0; i <= 1000; ++i) tick(moved, {0.05, 0, 0});
    CHECK(std::abs(moved.velocity_m_per_s().x - (0.05 - 0.04) / 0.1 * 1.0) < 1e-9);
}

TEST_CASE("mass on the hand's spring swings with the period 2 pi sqrt(m / k) and keeps its energy")
{
    const double m = 0.075 + 0.15, k = 500, omega = std::sqrt(k / m), v0 = 0.1;
    SimulatedDevice device = make({.mass_kg = 0.075}, {.mass_kg = 0.15, .stiffness_n_per_m = k});
    tick(device);
    device.set_velocity({v0, 0, 0});
    double worst = 0;
    const int ticks = static_cast<int>(std::lround(100 * 2 * std::numbers::pi / omega / period_s)); // 100 swings
    for (int i = 1; i <= ticks; ++i) {
        tick(device);
        worst = std::max(worst, std::abs(device.position_m().x - v0 / omega * std::sin(omega * i * period_s)));
    }
    // Symplectic steps: the phase drifts by (omega h)^2 / 24 per radian, 6e-6 in 100 swings; position and velocity are
    // half a step apart.
    CHECK(worst < v0 / omega * omega * 10e-6);
}

TEST_CASE("the hand pushes with its force and pulls to its aim")
{
    const double k = 400, press_n = 1.2;
    SimulatedDevice device =
        make({.mass_kg = 0.05}, {.mass_kg = 0.1, .damping_n_s_per_m = 6, .stiffness_n_per_m = k}, press_n);
    for (int i = 0; i < 3000; ++i) tick(device);
    CHECK(glm::distance(device.position_m(), {0, 0, -press_n / k}) < 1e-9); // into the void, as far as the spring lets
}

TEST_CASE("positions are read through the encoder")
{
    const double step = 30e-6;
    SimulatedDevice device = make({.mass_kg = 0.1, .encoder_m = step});
    tick(device);
    device.set_velocity({0.0123, -0.0456, 0.001});
    int changes = 0;
    glm::dvec3 before(0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 read = tick(device).tip_m;
        const glm::dvec3 counts = read / step;
        REQUIRE(glm::length(counts - glm::round(counts)) < 1e-9);
        const glm::dvec3 error = glm::abs(read - device.position_m());
        REQUIRE(glm::all(glm::lessThanEqual(error, glm::dvec3(step / 2 + 1e-15))));
        changes += read != before;
        before = read;
    }
    CHECK(changes > 900); // 45.6 um per tick
}

TEST_CASE("the first read gives the start, each later one advances one period, whatever the clock does")
{
    SimulatedDevice device = make({.mass_kg = 0.1});
    device.set_velocity({1, 0, 0});
    CHECK(tick(device).tip_m.x == 0);
    for (int i = 1; i <= 10; ++i) CHECK(std::abs(tick(device).tip_m.x - i * period_s) < 1e-12);
}

TEST_CASE("a force acts in the next period without delay, in the one after it with a delay of one")
{
    for (const int delay : {0, 1}) {
        SimulatedDevice device = make({.mass_kg = 0.1, .force_max_n = 8}, {}, 0, delay);
        tick(device, {1, 0, 0});
        tick(device);
        const double gained = 1 * period_s / 0.1;
        CHECK(std::abs(device.velocity_m_per_s().x - (delay == 0 ? gained : 0)) < 1e-15);
        tick(device);
        CHECK(std::abs(device.velocity_m_per_s().x - gained) < 1e-15);
        tick(device);
        CHECK(std::abs(device.velocity_m_per_s().x - gained) < 1e-15);
    }
}

TEST_CASE("motors saturate with the direction kept, and a force that is not finite is none")
{
    const DeviceModel model{.mass_kg = 0.1, .force_max_n = 5};
    SimulatedDevice device = make(model);
    tick(device, {300, -400, 0});
    tick(device);
    CHECK(glm::distance(device.velocity_m_per_s(), glm::dvec3(3, -4, 0) * period_s / 0.1) < 1e-12);

    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        SimulatedDevice other = make(model);
        tick(other, {0, bad, 1});
        tick(other);
        CHECK(other.velocity_m_per_s() == none);
    }
}

TEST_CASE("stop lets go")
{
    SimulatedDevice device = make({.mass_kg = 0.1, .force_max_n = 5}, {}, 0, 1);
    tick(device, {1, 0, 0});
    tick(device, {1, 0, 0});
    device.stop();
    tick(device);
    CHECK(device.velocity_m_per_s() == none);
}

namespace {

// Two fingers about a layer as thick as that, the plane z = 0 on its upper side: what pushes each is a spring.
struct Pinched {
    DevicePose pose;
    double grip_n = 0, net_n = 0;
};
Pinched pinch(SimulatedDevice& device, double thickness_m, double stiffness_n_per_m)
{
    Pinched felt;
    REQUIRE(device.read(felt.pose) == DeviceStatus::ok);
    const double above_n = stiffness_n_per_m * std::max(0.0, -felt.pose.tip_m.z),
                 below_n = stiffness_n_per_m * std::max(0.0, felt.pose.tail_m.z + thickness_m);
    felt.grip_n = 0.5 * (above_n + below_n);
    felt.net_n = above_n - below_n;
    device.write_grip(felt.grip_n);
    REQUIRE(device.write({0, 0, felt.net_n}, none) == DeviceStatus::ok);
    return felt;
}

SimulatedDevice gripper(Stroke stroke, double press_n, double open_m)
{
    SimulatedDevice::Options options;
    options.stylus_length_m = open_m;
    options.gripper = true;
    const HandImpedance hand{.mass_kg = 0.1, .damping_n_s_per_m = 5, .stiffness_n_per_m = 500};
    return SimulatedDevice({}, {.mass_kg = 0.05, .force_max_n = 8}, Hand(hand, std::move(stroke), press_n, period_s),
                           options);
}

} // namespace

TEST_CASE("a gripper closes on what is between its fingers with the force of the hand, which then cancels")
{
    constexpr double thickness_m = 0.02, stiffness_n_per_m = 600, press_n = 1.2;
    SimulatedDevice device = gripper(resting(), press_n, 0.05);
    const Pinched first = pinch(device, thickness_m, stiffness_n_per_m);
    CHECK(first.pose.tail_m == first.pose.tip_m - glm::dvec3(0, 0, 0.05));
    CHECK(first.pose.tip_m.z == approach_m);
    Pinched felt;
    for (int i = 0; i < 4000; ++i) felt = pinch(device, thickness_m, stiffness_n_per_m);
    CHECK(std::abs(felt.grip_n - press_n) < 1e-6);
    CHECK(std::abs(felt.net_n) < 1e-6);
    device.stop();
    for (int i = 0; i < 2000; ++i) {
        REQUIRE(device.read(felt.pose) == DeviceStatus::ok);
        REQUIRE(device.write(none, none) == DeviceStatus::ok);
        CHECK(felt.pose.tail_m.z <= felt.pose.tip_m.z);
    }
    CHECK(glm::distance(felt.pose.tail_m, felt.pose.tip_m) < 1e-9); // nothing between them: they meet
}

TEST_CASE("a gripper opens where the stroke does not press, and stays open in a hand that never does")
{
    SimulatedDevice device =
        gripper(Stroke([](double t) { return CurvePoint{{}, 0, t < 1 ? 1.0 : 0.0}; }, plane_at(0), *plane_at(0)(0, 0)),
                1, 0.05);
    for (int i = 0; i < 1500; ++i) pinch(device, 0.02, 600);
    CHECK(pinch(device, 0.02, 600).grip_n > 0.9);
    for (int i = 0; i < 1500; ++i) pinch(device, 0.02, 600);
    const Pinched open = pinch(device, 0.02, 600);
    CHECK(open.grip_n < 1e-9);
    CHECK(std::abs(glm::distance(open.pose.tail_m, open.pose.tip_m) - 0.05) < 1e-9);

    SimulatedDevice idle = gripper(resting(), 0, 0.05);
    for (int i = 0; i < 2000; ++i) pinch(idle, 0.02, 600);
    CHECK(std::abs(pinch(idle, 0.02, 600).pose.tail_m.z + 0.05) < 1e-12);
}

TEST_CASE("a stylus leans from its tip by its length; a point probe has no tail")
{
    SimulatedDevice point = make({.mass_kg = 0.1});
    DevicePose pose = tick(point);
    CHECK(pose.tail_m == pose.tip_m);

    SimulatedDevice::Options options;
    options.stylus_length_m = 0.15;
    SimulatedDevice stylus({}, {.mass_kg = 0.1}, Hand({}, resting(), 0, period_s), options);
    pose = tick(stylus);
    CHECK(std::abs(glm::distance(pose.tail_m, pose.tip_m) - 0.15) < 1e-15);
    CHECK(pose.tail_m.z > pose.tip_m.z + 0.1);
}
