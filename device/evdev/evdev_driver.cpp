#include "device/evdev/evdev_driver.h"

#include "runtime/servo/real_time.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;
// From what a light wheel needs to what a hand that rests on it lets through; a fifth hurts nobody.
constexpr std::array<double, 3> nudges = {0.05, 0.1, 0.2};
// Of the way from end to end: above the noise of a potentiometer's 8 bits.
constexpr double moved_share = 0.01;

} // namespace

EvdevDriver::EvdevDriver(OpenInput open, const EvdevTimes& times)
    : open_(std::move(open)), times_(times), thread_([this] { run(); })
{
}

EvdevDriver::~EvdevDriver()
{
    quit_.store(true, std::memory_order_release);
    thread_.join();
}

void EvdevDriver::command(const std::array<double, 2>& shares) noexcept
{
    commands_.put({shares, runtime::monotonic_ns()});
}

std::string EvdevDriver::state() const
{
    const std::lock_guard lock(state_mutex_);
    return state_;
}

void EvdevDriver::enter(EvdevPhase phase, std::string state)
{
    {
        const std::lock_guard lock(state_mutex_);
        state_ = std::move(state);
    }
    phase_.store(phase, std::memory_order_release);
}

void EvdevDriver::pause(int ms) const
{
    const int64_t until_ns = runtime::monotonic_ns() + ns_per_ms * ms;
    while (!quitting() && runtime::monotonic_ns() < until_ns)
        std::this_thread::sleep_for(std::chrono::milliseconds(std::min(ms, 20)));
}

void EvdevDriver::run()
{
    runtime::ask_for_real_time();
    int64_t absent_since_ns = 0;
    try {
        while (!quitting() && connect(absent_since_ns)) pause(times_.again_ms);
    } catch (const std::exception& failure) { // no memory
        enter(EvdevPhase::failed, failure.what());
    }
}

bool EvdevDriver::connect(int64_t& absent_since_ns)
{
    OpenedInput opened = open_();
    if (opened.port) {
        absent_since_ns = 0;
        const int error = serve(*opened.port);
        enter(EvdevPhase::connecting, std::string("the device was lost: ") + std::strerror(error));
        return true;
    }
    const int64_t now_ns = runtime::monotonic_ns();
    if (absent_since_ns == 0) absent_since_ns = now_ns;
    const bool patient = opened.absent && static_cast<double>(now_ns - absent_since_ns) < 1e9 * times_.patience_s;
    enter(patient         ? EvdevPhase::connecting
          : opened.absent ? EvdevPhase::disconnected
                          : EvdevPhase::failed,
          opened.error);
    return patient;
}

int EvdevDriver::serve(InputPort& port)
{
    count_ = 0;
    for (int i = 0; i < 2; ++i)
        if (const auto range = port.axis(i)) {
            axes_[static_cast<std::size_t>(i)] = {*range, 0, 0, static_cast<double>(range->value)};
            count_ = i + 1;
        }
    if (const int error = port.prepare()) return error;
    for (int i = 0; i < count_; ++i) {
        Axis& axis = axes_[static_cast<std::size_t>(i)];
        enter(EvdevPhase::nudging, "finding out which way it pushes: let it move");
        while (axis.sign == 0 && !quitting()) {
            if (const int error = nudge(port, axis, i)) return error;
            if (axis.sign != 0) break;
            enter(EvdevPhase::nudging,
                  "it does not move when it is nudged: let go of it, and see that its motor is on");
            pause(times_.again_ms);
        }
    }
    ++session_;
    publish();
    enter(EvdevPhase::running, "connected");
    const int error = quitting() ? 0 : keep_forces(port);
    for (int i = 0; i < count_; ++i) send(port, i, 0); // the motors hold what they heard last
    return error;
}

// A hand that goes on moving it keeps it waiting, and without a force.
int EvdevDriver::come_to_rest(InputPort& port, const Axis& axis)
{
    const double threshold = moved_share / 4 * (axis.range.maximum - axis.range.minimum);
    double stands_at = axis.value;
    int64_t since_ns = runtime::monotonic_ns();
    while (!quitting() && runtime::monotonic_ns() - since_ns < ns_per_ms * times_.nudge_ms) {
        if (const int error = listen(port, times_.update_ms)) return error;
        if (std::fabs(axis.value - stands_at) <= threshold) continue;
        stands_at = axis.value;
        since_ns = runtime::monotonic_ns();
    }
    return 0;
}

int EvdevDriver::nudge(InputPort& port, Axis& axis, int number)
{
    const double threshold = moved_share * (axis.range.maximum - axis.range.minimum);
    for (const double share : nudges)
        // to and fro, so that one at its end moves as well
        for (const double sign : {1.0, -1.0}) {
            int error = come_to_rest(port, axis);
            const double start = axis.value;
            if (error == 0) error = send(port, number, sign * share);
            const int64_t until_ns = runtime::monotonic_ns() + ns_per_ms * times_.nudge_ms;
            while (error == 0 && !quitting() && runtime::monotonic_ns() < until_ns &&
                   std::fabs(axis.value - start) <= threshold)
                error = listen(port, times_.update_ms);
            const double moved = axis.value - start;
            if (error == 0) error = send(port, number, 0);
            if (error != 0) return error;
            if (std::fabs(moved) <= threshold) continue;
            axis.sign = sign * moved > 0 ? 1 : -1;
            return 0;
        }
    return 0;
}

// A level that pushes in the sense of the port, played.
int EvdevDriver::send(InputPort& port, int number, double level)
{
    Axis& axis = axes_[static_cast<std::size_t>(number)];
    const int error = port.set_level(number, level);
    if (error != 0) return error;
    axis.sent = level;
    return port.play(number);
}

int EvdevDriver::listen(InputPort& port, int timeout_ms)
{
    events_.clear();
    if (const int error = port.read(events_, timeout_ms)) return error;
    for (const AxisEvent& event : events_)
        if (event.axis < count_) axes_[static_cast<std::size_t>(event.axis)].value = event.value;
    return 0;
}

void EvdevDriver::publish() noexcept
{
    EvdevReading reading{{}, session_};
    for (int i = 0; i < count_; ++i) {
        const Axis& axis = axes_[static_cast<std::size_t>(i)];
        reading.place[static_cast<std::size_t>(i)] =
            (axis.value - axis.range.minimum) / (axis.range.maximum - axis.range.minimum) - 0.5;
    }
    readings_.put(reading);
}

int EvdevDriver::keep_forces(InputPort& port)
{
    int64_t update_ns = runtime::monotonic_ns(), replay_ns = update_ns;
    while (!quitting()) {
        const int64_t left_ns = update_ns - runtime::monotonic_ns();
        const int wait_ms = static_cast<int>(std::clamp<int64_t>((left_ns + ns_per_ms - 1) / ns_per_ms, 0, 100));
        if (const int error = listen(port, wait_ms)) return error;
        if (!events_.empty()) publish();
        const int64_t now_ns = runtime::monotonic_ns();
        if (now_ns < update_ns) continue;
        update_ns = std::max(update_ns + ns_per_ms * times_.update_ms, now_ns);
        commands_.take(command_);
        const bool silent = now_ns - command_.time_ns > ns_per_ms * times_.watchdog_ms;
        const bool pushes = command_.shares != std::array<double, 2>{};
        if (silent && pushes) {
            command_.shares = {};
            dropped_.store(true, std::memory_order_release);
        }
        const bool none = silent || halted_.load(std::memory_order_acquire);
        const bool again = now_ns - replay_ns > ns_per_ms * times_.replay_ms;
        if (again) replay_ns = now_ns;
        for (int i = 0; i < count_; ++i) {
            const Axis& axis = axes_[static_cast<std::size_t>(i)];
            const double level = none ? 0 : axis.sign * command_.shares[static_cast<std::size_t>(i)];
            // only the level: a report to the device, where playing it anew would be two
            if (level != axis.sent) {
                if (const int error = port.set_level(i, level)) return error;
                axes_[static_cast<std::size_t>(i)].sent = level;
            }
            if (again)
                if (const int error = port.play(i)) return error;
        }
    }
    return 0;
}

} // namespace haptel::device
