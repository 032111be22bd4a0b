// Between the servo, which may not wait, and the stream of USB transfers: the newest command one way, the newest reply
// the other way.
//
// The motors hold the last command for as long as they hear no other, so the link says zero itself whenever no servo
// stands behind the force: before the arms are homed, after halt(), and when the servo has been silent for too long.
#pragma once

#include "device/falcon/falcon_packet.h"
#include "device/usb/newest.h"
#include "device/usb/transport.h"

#include <array>
#include <atomic>
#include <cstdint>

namespace haptel::device {

struct FalconTimes {
    int keep_alive_ms = 3; // without a command the last one is sent again: the device answers only when asked
    int watchdog_ms = 20;  // without a command the force is taken away
    int silence_ms = 1000; // without a reply the stream is given up
};

// Since the link was made.
struct FalconCounters {
    uint64_t sent = 0;       // packets
    uint64_t replies = 0;    // whole packets
    uint64_t malformed = 0;  // packets that began and were broken
    uint64_t skipped = 0;    // commands replaced by the next before they were sent
    uint64_t out_failed = 0; // transfers to the device that were late or cut off
    uint64_t dropped = 0;    // forces that the watchdog took away
};

class FalconLink final : public StreamClient {
public:
    struct Reading {
        FalconReply reply;
        int64_t time_ns = 0;  // of its arrival, CLOCK_MONOTONIC
        uint32_t session = 0; // of the stream that it came by
        int64_t link_ns = 0;  // since the packet that it answers was sent; 0: not known
    };

    explicit FalconLink(const FalconTimes& times);

    // The servo's thread: nothing of this allocates, locks or waits.
    bool newest(Reading& reading) noexcept { return replies_.take(reading); }
    void command(const FalconCounts& motors) noexcept;
    uint32_t session() const noexcept { return session_.load(std::memory_order_acquire); } // 0: no stream
    // Whether the watchdog took a force away since the last call.
    bool force_was_dropped() noexcept { return force_dropped_.exchange(false, std::memory_order_acq_rel); }

    // Any thread: zero force from now on, for good. quit() ends the stream as well.
    void halt() noexcept;
    void quit() noexcept;
    const std::atomic<bool>& quitting() const noexcept { return quit_; }
    FalconCounters counters() const noexcept;

    // The driver's thread.
    void begin_session() noexcept;
    void end_session() noexcept;
    uint64_t replies_of_session() const noexcept { return session_replies_; }
    WakeEvent& wake_event() noexcept { return wake_; }

    void received(std::span<const uint8_t> bytes) noexcept override;
    std::size_t next_out(std::span<uint8_t> room) noexcept override;
    void out_failed() noexcept override;
    bool wants_more() noexcept override;
    std::size_t last_word(std::span<uint8_t> room) noexcept override;
    void was_silenced() noexcept override;

private:
    struct Command {
        FalconCounts motors{};
        int64_t time_ns = 0;
        uint32_t session = 0;
    };

    FalconCommand wanted(int64_t now_ns) noexcept;
    int64_t link_ns() const noexcept;

    FalconTimes times_;
    Newest<Command> commands_;
    Newest<Reading> replies_;
    WakeEvent wake_;
    std::atomic<bool> halted_{false}, quit_{false}, force_dropped_{false};
    std::atomic<uint32_t> session_{0};
    std::atomic<uint64_t> sent_{0}, replies_count_{0}, malformed_{0}, skipped_{0}, out_failed_{0}, dropped_{0};

    // The driver's thread alone.
    FalconReplyReader reader_;
    Command command_;
    FalconCounts sent_motors_{};
    int64_t sent_ns_ = 0, heard_ns_ = 0;
    uint64_t session_packets_ = 0, session_replies_ = 0, malformed_before_ = 0; // of this session, and before it
    std::array<int64_t, 16> packet_ns_{}; // when the last of them were sent: 16 ms of them, or replies are lost
    uint32_t sessions_ = 0;
    bool homed_ = false;
};

} // namespace haptel::device
