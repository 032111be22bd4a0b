// Objects that move: where one is at any time of the run. The proxy lives in object space, so that an object that moves
// meets a hand at rest as a hand that moves meets an object at rest: by the same swept path, and nothing slips through.
#pragma once

#include "runtime/geometry/placement.h"

#include <glm/glm.hpp>

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

namespace haptel::runtime {

// Where an object stays whatever the time, in the scene's space, and how it goes to and fro there.
struct MotionBounds {
    glm::dvec3 centre_m{0};
    double radius_m = 0; // no point of the object leaves this ball
    // Between two times a place at rest that is d from the centre moves, as the object sees it, by no more than
    // sway_m + turn_rad_per_s * seconds * (d + radius_m).
    double sway_m = 0, turn_rad_per_s = 0;
};

// Asked by servo threads, several if there are several devices, once per tick: allocates, locks and throws nothing. One
// that tells its bounds is asked less often, and for times that have passed.
class Motion {
public:
    virtual ~Motion() = default;
    // Nothing: the object stays where it was.
    virtual std::optional<Placement> at(double time_s) const noexcept = 0;
    // Of an object that is within the ball in its own space. Only a function of time alone has any; an object with them
    // costs a tick nothing while the hand is far away (sleep_queue.h). Nothing: not known.
    virtual std::optional<MotionBounds> bounds(const glm::dvec3& /*centre_m*/, double /*radius_m*/) const noexcept
    {
        return std::nullopt;
    }
    // No point of the object that far from its origin goes faster: textures have no finer detail than a tick passes. 0:
    // not known, and not counted.
    virtual double speed_max_m_per_s(double /*radius_m*/) const noexcept { return 0; }
    // Why a servo of that rate may not follow it, in words; empty: it may. Not asked by a servo thread.
    virtual std::string fault(double /*rate_hz*/) const { return {}; }
};

// Turns about an axis through the object's origin while its origin swings along a line: what a scene file can say.
// A function of time alone, so that runs can be repeated bit for bit.
class SteadyMotion final : public Motion {
public:
    struct Figures {
        glm::dvec3 axis{0, 0, 1};  // not 0; any length
        double spin_rad_per_s = 0; // about it, right-handed
        glm::dvec3 swing_m{0};     // amplitude: from the start to the farthest point
        double swing_hz = 0;       // begins from the start, toward +swing_m
    };
    SteadyMotion(const Placement& start, const Figures& figures);
    std::optional<Placement> at(double time_s) const noexcept override;
    std::optional<MotionBounds> bounds(const glm::dvec3& centre_m, double radius_m) const noexcept override;
    double speed_max_m_per_s(double radius_m) const noexcept override;
    std::string fault(double rate_hz) const override;

private:
    Placement start_;
    Figures figures_;
};

// A pose that an application sets whenever it likes, such as that of a simulated body. One writer at a time. The object
// goes straight from pose to pose and takes along what is in its way: one that is to be elsewhere, and meet nothing on
// its way there, comes with another scene (ServoThread::publish).
class LivePlacement final : public Motion {
public:
    explicit LivePlacement(const Placement& start);

    // Any thread but a servo. Returns why the placement is refused, with the object left where it is, or nothing.
    std::string publish(const Placement& placement);

    // While a writer is at work, as seen twice, the object stays where it was for one more tick.
    std::optional<Placement> at(double time_s) const noexcept override;

private:
    void store(const Placement& placement) noexcept;

    static constexpr int numbers = 12;
    std::atomic<uint64_t> version_{0}; // odd while it is written
    std::atomic<double> values_[numbers];
};

} // namespace haptel::runtime
