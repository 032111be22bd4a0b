// One tick of haptic rendering: from the pose of the hand to the force on it.
//
// A function of its state and the pose (with the periods that have passed) alone - no clock, no thread, no device - so
// that a run can be repeated bit for bit and tested without any of them. The stages, each skipped when the one before
// says so: pose check, contact (free-space skip, collision, proxy, friction), force shading, texture, force model,
// friction and damping, effects, limits. tick() allocates nothing, locks nothing, throws nothing.
#pragma once

#include "runtime/force/effects.h"
#include "runtime/force/foot.h"
#include "runtime/hand/hand.h"
#include "runtime/hand/hand_history.h"
#include "runtime/hand/hand_velocity.h"
#include "runtime/hand/haptic_device.h"
#include "runtime/render/body.h"
#include "runtime/render/held_together.h"
#include "runtime/render/object_force.h"
#include "runtime/render/skipped_stages.h"
#include "runtime/render/sleep_queue.h"
#include "runtime/render/smooth_rows.h"
#include "runtime/scene/scene.h"
#include "runtime/texture/surface_texture.h"
#include "runtime/texture/texture_slot.h"

#include <array>
#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptel::runtime {

// Damping of a material is full from this depth on and proportional to depth above it: a touch begins without a step in
// force, however fast the hand comes (Hunt and Crossley 1975 have the same reason for the same product).
inline constexpr double full_damping_depth_m = 1e-3;

// Bits of TickResult::faults, beside those of TextureSample::faults.
enum : uint32_t {
    fault_pose_not_finite = 1u << 16,  // force zero, contact kept as it was
    fault_force_not_finite = 1u << 17, // force zero
    fault_scene_refused = 1u << 18,    // force zero: Renderer::refused() says why
    // The probe could not go all its way in one tick, which is bounded; the next goes on. The force is of where it is;
    // a ball round which there is too much is not put down, and has none.
    fault_contact_unfinished = 1u << 19
};

struct TickResult {
    double time_s = 0;        // periods since the first pose, those without a pose included, times the period
    bool interrupted = false; // the force rises anew from here on
    bool waiting = false;     // no force yet: the one computed is not small (ServoSettings::wait_for_small_force_n)
    glm::dvec3 force_n{0};    // on the hand, world frame, after rise and limits; finite and never above the limit
    glm::dvec3 torque_n_m{0}; // of a stylus about its grip, limited along with the force, and by its own lever
    double grip_force_n = 0;  // of a gripper: how hard its fingers are pushed apart, after rise and limit
    glm::dvec3 unlimited_force_n{0}, unlimited_torque_n_m{0};
    glm::dvec3 grip_m{0};  // where the hand holds the probe: its tip, of a stylus or a gripper as ProbeSettings says
    uint32_t contacts = 0; // objects touched
    double depth_m = 0;    // below the base surface, of the deepest object touched
    double height_m = 0;   // of the texture there, as published
    glm::dvec3 normal{0};  // of the base surface there, as shaded: unit, outward, world frame; 0 without contact
    uint32_t object = 0;   // that object's number in the scene, from 1; 0: none is touched
    uint64_t binding = 0;  // serial of the texture of that object, else of the first one
    uint32_t faults = 0;
};

// Of all objects since the renderer was made, effects included; triangles that were read ahead; and `objects`: looked
// at, summed over the ticks and the scenes that were taken over.
struct ContactWork : ContactCounters {
    uint64_t read_ahead = 0, objects = 0;
};

class Renderer {
public:
    // Of a scene that does not validate (validation.h) no tick has a force, and refused() says why.
    explicit Renderer(std::shared_ptr<const Scene> scene, const HandSettings& hand = {});

    // Of a scene that takes the place of `before`, which validates, too, and is of the same rate, while the hand is in
    // it.
    Renderer(std::shared_ptr<const Scene> scene, const HandSettings& hand, const Scene& before);
    // Between two ticks: goes on where the renderer of `before` is, which is worth nothing afterwards. What is the same
    // surface at the same place goes on touching the hand; on everything else the hand is put down from where the same
    // objects held the probe. The force that was on the hand fades out and the new one rises over force_rise_s, so
    // without a step; to a hand that gives way to it, it is the spring that it was, and gives no more than that held.
    // If the scene waits for small forces and the new one differs by more from the old, it waits first. Allocates and
    // frees nothing, and looks at no object farther away than the hand is held off something.
    void take_over(Renderer& before) noexcept;

    // Once per period with the pose of the hand, in the space of its device, as are the forces (once for several where
    // the servo was late: DevicePose::periods, 0 is taken for 1). The first pose puts the probe down where it is. After
    // the start and after every interruption - the device had no pose, or one that is not finite, or the force was not
    // finite - the force grows linearly from 0 over the scene's force_rise_s, from when it is small if the scene says
    // to wait for that.
    TickResult tick(const DevicePose& pose) noexcept;

    // Between two ticks, when the force is with the device: brings what the next one may need into the cache, looks how
    // far it is free around the hand, puts to sleep what is far, and lets go of textures replaced on objects out of
    // reach. Changes no force, but of a texture published meanwhile when it begins to fade in.
    void between_ticks() noexcept;

    // Why nothing is rendered, a line for each reason; empty: all is well.
    const std::string& refused() const noexcept { return refused_; }
    double rate_hz() const noexcept { return scene_->servo.rate_hz; }
    // All force, after a while of DevicePose::degradation's last step.
    bool faded_away() const noexcept { return shares_.force == 0; }
    double force_limit_n() const noexcept { return force_limit_n_; }
    const SkippedStages& skipped() const noexcept { return skipped_; }
    const ContactWork& work() const noexcept { return work_; }

private:
    // What the servo remembers of one object, whichever body it is of.
    struct Touched {
        const SceneObject* object;
        TextureReader texture;
        LastSample sample = {};
        FacetLines lines = {};
        uint64_t texture_period = 0; // up to which its texture has faded
        uint64_t swung_period = 0;   // up to which its vibration has swung, so many turns
        double swing_turns = 0, swing_hz = 0;
    };
    struct HeldBodies { // that hold the probe, the first so many
        std::array<const Body*, 16> body{};
        uint32_t count = 0;
        double within_m = 0; // so far off the hand, at most, do all that there are hold it
    };
    struct Skipped { // in this tick
        bool query = true, texture = true, octaves = false, mapping = false;
    };
    struct Shares { // of what is felt, while something is left out (DevicePose::degradation)
        double effects = 1, textures = 1, force = 1;
        bool operator==(const Shares&) const = default;
    };
    struct OnHand {
        glm::dvec3 n{0}, n_m{0};
        double grip_n = 0;
        double held_j = 0; // by the springs that push so: the most that they give to a hand that leaves
        bool operator==(const OnHand&) const = default;
    };

    TickResult tick_in_scene(DevicePose pose) noexcept;
    void fade_shares(Degradation degradation, uint64_t periods) noexcept;
    void add_force(TickResult& result, const DevicePose& pose, double along, const glm::dvec3& force_n) const noexcept;
    std::span<const Contact> update_contact(Body& body, const ProbePose& pose, const EndsFriction& friction) noexcept;
    void render_contacts(Body& body, std::span<const Contact> contacts, std::span<const PartContacts> parts,
                         const DevicePose& pose, TickResult& result, Skipped& skipped) noexcept;
    std::span<Row> rows_of(const Body& body, std::span<const Contact> contacts,
                           std::span<const PartContacts> parts) noexcept;
    void feel_row(const Body& body, Row& row) noexcept;
    void feel(Body& body, uint32_t part, bool is_first, const Contact& contact, const ObjectForce& force,
              const DevicePose& pose, TickResult& result, Skipped& skipped) noexcept;
    double grown_since_m(const Renderer& before) const noexcept; // a ball in place of another
    double farthest_held_m(const Body& old, const Renderer& before) const noexcept;
    void put_down(Body& body, const Renderer& before, const HeldBodies& held) noexcept;
    void advance_texture(Touched& touched) noexcept;
    void advance_textures(const Body& body) noexcept;
    double way_m(const DevicePose& pose) const noexcept;
    double turned_rad() const noexcept;
    bool take_pose(Body& body, const DevicePose& pose, uint64_t periods) noexcept;
    ProbePose pose_before(Body& body) const noexcept;
    void wake(Body& body) noexcept;
    bool sleeps(uint32_t body, const DevicePose& pose) noexcept;
    double gap_to_sleep_m(uint32_t body, const DevicePose& pose) const noexcept;
    void track_velocity(uint32_t body, const DevicePose& pose, uint64_t periods, bool touching) noexcept;
    void update_effects(Body& body, std::span<const Contact> contacts, std::span<const PartContacts> parts) noexcept;
    bool feels_in_air(const Body& body, const DevicePose& pose) noexcept;
    bool is_smooth(const Surface& surface) const noexcept;
    Foot foot_of(Touched& touched, const Contact& contact) const noexcept;
    // `normal_dp`: how the normal of what is felt turns with the hand's place, by the share of the smooth foot, world
    // frame; null: nobody asks.
    ObjectForce force_of(const Body& body, Touched& touched, const Placement& placement, const Contact& contact,
                         glm::dmat3* normal_dp = nullptr) noexcept;
    ObjectForce force_of_facets(const Body& body, const Material& material, const Placement& placement,
                                const Contact& contact) const noexcept;
    ObjectForce force_at(const Foot& foot, const Body& body, Touched& touched, const Placement& placement,
                         const Contact& contact) noexcept;
    TextureSample texture_at(const Foot& foot, const Body& body, Touched& touched, const Placement& placement,
                             const Contact& contact, double stiffness_n_per_m, const Shaded& read) noexcept;
    glm::dvec3 hand_m_per_s(const Body& body, const Placement& placement, const Contact& contact) const noexcept;
    void swing_on(Touched& touched) noexcept;
    double damping_n(const Body& body, double n_s_per_m, const Placement& placement, const Contact& contact,
                     const glm::dvec3& normal, double depth_m, double stiffness_n_per_m) const noexcept;
    double work_j(const OnHand& on_hand, const DevicePose& from, const DevicePose& to) const noexcept;
    void limit_and_send(TickResult& result, double lever_m, double left_work_j) noexcept;
    double time_s() const noexcept { return time_s(period_); }
    double time_s(uint64_t period) const noexcept { return static_cast<double>(period) * period_s_; }

    std::string refused_;
    std::shared_ptr<const Scene> scene_; // if it is refused, one with nothing in it
    HandSettings hand_;
    bool workspace_moves_; // hand_.workspace.moves(), asked in each tick
    ProbeSettings probe_;
    ForceRule force_rule_;
    double period_s_;
    double force_limit_n_;
    std::vector<Touched> objects_;
    std::vector<Body> bodies_;
    Effects effects_;
    SleepQueue sleep_queue_;        // of bodies
    double near_m_ = 1e-6;          // nearer than this to the hand nobody sleeps, in this tick
    double turn_max_rad_per_s_ = 0; // of those that move within bounds
    bool started_ = false;
    uint64_t period_ = 0;         // number of this tick's period, 0 at the first pose
    uint64_t texture_period_ = 0; // counts periods from this scene's first tick on, those before a pose included
    uint64_t rise_period_ = 0;    // the force rises from this one on
    bool interrupted_ = false;    // the tick before sent no force, for a fault
    bool waiting_;                // for a small force
    double held_j_ = 0;           // by what pushes in this tick, before rise and limits
    Shares shares_;
    SkippedStages skipped_;
    ContactWork work_;
    std::optional<DevicePose> last_pose_;   // that was finite
    uint64_t last_pose_period_ = 0;         // of it
    glm::dvec3 last_tail_m_{0};             // of it, also where the probe has none
    HandVelocity velocity_, tail_velocity_; // world frame
    std::optional<HandHistory> history_;    // where something moves within bounds

    // For who takes over, and after having taken over.
    OnHand sent_;                // in the tick before, the scene's space
    OnHand computed_;            // the same, before rise and limits
    std::vector<uint32_t> was_;  // of each body: its number in the scene before
    bool swapped_ = false;       // no tick since
    OnHand left_;                // was on the hand then, and fades out
    uint64_t left_period_ = 0;   // from this one on
    double left_work_j_ = 0;     // what it would have done on the hand since, had it not faded,
    double left_work_max_j_ = 0; // and the most of that

    CreaseRows crease_rows_;
    SmoothRows smooth_rows_;
    ContactsByPart by_part_;
    std::array<Row, CreaseRows::rows_most> rows_;
};

} // namespace haptel::runtime
