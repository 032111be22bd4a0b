// Which places that a Falcon tells can be believed.
//
// The serial line has no checksum: a bit that flips on the way is a place far away, and a force that throws the hand.
// No hand moves as fast, so such a place counts only if the next reply tells it as well.
#pragma once

#include "device/falcon/falcon_kinematics.h"

#include <cstdint>

namespace haptel::device {

enum class Believed : uint8_t {
    yes,
    after_a_jump, // the hand begins anew there: no force may depend on the place before
    no,           // the place before is kept, until it is too old
};

class FalconPlaceFilter {
public:
    Believed add(const glm::dvec3& place_m, int64_t time_ns) noexcept
    {
        if (has_place_ && is_too_far(place_m_, place_m, time_ns - time_ns_)) {
            const bool confirmed = is_doubtful_ && !is_too_far(doubtful_m_, place_m, time_ns - doubtful_ns_);
            is_doubtful_ = !confirmed;
            doubtful_m_ = place_m;
            doubtful_ns_ = time_ns;
            if (!confirmed) return Believed::no;
            keep(place_m, time_ns);
            return Believed::after_a_jump;
        }
        keep(place_m, time_ns);
        return Believed::yes;
    }
    // The next place is the first.
    void forget() noexcept { has_place_ = is_doubtful_ = false; }

    bool has_place() const noexcept { return has_place_; }
    const glm::dvec3& place_m() const noexcept { return place_m_; }
    int64_t time_ns() const noexcept { return time_ns_; }

private:
    static constexpr double jump_m = 0.003, hand_speed_limit_m_per_s = 5;

    static bool is_too_far(const glm::dvec3& from_m, const glm::dvec3& to_m, int64_t elapsed_ns) noexcept
    {
        return glm::distance(from_m, to_m) > jump_m + hand_speed_limit_m_per_s * 1e-9 * static_cast<double>(elapsed_ns);
    }
    void keep(const glm::dvec3& place_m, int64_t time_ns) noexcept
    {
        place_m_ = place_m;
        time_ns_ = time_ns;
        has_place_ = true;
        is_doubtful_ = false;
    }

    glm::dvec3 place_m_ = falcon_centre_m, doubtful_m_{0};
    int64_t time_ns_ = 0, doubtful_ns_ = 0;
    bool has_place_ = false, is_doubtful_ = false;
};

} // namespace haptel::device
