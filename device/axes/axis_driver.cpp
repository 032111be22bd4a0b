#include "device/axes/axis_driver.h"

#include "runtime/servo/real_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;
// From what a light wheel needs to what a hand that rests on it lets through; a fifth hurts nobody. To and fro, so that
// one at its end moves as well.
constexpr std::array<double, 6> nudges = {0.05, -0.05, 0.1, -0.1, 0.2, -0.2};
// Of the way from end to end: above the noise of a potentiometer's 8 bits.
constexpr double moved_share = 0.01;
// What an axis at rest moves at most in the time that a nudge takes: half of what would count.
constexpr double still_share = moved_share / 2;

double way(const AxisRange& range)
{
    return static_cast<double>(range.maximum) - static_cast<double>(range.minimum);
}

} // namespace

AxisDriver::AxisDriver(OpenAxes open, const AxisTimes& times)
    : open_(std::move(open)), times_(times), thread_([this] { run(); })
{
}

AxisDriver::~AxisDriver()
{
    quit_.store(true, std::memory_order_release);
    wake_.wake();
    thread_.join();
}

void AxisDriver::command(const AxisLevels& shares) noexcept
{
    commands_.put({shares, runtime::monotonic_ns()});
    wake_.wake();
}

void AxisDriver::halt() noexcept
{
    halted_.store(true, std::memory_order_release);
    wake_.wake();
}

std::string AxisDriver::state() const
{
    switch (phase()) {
    case AxisPhase::nudging: return "finding out which way it pushes: let it move";
    case AxisPhase::held: return "it does not move when it is nudged: let go of it, and see that its motor is on";
    case AxisPhase::running: return "connected";
    case AxisPhase::connecting:
    case AxisPhase::disconnected:
    case AxisPhase::failed: break;
    }
    const std::lock_guard lock(why_mutex_);
    return why_;
}

void AxisDriver::enter(AxisPhase phase, std::string why)
{
    {
        const std::lock_guard lock(why_mutex_);
        why_ = std::move(why);
    }
    phase_.store(phase, std::memory_order_release);
}

void AxisDriver::pause(int ms) const
{
    const int64_t until_ns = runtime::monotonic_ns() + ns_per_ms * ms;
    while (!quitting() && runtime::monotonic_ns() < until_ns)
        std::this_thread::sleep_for(std::chrono::milliseconds(std::min(ms, 20)));
}

void AxisDriver::run()
{
    runtime::ask_for_real_time();
    try {
        while (!quitting() && connect()) pause(times_.again_ms);
    } catch (const std::exception& failure) { // no memory
        enter(AxisPhase::failed, failure.what());
    }
}

bool AxisDriver::connect()
{
    OpenedAxes opened = open_();
    const bool there = opened.port != nullptr;
    if (there) {
        begin(*opened.port);
        opened.error = opened.port->serve(wake_, *this);
        opened.port.reset();
    }
    const int64_t now_ns = runtime::monotonic_ns();
    if (std::exchange(runs_, false) || failing_since_ns_ == 0) failing_since_ns_ = now_ns;
    const bool may_come_back = there || opened.absent;
    const bool patient = may_come_back && static_cast<double>(now_ns - failing_since_ns_) < 1e9 * times_.patience_s;
    enter(patient         ? AxisPhase::connecting
          : opened.absent ? AxisPhase::disconnected
                          : AxisPhase::failed,
          std::move(opened.error));
    return patient;
}

void AxisDriver::begin(const AxisPort& port)
{
    count_ = static_cast<std::size_t>(axis_count(port));
    for (std::size_t i = 0; i < count_; ++i) axes_[i] = {*port.axis(static_cast<int>(i)), 0};
    nudge_ = {.since_ns = runtime::monotonic_ns()};
    command_ = {};
    ++session_;
    enter(AxisPhase::nudging, "");
}

void AxisDriver::moved(int axis, int64_t value) noexcept
{
    if (axis < 0 || static_cast<std::size_t>(axis) >= count_) return;
    axes_[static_cast<std::size_t>(axis)].range.value = value;
    if (runs_) publish();
}

double AxisDriver::nudge(Axis& axis, int64_t now_ns) noexcept
{
    const auto value = axis.range.value;
    if (!nudge_.start) nudge_.start = value;
    const double moved =
        value ? (static_cast<double>(*value) - static_cast<double>(*nudge_.start)) / way(axis.range) : 0;
    const int64_t waited_ns = now_ns - nudge_.since_ns;
    if (!nudge_.pushing) {
        // What coasts from the nudge before, or is in a hand's motion, says nothing of this one.
        if (std::fabs(moved) > still_share) nudge_.start = value, nudge_.since_ns = now_ns;
        if (now_ns < nudge_.not_before_ns || now_ns - nudge_.since_ns < ns_per_ms * times_.nudge_ms) return 0;
        nudge_.pushing = true;
        nudge_.since_ns = now_ns;
        nudge_.start = value;
    } else if (std::fabs(moved) > moved_share) {
        axis.sign = moved * nudges[nudge_.number] > 0 ? 1 : -1;
        nudge_ = {.since_ns = now_ns};
        return 0;
    } else if (waited_ns > ns_per_ms * times_.nudge_ms) {
        nudge_.pushing = false;
        nudge_.since_ns = now_ns;
        nudge_.start = value;
        if (++nudge_.number < nudges.size()) return 0;
        nudge_.number = 0;
        nudge_.not_before_ns = now_ns + ns_per_ms * times_.again_ms;
        phase_.store(AxisPhase::held, std::memory_order_release);
        return 0;
    }
    return nudges[nudge_.number];
}

AxisLevels AxisDriver::levels() noexcept
{
    const int64_t now_ns = runtime::monotonic_ns();
    AxisLevels wanted{};
    if (quitting()) return wanted;
    for (std::size_t i = 0; i < count_ && !runs_; ++i) {
        if (axes_[i].sign != 0) continue;
        wanted[i] = halted_.load(std::memory_order_acquire) ? 0 : nudge(axes_[i], now_ns);
        return wanted;
    }
    if (!std::exchange(runs_, true)) {
        publish();
        phase_.store(AxisPhase::running, std::memory_order_release);
    }
    commands_.take(command_);
    const bool silent = now_ns - command_.time_ns > ns_per_ms * times_.watchdog_ms;
    if (silent) was_silenced();
    if (halted_.load(std::memory_order_acquire)) return wanted;
    for (std::size_t i = 0; i < count_; ++i) wanted[i] = axes_[i].sign * command_.shares[i];
    return wanted;
}

void AxisDriver::was_silenced() noexcept
{
    if (std::exchange(command_.shares, {}) == AxisLevels{}) return;
    dropped_.store(true, std::memory_order_release);
}

void AxisDriver::publish() noexcept
{
    AxisReading reading{{}, session_};
    for (std::size_t i = 0; i < count_; ++i) {
        const AxisRange& range = axes_[i].range;
        // known by now: it was seen to move
        const auto value = static_cast<double>(range.value.value_or((range.minimum + range.maximum) / 2));
        reading.place[i] = (value - static_cast<double>(range.minimum)) / way(range) - 0.5;
    }
    readings_.put(reading);
}

} // namespace haptel::device
