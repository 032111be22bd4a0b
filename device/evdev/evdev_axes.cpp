#include "device/evdev/evdev_axes.h"

#include "device/guard/force_guard.h"
#include "runtime/servo/real_time.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;

class EvdevAxes final : public AxisPort {
public:
    EvdevAxes(std::unique_ptr<InputPort> port, const EvdevTimes& times) : port_(std::move(port)), times_(times) {}

    std::optional<AxisRange> axis(int number) const override { return port_->axis(number); }

    std::string serve(WakeEvent& wake, AxisClient& client) override
    {
        const int count = axis_count(*this);
        int error = port_->prepare();
        for (int i = 0; i < count && error == 0; ++i) {
            error = set(i, 0);
            if (error == 0) error = port_->play(i);
        }
        if (error == 0) error = keep_levels(wake, client, count);
        for (int i = 0; i < count; ++i) port_->set_level(i, 0); // the motors hold what they heard last
        return error == 0 ? "" : std::string("the device was lost: ") + std::strerror(error);
    }

private:
    int set(int axis, double level)
    {
        const int error = port_->set_level(axis, level);
        if (error == 0) sent_[static_cast<std::size_t>(axis)] = level;
        return error;
    }

    int keep_levels(WakeEvent& wake, AxisClient& client, int count)
    {
        ForceGuard guard(port_->file_descriptor(), 0, port_->last_word());
        int64_t update_ns = runtime::monotonic_ns(), replay_ns = update_ns;
        std::vector<AxisEvent> events;
        while (client.wants_more()) {
            const int64_t left_ns = update_ns - runtime::monotonic_ns();
            events.clear();
            if (const int error = port_->read(events, static_cast<int>(std::clamp<int64_t>(
                                                          (left_ns + ns_per_ms - 1) / ns_per_ms, 0, guard_hears_ms))))
                return error;
            if (guard.hear()) {
                client.was_silenced();
                replay_ns -= ns_per_ms * times_.replay_ms; // the effects may have been ended
            }
            for (const AxisEvent& event : events) client.moved(event.axis, event.value);
            const int64_t now_ns = runtime::monotonic_ns();
            if (now_ns < update_ns) continue;
            update_ns = std::max(update_ns + ns_per_ms * times_.update_ms, now_ns);
            wake.clear();
            const AxisLevels wanted = client.levels();
            const bool again = now_ns - replay_ns > ns_per_ms * times_.replay_ms;
            if (again) replay_ns = now_ns;
            for (int i = 0; i < count; ++i) {
                const auto at = static_cast<std::size_t>(i);
                // only the level: a report to the device, where playing it anew would be two
                int error = wanted[at] != sent_[at] ? set(i, wanted[at]) : 0;
                if (error == 0 && again) error = port_->play(i);
                if (error != 0) return error;
            }
        }
        return 0;
    }

    std::unique_ptr<InputPort> port_;
    EvdevTimes times_;
    AxisLevels sent_{};
};

} // namespace

OpenedAxes evdev_axes(OpenedInput opened, const EvdevTimes& times)
{
    if (!opened.port) return {nullptr, std::move(opened.error), opened.absent};
    return {std::make_unique<EvdevAxes>(std::move(opened.port), times), "", false};
}

} // namespace haptel::device
