// Where the hand was of late: so that how fast it went in the space of an object that moves can be told when that is
// first touched (HandVelocity), and nobody has to ask for the object before.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace haptel::runtime {

class HandHistory {
public:
    struct Entry {
        uint64_t period = 0;  // its number
        uint64_t periods = 1; // since the entry before
        glm::dvec3 tip_m{0}, tail_m{0};
    };

    // So far back that a low-pass has forgotten what was before, but for 1e-7. Where that are more periods than there
    // are entries, these are several periods apart.
    explicit HandHistory(double period_s) noexcept;

    void add(uint64_t period, const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;
    void lose_hand() noexcept { count_ = 0, now_ = {}; }

    // From the oldest to that of the last tick; the first has nothing before it.
    template <class Visit>
    void each(Visit&& visit) const
    {
        for (std::size_t i = count_ - std::min(count_, entries_.size()); i < count_; ++i)
            visit(entries_[i % entries_.size()]);
        if (count_ > 0 && now_.period != newest().period) visit(now_);
    }

private:
    const Entry& newest() const noexcept { return entries_[(count_ - 1) % entries_.size()]; }

    uint64_t apart_;
    std::size_t count_ = 0; // entered in all
    std::array<Entry, 64> entries_;
    Entry now_;
};

} // namespace haptel::runtime
