// Where the nanoseconds went: a histogram of fixed size that the servo can fill without allocating.
//
// Log-linear: every power of two is cut into 32 equal buckets, so a percentile is within 3.2 % of the true one over
// the whole range of uint64_t, at 15 KiB. The largest value is kept exactly.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace haptel::runtime {

class Histogram {
public:
    void add(uint64_t value) noexcept
    {
        ++buckets_[bucket(value)];
        ++count_;
        if (value > maximum_) maximum_ = value;
    }

    uint64_t count() const noexcept { return count_; }
    uint64_t maximum() const noexcept { return maximum_; }

    // The smallest bucket bound that at least `fraction` (0 .. 1) of the values do not exceed; 0 when empty.
    uint64_t percentile(double fraction) const noexcept
    {
        if (count_ == 0) return 0;
        const double wanted = std::ceil(fraction * static_cast<double>(count_));
        uint64_t seen = 0;
        for (std::size_t i = 0; i < buckets_.size(); ++i) {
            seen += buckets_[i];
            if (seen > 0 && static_cast<double>(seen) >= wanted) {
                const uint64_t bound = last_in_bucket(i);
                return bound < maximum_ ? bound : maximum_;
            }
        }
        return maximum_;
    }

    // Calls visit(first, last, count) for every bucket that holds something, in rising order: for plots.
    template <typename Visit>
    void for_each(Visit&& visit) const
    {
        for (std::size_t i = 0; i < buckets_.size(); ++i)
            if (buckets_[i] != 0)
                visit(i == 0 ? uint64_t{0} : last_in_bucket(i - 1) + 1, last_in_bucket(i), buckets_[i]);
    }

private:
    static constexpr unsigned cut_bits = 5; // 32 buckets for each power of two
    static constexpr uint64_t cuts = uint64_t{1} << cut_bits;

    static std::size_t bucket(uint64_t value) noexcept
    {
        if (value < cuts) return static_cast<std::size_t>(value);
        const unsigned shift = static_cast<unsigned>(std::bit_width(value)) - 1 - cut_bits;
        return static_cast<std::size_t>((uint64_t{shift} << cut_bits) + (value >> shift));
    }

    static uint64_t last_in_bucket(std::size_t index) noexcept
    {
        if (index < cuts) return index;
        const uint64_t shift = (index >> cut_bits) - 1;
        const uint64_t leading = index - (shift << cut_bits); // cuts .. 2 cuts - 1
        return ((leading + 1) << shift) - 1;                  // wraps to the largest value in the last bucket
    }

    std::array<uint64_t, (64 - cut_bits + 1) * cuts> buckets_{};
    uint64_t count_ = 0;
    uint64_t maximum_ = 0;
};

} // namespace haptel::runtime
