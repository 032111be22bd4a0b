// Which objects the hand may have come near. An object that is so far away that the hand cannot have got there yet is
// not looked at: neither its contact nor its texture costs anything, so that a tick does not grow with the scene.
//
// Known by the way that the hand has gone, added up: an object at least a gap away sleeps until the way has grown by
// that gap. Who is then still far away, by the ball around it, sleeps on: the hand goes up and down more than away.
// Objects that are joined are one here (body.h).
//
// Who is far away sleeps in groups: the leaves of a tree of balls, each around two below it. A group wakes as an object
// does, and only while the hand is near its ball do the two groups in it sleep by themselves: once it has left, they
// are one again. So what a tick compares grows with those near the hand and with the depth of the tree, also after the
// hand has been everywhere. The way is counted in whole units round the circle of 64 bits, so that it loses no digits
// however far the hand goes.
//
// One that moves within known bounds (motion.h) is at rest here. The ball holds all the places that it can take. As it
// sees the hand, that makes longer steps than it does: by what it sways, and by what it turns at its own edge, for
// which the ball is larger; by what it turns per metre of gap, for which it does not sleep through the last tenth of
// its gap; and by what it turns per metre of the probe, which is counted as way. So each step is shorter than the gap
// before it, and meets nothing, as at rest.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptel::runtime {

// Around an object; an infinite radius: it may be anywhere.
struct BoundingSphere {
    glm::dvec3 centre_m{0};
    double radius_m = 0;
    bool turns = false;
};

// The distance from the probe, tip to tail, to the sphere, in metres; 0 or less if they meet or if that is not known.
double gap_m(const BoundingSphere& around, const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;

// The distance, in metres, beyond which an object may sleep when the hand moved `way_m` in this tick: the hand needs
// several ticks to come near it, and the rounding of coordinates is small beside it.
double far_enough_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m, double way_m) noexcept;

// Of who turns, in one tick; who may have turned farther has to be awake.
inline constexpr double turn_max_rad = 0.05;

class SleepQueue {
public:
    // Who may be anywhere is awake; all others sleep until the first call of go(). Not `leaves_alone`: all are awake,
    // and nobody is to be put to sleep.
    explicit SleepQueue(std::vector<BoundingSphere> objects, bool leaves_alone = true);

    // The hand, from tip to tail, has gone so far since the last call. Wakes whoever it may have come nearer to than
    // `near_m`, and may wake others.
    void go(double way_m, const glm::dvec3& tip_m, const glm::dvec3& tail_m, double near_m) noexcept;
    // Who turns may have turned farther than turn_max_rad since the last call of go().
    void wake_who_turns() noexcept;

    // The object, which is awake, is at least this far from the hand: more than a micrometre.
    void sleep(uint32_t object, double gap_m) noexcept;

    const BoundingSphere& around(uint32_t object) const noexcept { return spheres_[object]; }
    // In rising order, so that what is summed over them does not depend on who slept when.
    const std::vector<uint32_t>& awake() const noexcept { return awake_; }
    // Balls that were compared with the hand since the start, those of groups included.
    uint64_t compared() const noexcept { return compared_; }

private:
    static constexpr uint32_t none = ~uint32_t{0};

    // Each in a tree of its own: who turns has to be awake apart, and a group with who may be anywhere may be anywhere.
    enum : uint32_t { at_rest, turning, anywhere, kinds };

    // An object, or behind them a group of two.
    struct Node {
        uint64_t at;            // the way at which it is looked at: of a parted group the first in it
        uint64_t far_from = 0;  // of a parted group: before, the hand cannot be far from it again
        uint32_t parent = none; // of a root
        uint32_t first = none, second = none;
        uint32_t awake = 0;  // objects in it
        bool parted = false; // those in it sleep by themselves
    };
    struct Probe {
        const glm::dvec3 &tip_m, &tail_m;
        double near_m;
    };

    uint32_t group(std::span<uint32_t> objects);
    bool is_group(uint32_t node) const noexcept { return node >= object_count_; }
    bool is_due(uint64_t at) const noexcept { return static_cast<int64_t>(at - way_) <= 0; }
    void look_at(uint32_t node, bool anew, const Probe& probe) noexcept;
    void sleep_for(uint32_t node, double gap_m) noexcept;
    void wake(uint32_t object) noexcept;
    void wake_all(uint32_t node) noexcept;
    void sum_up(uint32_t group) noexcept;

    std::size_t object_count_;
    std::vector<BoundingSphere> spheres_; // of the nodes
    std::vector<Node> nodes_;
    std::array<uint32_t, kinds> root_{none, none, none};
    std::vector<uint32_t> awake_;
    uint64_t way_;
    uint64_t compared_ = 0;
};

} // namespace haptel::runtime
