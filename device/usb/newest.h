// Hands the newest value from one thread to another without a lock: what is not taken is replaced.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace haptel::device {

// One thread puts, one takes; neither waits. Three places: one being written, one being read, one in between.
template <typename T>
class Newest {
public:
    // True if the value before had not been taken: it is lost.
    bool put(const T& value) noexcept
    {
        places_[writing_] = value;
        const uint32_t before = between_.exchange(writing_ | fresh, std::memory_order_acq_rel);
        writing_ = before & ~fresh;
        return before & fresh;
    }

    // False, and `value` as it was, if nothing was put since.
    bool take(T& value) noexcept
    {
        if (!(between_.load(std::memory_order_relaxed) & fresh)) return false;
        reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & ~fresh;
        value = places_[reading_];
        return true;
    }

private:
    static constexpr uint32_t fresh = 4;
    std::array<T, 3> places_{};
    uint32_t writing_ = 0, reading_ = 1;
    std::atomic<uint32_t> between_{2};
};

} // namespace haptel::device
