#include "device/replay_device.h"

#include "runtime/recording.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace haptel::device {

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

runtime::DeviceResult open_replay(runtime::DeviceInfo info, const std::filesystem::path& trace, double rate_hz)
{
    const runtime::TraceResult recorded = runtime::read_trace(trace);
    if (!recorded.error.empty()) return {nullptr, recorded.error};
    const auto& records = recorded.records;
    if (records.empty()) return {nullptr, fmt::format("{}: the trace holds no tick", trace.string())};

    if (records.size() > 1) {
        const double ticks = static_cast<double>(records.back().tick) - static_cast<double>(records.front().tick);
        const double recorded_hz = ticks / (records.back().time_s - records.front().time_s);
        if (!(std::abs(recorded_hz / rate_hz - 1) < 1e-6))
            return {
                nullptr,
                fmt::format("{}: recorded at {:.6g} Hz, but the scene's servo runs at {:.6g} Hz; set rate_hz = {:.6g}",
                            trace.string(), recorded_hz, rate_hz, recorded_hz)};
    }

    std::vector<runtime::DevicePose> poses;
    poses.reserve(records.size());
    for (const runtime::TickRecord& record : records) {
        const double sum = glm::dot(record.tip_m, glm::dvec3(1)) + glm::dot(record.tail_m, glm::dvec3(1));
        if (!std::isfinite(sum))
            return {nullptr, fmt::format("{}: the pose of tick {} is not finite", trace.string(), record.tick)};
        poses.push_back({record.tip_m, record.tail_m});
    }
    return {std::make_unique<ReplayDevice>(std::move(info), std::move(poses)), {}};
}

} // namespace haptel::device
