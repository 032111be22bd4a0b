// Servos with devices of Haptel's and of a program's own.
#include "tests/api/scenes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <memory>
#include <vector>

using namespace haptel;
using namespace haptel::test;

namespace {

// Goes down into a table and says what it felt there; ends after a while.
class Plunger final : public Device {
public:
    explicit Plunger(std::vector<double>& forces_n, bool& stopped) : forces_n_(forces_n), stopped_(stopped) {}
    DeviceState read(Pose& pose) noexcept override
    {
        if (tick_ == 20) return ++tick_, DeviceState::not_ready;
        if (tick_ >= 300) return DeviceState::finished;
        pose.tip_m = {0, 0, tick_ < 10 ? 1e-3 : -2e-3};
        ++tick_;
        return DeviceState::ok;
    }
    DeviceState write(const Vec3& force_n, const Vec3&) noexcept override
    {
        if (forces_n_.size() < forces_n_.capacity()) forces_n_.push_back(force_n.z);
        return DeviceState::ok;
    }
    void stop() noexcept override { stopped_ = true; }
    double force_max_n() const override { return 0.8; }

private:
    std::vector<double>& forces_n_;
    bool& stopped_;
    int tick_ = 0;
};

} // namespace

TEST_CASE("servo: a simulated hand feels a scene, twice the same on the virtual clock")
{
    const auto run = [] {
        Servo servo{
            table({}), open_device("simulated:premium", {.name = "press"}), {.seconds = 2, .virtual_time = true}};
        REQUIRE(servo);
        servo.start();
        return servo.wait();
    };
    const Report one = run(), other = run();
    CHECK(!one.faulted);
    CHECK(one.ticks == 2000);
    CHECK(one.contact_ticks > 100);
    CHECK(one.force_max_n > 0.5); // it presses with 1 N
    CHECK(one.force_max_n == other.force_max_n);
    CHECK(one.energy_j == other.energy_j);
}

TEST_CASE("servo: a program's own device gets its forces, within its own limit, and is stopped at the end")
{
    std::vector<double> forces_n;
    forces_n.reserve(1000);
    bool stopped = false;
    {
        Servo servo{table(), own_device(std::make_unique<Plunger>(forces_n, stopped)), {.virtual_time = true}};
        REQUIRE(servo);
        servo.start();
        servo.start(); // is nothing
        const Report report = servo.wait();
        CHECK(!report.faulted);
        CHECK(report.contact_ticks > 200);
    }
    CHECK(stopped);
    double most_n = 0;
    for (const double n : forces_n) most_n = std::fmax(most_n, n);
    CHECK(std::fabs(most_n - 0.8) < 1e-12); // 1 N of the spring, 0.8 of the motors
    CHECK(forces_n.back() == 0);
}

TEST_CASE("servo: without a scene or a device nothing runs, and it says why")
{
    SceneBuilder build;
    Servo without_scene{build.finish(), open_device("simulated")};
    CHECK(!without_scene);
    CHECK(contains(without_scene.messages(), "a scene needs something to touch"));
    without_scene.start();
    CHECK(without_scene.wait().faulted);

    Servo unknown{table(), open_device("falkon")};
    CHECK(!unknown);
    CHECK(contains(unknown.messages(), "did you mean 'falcon'?"));
    Servo none{table(), own_device(nullptr)};
    CHECK(!none);
    CHECK(contains(none.messages(), "a servo needs a device"));
    Servo unnamed{table(), open_device("")};
    CHECK(!unnamed);
    Servo backwards{table(), open_device("simulated"), {.seconds = -1}};
    CHECK(contains(backwards.messages(), "`seconds` must be at least 0, found -1"));
    Servo hurried{table(), open_device("falcon"), {.seconds = 1, .virtual_time = true}};
    CHECK(contains(hurried.messages(), "`virtual_time` is for simulated devices"));
}
