// A recorded hand: gives the poses of a trace one by one, whatever force it is sent, and then has finished.
//
// What is computed from equal poses is equal: a run on the same scene repeats the recorded forces bit for bit, those
// after missed deadlines and interruptions included.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "runtime/servo/recording.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace haptel::device {

class ReplayDevice final : public runtime::HapticDevice {
public:
    ReplayDevice(runtime::DeviceInfo info, std::vector<runtime::DevicePose> poses);

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override; // finished: `pose` is left as it was
    runtime::DeviceStatus write(const glm::dvec3&, const glm::dvec3&) noexcept override;
    void stop() noexcept override {}

private:
    runtime::DeviceInfo info_;
    std::vector<runtime::DevicePose> poses_;
    std::size_t next_ = 0;
};

// Reads a recording or a trace.csv. An error if the file is none or is damaged, is empty, holds a pose that is not
// finite or was recorded at another rate than `rate_hz`; a warning if ticks are missing in it or it was cut. The device
// can do what the recorded one could.
runtime::DeviceResult open_replay(std::string name, const std::filesystem::path& trace, double rate_hz);

// The same of a file that was read already.
runtime::DeviceResult replay_of(std::string name, const std::filesystem::path& trace,
                                const runtime::TraceResult& recorded, double rate_hz);

} // namespace haptel::device
