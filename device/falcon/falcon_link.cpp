#include "device/falcon/falcon_link.h"

#include "device/falcon/ftdi_serial.h"
#include "runtime/servo/real_time.h"

#include <algorithm>
#include <utility>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;
constexpr auto relaxed = std::memory_order_relaxed;

} // namespace

FalconLink::FalconLink(const FalconTimes& times) : times_(times) {}

void FalconLink::command(const FalconCounts& motors) noexcept
{
    const bool replaced = commands_.put({motors, runtime::monotonic_ns(), session()});
    if (replaced) skipped_.fetch_add(1, relaxed);
    wake_.wake();
}

void FalconLink::halt() noexcept
{
    halted_.store(true, std::memory_order_release);
    wake_.wake();
}

void FalconLink::quit() noexcept
{
    quit_.store(true, std::memory_order_release);
    halt();
}

FalconCounters FalconLink::counters() const noexcept
{
    return {sent_.load(relaxed),    replies_count_.load(relaxed), malformed_.load(relaxed),
            skipped_.load(relaxed), out_failed_.load(relaxed),    dropped_.load(relaxed)};
}

void FalconLink::begin_session() noexcept
{
    reader_.reset();
    command_ = {};
    sent_motors_ = {};
    sent_ns_ = 0;
    heard_ns_ = runtime::monotonic_ns();
    session_packets_ = session_replies_ = 0;
    malformed_before_ = reader_.malformed();
    homed_ = false;
    session_.store(++sessions_, std::memory_order_release);
}

void FalconLink::end_session() noexcept
{
    session_.store(0, std::memory_order_release);
}

void FalconLink::received(std::span<const uint8_t> bytes) noexcept
{
    for_each_ftdi_byte(bytes, [&](uint8_t byte) {
        const auto reply = reader_.add(byte);
        if (!reply) return;
        heard_ns_ = runtime::monotonic_ns();
        homed_ = reply->all_homed();
        replies_count_.fetch_add(1, relaxed);
        replies_.put({*reply, heard_ns_, sessions_, link_ns()});
        ++session_replies_;
    });
    malformed_.store(reader_.malformed(), relaxed);
}

// Of the reply that came now: each packet is answered by one, in their order.
int64_t FalconLink::link_ns() const noexcept
{
    const uint64_t answered = session_replies_ + reader_.malformed() - malformed_before_;
    const bool known = answered < session_packets_ && session_packets_ - answered <= packet_ns_.size();
    return known ? heard_ns_ - packet_ns_[answered % packet_ns_.size()] : 0;
}

// What the device should do now.
FalconCommand FalconLink::wanted(int64_t now_ns) noexcept
{
    if (!homed_) return {{}, falcon_homing | falcon_red};
    const bool halted = halted_.load(std::memory_order_acquire);
    const bool servo_is_there =
        command_.session == sessions_ && now_ns - command_.time_ns <= times_.watchdog_ms * ns_per_ms;
    if (halted || !servo_is_there) return {{}, falcon_green};
    return {command_.motors, falcon_blue};
}

std::size_t FalconLink::next_out(std::span<uint8_t> room) noexcept
{
    const bool fresh = commands_.take(command_);
    const int64_t now_ns = runtime::monotonic_ns();
    const FalconCommand command = wanted(now_ns);
    const bool due = fresh || command.motors != sent_motors_ || now_ns - sent_ns_ >= times_.keep_alive_ms * ns_per_ms;
    if (!due || room.size() < falcon_packet_bytes) return 0;
    // The servo learns of it and begins anew from no force, unless it meant to end.
    if (!fresh && command.motors == FalconCounts{} && sent_motors_ != FalconCounts{} && homed_) {
        dropped_.fetch_add(1, relaxed);
        force_dropped_.store(true, std::memory_order_release);
    }
    const FalconPacketBytes bytes = encode(command);
    std::copy(bytes.begin(), bytes.end(), room.begin());
    sent_motors_ = command.motors;
    sent_ns_ = now_ns;
    packet_ns_[session_packets_++ % packet_ns_.size()] = now_ns;
    sent_.fetch_add(1, relaxed);
    return bytes.size();
}

std::size_t FalconLink::last_word(std::span<uint8_t> room) noexcept
{
    const FalconPacketBytes bytes = encode({{}, falcon_green});
    if (room.size() < bytes.size()) return 0;
    std::copy(bytes.begin(), bytes.end(), room.begin());
    return bytes.size();
}

void FalconLink::was_silenced() noexcept
{
    command_ = {}; // of no session
    if (std::exchange(sent_motors_, {}) == FalconCounts{}) return;
    sent_ns_ = 0; // no force is said at once, in case it was not
    dropped_.fetch_add(1, relaxed);
    force_dropped_.store(true, std::memory_order_release);
}

void FalconLink::out_failed() noexcept
{
    out_failed_.fetch_add(1, relaxed);
}

bool FalconLink::wants_more() noexcept
{
    return !quit_.load(std::memory_order_acquire) &&
           runtime::monotonic_ns() - heard_ns_ < times_.silence_ms * ns_per_ms;
}

} // namespace haptel::device
