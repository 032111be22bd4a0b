// What is felt beside contact: pull of surfaces, viscous media, vibrations. After contact and before the limits.
//
// A scene without effects pays one branch a tick; an object without them, one. What acts at a distance keeps its object
// from falling asleep (sleep_queue.h) only within that distance. The file of each effect says what it does with energy.
#pragma once

#include "runtime/force/viscosity.h"
#include "runtime/geometry/placement.h"
#include "runtime/scene/object_effects.h"
#include "runtime/scene/region.h"
#include "runtime/scene/vibration.h"
#include "runtime/surface/surface_distance.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace haptel::runtime {

struct Contact;
struct HandSettings;
struct Scene;

class Effects {
public:
    Effects(const Scene& scene, const HandSettings& hand); // the scene outlives it

    bool act() const noexcept { return act_; }
    bool of(std::size_t object) const noexcept { return objects_[object] != nullptr; }
    // Nearer than this to the object something may be felt now, or still: 0 without effects.
    double awake_within_m(std::size_t object) const noexcept;

    // One tick, if act(): begin(), then pull() and update() for each object that has effects and may be near, then
    // force_n(). `contacts` are those with the object itself.
    void begin(const glm::dvec3& tip_m, double time_s, uint64_t periods) noexcept;
    // Of its magnet, at a tip that contacts hold so far off the hand, in the scene's space: a hand in a floor is as far
    // from a wall on it as its proxy would be if nothing pulled that. Returns how far the pull draws the proxy, by the
    // stiffness of what holds it: there the contact of joined objects aims in the next tick. So a magnet presses the
    // proxy onto what lies between, and one potential rules.
    glm::dvec3 pull(std::size_t object, const Placement& placement, const glm::dvec3& held_out_m,
                    double stiffness_n_per_m, CollisionCount& count) noexcept;
    void update(std::size_t object, const Placement& placement, std::span<const Contact> contacts) noexcept;
    glm::dvec3 force_n() noexcept;
    static glm::dvec3 held_out_m(std::span<const Contact> contacts) noexcept; // of the tip

    void lose_hand() noexcept { trail_.lose_hand(); }

private:
    void vibrate(const Vibration& vibration, VibrationLevel& level, double share, const Placement& placement) noexcept;

    struct Near {
        ObjectEffects effects;
        SurfaceDistance distance;
        VibrationLevel level;
        double distance_m = 0; // of the tip, in this tick
    };

    const Scene& scene_;
    double period_s_, probe_radius_m_, scale_; // scale: of the hand's workspace
    bool act_;
    std::vector<std::unique_ptr<Near>> objects_; // null: without effects
    std::vector<VibrationLevel> region_levels_;
    Trail trail_;

    // Of this tick.
    glm::dvec3 tip_m_{0}, sum_n_{0};
    double time_s_ = 0, damping_n_s_per_m_ = 0;
    uint64_t periods_ = 1;
};

} // namespace haptel::runtime
