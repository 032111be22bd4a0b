// What the servo tells the rest of the program: one record per tick through a ring that never makes it wait.
//
// One servo writes, one reader reads; when the reader is too slow, records are dropped and counted, never waited for.
#pragma once

#include <glm/glm.hpp>

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptel::runtime {

// One tick as it was felt. World frame, SI.
struct TickRecord {
    uint64_t tick = 0; // without gaps: what is missing was dropped on the way to the reader
    double time_s = 0; // periods since the first pose times the period; steps over those without a pose
    glm::dvec3 tip_m{0}, tail_m{0};
    glm::dvec3 force_n{0};         // as sent to the device, after all limits
    glm::dvec3 torque_n_m{0};      // the same, about the grip
    double grip_force_n = 0;       // the same: what pushes a gripper's fingers apart
    uint32_t contact = 0;          // number of objects touched
    double depth_m = 0;            // below the base surface, of the deepest object touched
    double height_m = 0;           // of its texture, as published (not shifted to the envelope)
    uint32_t object = 0;           // which one that is: its number in the scene, from 1; 0: none
    uint64_t compute_ns = 0;       // pose in hand to force computed
    uint64_t woken_ns = 0;         // by the system's monotonic clock, for the tick; 0: on the virtual clock
    uint64_t wake_late_ns = 0;     // after the tick's deadline the system woke the servo; 0: in time, or no deadlines
    uint64_t binding = 0;          // serial of the texture that is felt, or that is being faded in
    uint32_t faults = 0;           // bits of TickResult::faults
    double device_force_max_n = 0; // what the motors can do: a limit of force_n; 0: unknown
    uint32_t degradation = 0;      // what was left out because deadlines were missed (Degradation)
    uint32_t waiting = 0;          // 1: no force yet, the one computed is not small
    uint32_t interrupted = 0;      // 1: no force was on the hand since the tick before, and it rises anew
};

// Lock-free ring of one writer and one reader.
template <typename Record>
class SpscRing {
public:
    explicit SpscRing(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {}

    // Writer only. False: full, and the record is counted as dropped.
    bool push(const Record& record) noexcept
    {
        const uint64_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        slots_[head & mask_] = record;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    // Reader only. False: nothing there.
    bool pop(Record& record) noexcept
    {
        const uint64_t tail = tail_.load(std::memory_order_relaxed);
        if (tail == head_.load(std::memory_order_acquire)) return false;
        record = slots_[tail & mask_];
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    bool full() const noexcept
    {
        return head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire) == slots_.size();
    }
    std::size_t capacity() const noexcept { return slots_.size(); }
    uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    std::vector<Record> slots_;
    uint64_t mask_;
    alignas(64) std::atomic<uint64_t> head_{0};
    alignas(64) std::atomic<uint64_t> tail_{0};
    std::atomic<uint64_t> dropped_{0};
};

using Telemetry = SpscRing<TickRecord>;

} // namespace haptel::runtime
