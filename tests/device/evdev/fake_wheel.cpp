#include "tests/device/evdev/fake_wheel.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

namespace haptel::device {

namespace {

constexpr double acceleration_per_s2 = 60; // at full level, of ways from end to end
constexpr double damping_per_s = 20;
constexpr double step_s = 1e-4;

int value_of(double place)
{
    return static_cast<int>(std::lround((place + 0.5) * FakeWheel::value_max));
}

} // namespace

class FakeWheel::Port final : public InputPort {
public:
    explicit Port(FakeWheel& of) : wheel(of) { ++wheel.ports; }
    ~Port() override // as the kernel does
    {
        const std::lock_guard lock(wheel.mutex_);
        for (Axis& axis : wheel.axes) axis.level = 0;
        --wheel.ports;
    }

    bool has_constant_force() const override { return true; }
    std::optional<AxisRange> axis(int number) const override
    {
        if (number >= wheel.count) return std::nullopt;
        const std::lock_guard lock(wheel.mutex_);
        Axis& axis = wheel.axes[static_cast<std::size_t>(number)];
        return AxisRange{0, value_max, axis.told = value_of(axis.place)};
    }
    int set_level(int number, double level) override
    {
        if (const int error = wheel.call()) return error;
        const std::lock_guard lock(wheel.mutex_);
        wheel.axes[static_cast<std::size_t>(number)].level = level;
        return 0;
    }
    int play(int number) override
    {
        if (const int error = wheel.call()) return error;
        ++wheel.replays_;
        const std::lock_guard lock(wheel.mutex_);
        wheel.axes[static_cast<std::size_t>(number)].is_played = true;
        return 0;
    }
    int prepare() override { return wheel.call(); }
    int read(std::vector<AxisEvent>& events, int timeout_ms) override
    {
        if (const int error = wheel.call()) return error;
        using Clock = std::chrono::steady_clock;
        std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
        const std::lock_guard lock(wheel.mutex_);
        const auto now = Clock::now();
        wheel.advance(std::chrono::duration<double>(now - std::exchange(last_, now)).count());
        for (int i = 0; i < wheel.count; ++i) {
            Axis& axis = wheel.axes[static_cast<std::size_t>(i)];
            const int value = value_of(axis.place);
            if (value != std::exchange(axis.told, value)) events.push_back({i, value});
        }
        return 0;
    }

private:
    FakeWheel& wheel;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

int FakeWheel::call()
{
    const auto number = static_cast<int64_t>(calls_++);
    if (!is_plugged) return ENODEV;
    return fails_at >= 0 && number >= fails_at && number - fails_at < fails_for ? EIO : 0;
}

void FakeWheel::advance(double seconds)
{
    for (Axis& axis : axes)
        for (double left_s = std::min(seconds, 0.05); left_s > 0; left_s -= step_s) {
            if (axis.is_held)
                axis.speed = 0;
            else
                axis.speed += step_s * ((axis.is_played ? axis.sign * axis.level : 0) * acceleration_per_s2 -
                                        damping_per_s * axis.speed);
            axis.place = std::clamp(axis.place + step_s * axis.speed, -0.5, 0.5);
        }
}

OpenedInput FakeWheel::open()
{
    if (!is_plugged) return {nullptr, "the wheel is not there", true};
    return {std::make_unique<Port>(*this), "", false};
}

double FakeWheel::level(int axis)
{
    const std::lock_guard lock(mutex_);
    return axes[static_cast<std::size_t>(axis)].level;
}

double FakeWheel::place(int axis)
{
    const std::lock_guard lock(mutex_);
    return axes[static_cast<std::size_t>(axis)].place;
}

void FakeWheel::hold(int axis, bool held)
{
    const std::lock_guard lock(mutex_);
    axes[static_cast<std::size_t>(axis)].is_held = held;
}

void FakeWheel::turn_to(int axis, double place)
{
    const std::lock_guard lock(mutex_);
    axes[static_cast<std::size_t>(axis)].place = place;
}

} // namespace haptel::device
