// The thread that finds a Falcon, brings it up, streams to it, and does so again when it was unplugged.
#pragma once

#include "device/falcon/falcon_bring_up.h"
#include "device/falcon/falcon_link.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptel::device {

using OpenTransport = std::function<OpenedTransport()>;

struct FalconOptions {
    std::vector<uint8_t> firmware; // empty: it must run its program already
    BringUpLimits bring_up = {};
    FalconTimes times = {};
    int tries = 10;           // to bring it up, before that is a fault
    int again_ms = 500;       // between two tries, and between two looks for a device that is absent
    double patience_s = 60;   // absent for so long, it is disconnected for good
    int pose_age_max_ms = 10; // an older reply is no pose
    bool real_time = true;    // asks the system not to be late
};

enum class FalconPhase : uint8_t { connecting, streaming, disconnected, failed };

class FalconDriver {
public:
    FalconDriver(OpenTransport open, FalconOptions options);
    ~FalconDriver(); // zero force; comes back within a second
    FalconDriver(const FalconDriver&) = delete;
    FalconDriver& operator=(const FalconDriver&) = delete;

    FalconLink& link() noexcept { return link_; }
    const FalconLink& link() const noexcept { return link_; }
    const FalconOptions& options() const noexcept { return options_; }
    FalconPhase phase() const noexcept { return phase_.load(std::memory_order_acquire); }
    // In words, what it does or why it does not. Any thread but the servo's.
    std::string state() const;

private:
    void run();
    bool connect_and_stream(int& failures); // false: there is no use in going on
    UsbError stream(Transport& transport);
    void enter(FalconPhase phase, std::string state);
    void wait_before_next_try();

    OpenTransport open_;
    FalconOptions options_;
    FalconLink link_;
    std::atomic<FalconPhase> phase_{FalconPhase::connecting};
    mutable std::mutex state_mutex_;
    std::string state_ = "connecting";
    int64_t absent_since_ns_ = 0; // 0: it is there
    std::thread thread_;
};

} // namespace haptel::device
