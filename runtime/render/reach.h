// Which objects the hand may have come near. An object that is so far away that the hand cannot have got there yet is
// not looked at: neither its contact nor its texture costs anything, so that a tick does not grow with the scene.
//
// Known by the way that the hand has gone, added up: an object at least a gap away sleeps until the way has grown by
// that gap. One heap, ordered by the way at which to wake. Who is then still far away, by the ball around it, sleeps
// on: the hand goes up and down more than away. Objects that are joined are one here (body.h).
//
// One that moves within known bounds (motion.h) is at rest here. The ball holds all the places that it can take. As it
// sees the hand, that makes longer steps than it does: by what it sways, and by what it turns at its own edge, for
// which the ball is larger; by what it turns per metre of gap, for which it does not sleep through the last tenth of
// its gap; and by what it turns per metre of the probe, which is counted as way. So each step is shorter than the gap
// before it, and meets nothing, as at rest.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace haptel::runtime {

// Around an object; a radius without end: it may be anywhere.
struct Surroundings {
    glm::dvec3 centre_m{0};
    double radius_m = 0;
    bool turns = false;
};

// From the hand to there; not above 0 where that is not known.
double gap_m(const Surroundings& around, const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;

// Of who turns, in one tick; who may have turned farther has to be awake.
inline constexpr double turn_max_rad = 0.05;

class Reach {
public:
    // All awake.
    explicit Reach(std::vector<Surroundings> objects);

    // The hand, from tip to tail, has gone so far since the last call. Wakes whoever it may have come nearer to than
    // `near_m`, and may wake others.
    void go(double way_m, const glm::dvec3& tip_m, const glm::dvec3& tail_m, double near_m) noexcept;

    // The object, which is awake, is at least this far from the hand: more than a micrometre.
    void sleep(uint32_t object, double gap_m) noexcept;

    const Surroundings& around(uint32_t object) const noexcept { return objects_[object]; }
    // In rising order, so that what is summed over them does not depend on who slept when.
    const std::vector<uint32_t>& awake() const noexcept { return awake_; }
    std::size_t asleep() const noexcept { return sleepers_.size(); }

private:
    void fall_asleep(uint32_t object, double gap_m) noexcept;
    void wake_all() noexcept;

    using Sleeper = std::pair<double, uint32_t>; // the way at which it wakes; the object

    std::vector<Surroundings> objects_;
    std::vector<Sleeper> sleepers_; // heap: the first to wake in front
    std::vector<uint32_t> awake_;
    double way_m_ = 0;
};

} // namespace haptel::runtime
