#include "device/replay_device.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <utility>

namespace haptel::device {

namespace {

struct Steps {
    std::vector<uint64_t> periods; // between each record and the one before it; 1 for the first
    std::string error;
};

// Where a servo missed deadlines, several periods lie between two ticks. One that missed none between at least two
// ticks gives its rate away.
Steps steps_of(const std::vector<runtime::TickRecord>& records, double rate_hz)
{
    Steps steps{{1}, {}};
    double shortest_s = std::numeric_limits<double>::infinity(), periods_sum = 0;
    for (std::size_t i = 1; i < records.size(); ++i) {
        const runtime::TickRecord& before = records[i - 1];
        const runtime::TickRecord& record = records[i];
        const double step_s = record.time_s - before.time_s;
        const double periods = std::round(step_s * rate_hz);
        if (record.tick <= before.tick || !(step_s > 0) || !(periods < 1e15))
            return {{},
                    fmt::format("tick {} at {:.6g} s follows tick {} at {:.6g} s: a trace goes forward in time",
                                record.tick, record.time_s, before.tick, before.time_s)};
        shortest_s = std::min(shortest_s, step_s / static_cast<double>(record.tick - before.tick));
        steps.periods.push_back(static_cast<uint64_t>(periods));
        periods_sum += periods;
    }
    if (records.size() < 2) return steps;
    const double mean_hz = periods_sum / (records.back().time_s - records.front().time_s);
    if (std::abs(mean_hz / rate_hz - 1) < 1e-6 && std::round(shortest_s * rate_hz) == 1) return steps;
    return {{},
            fmt::format("recorded at {:.6g} Hz, but the scene's servo runs at {:.6g} Hz; set rate_hz = {:.6g}",
                        1 / shortest_s, rate_hz, 1 / shortest_s)};
}

// Ticks that nobody read in time, or that were cut out, in words; empty: none.
std::string missing_ticks(const std::filesystem::path& trace, const std::vector<runtime::TickRecord>& records)
{
    const uint64_t count = records.back().tick - records.size() + 1; // ticks count from 0 and only grow
    if (count == 0) return {};
    uint64_t first = 0;
    while (records[first].tick == first) ++first;
    return fmt::format("{}: {} of {} ticks are missing, the first of them tick {}: from there on the forces may differ "
                       "from those that were felt",
                       trace.string(), count, records.back().tick + 1, first);
}

} // namespace

ReplayDevice::ReplayDevice(runtime::DeviceInfo info, std::vector<runtime::DevicePose> poses)
    : info_(std::move(info)), poses_(std::move(poses))
{
}

runtime::DeviceStatus ReplayDevice::read(runtime::DevicePose& pose) noexcept
{
    if (next_ == poses_.size()) return runtime::DeviceStatus::finished;
    pose = poses_[next_++];
    return runtime::DeviceStatus::ok;
}

runtime::DeviceStatus ReplayDevice::write(const glm::dvec3&, const glm::dvec3&) noexcept
{
    return runtime::DeviceStatus::ok;
}

runtime::DeviceResult open_replay(std::string name, const std::filesystem::path& trace, double rate_hz)
{
    return replay_of(std::move(name), trace, runtime::read_trace(trace), rate_hz);
}

runtime::DeviceResult replay_of(std::string name, const std::filesystem::path& trace,
                                const runtime::TraceResult& recorded, double rate_hz)
{
    if (!recorded.error.empty()) return {nullptr, recorded.error};
    const auto& records = recorded.records;
    if (records.empty()) return {nullptr, fmt::format("{}: the trace holds no tick", trace.string())};

    const Steps steps = steps_of(records, rate_hz);
    if (!steps.error.empty()) return {nullptr, fmt::format("{}: {}", trace.string(), steps.error)};

    std::vector<runtime::DevicePose> poses;
    poses.reserve(records.size());
    for (const runtime::TickRecord& record : records) {
        const double sum = glm::dot(record.tip_m, glm::dvec3(1)) + glm::dot(record.tail_m, glm::dvec3(1));
        if (!std::isfinite(sum))
            return {nullptr, fmt::format("{}: the pose of tick {} is not finite", trace.string(), record.tick)};
        if (record.degradation > static_cast<uint32_t>(runtime::Degradation::no_force))
            return {nullptr, fmt::format("{}: column `degraded` of tick {} must be from 0 to 3, found {}",
                                         trace.string(), record.tick, record.degradation)};
        poses.push_back({record.tip_m, record.tail_m, steps.periods[poses.size()], record.interrupted != 0,
                         static_cast<runtime::Degradation>(record.degradation)});
    }
    runtime::DeviceInfo info{std::move(name), records.front().device_force_max_n, 0, 0};
    info.slopes_only = recorded.origin && recorded.origin->device.slopes_only;
    std::string warning = recorded.note;
    if (const std::string missing = missing_ticks(trace, records); !missing.empty())
        warning += (warning.empty() ? "" : "; ") + missing;
    return {std::make_unique<ReplayDevice>(std::move(info), std::move(poses)), {}, std::move(warning)};
}

} // namespace haptel::device
