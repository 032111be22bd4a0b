// From a pose to a force, for a program that has a haptic loop of its own.
#pragma once

#include <haptel/device.h>
#include <haptel/scene.h>

#include <cstdint>
#include <memory>
#include <string>

namespace haptel {

// What a tick gives.
struct Force {
    Vec3 force_n = {};       // on the hand, in the world frame, within the limit of the scene
    Vec3 torque_n_m = {};    // of a stylus, about its grip
    double grip_force_n = 0; // of a gripper: how hard its fingers are pushed apart
    uint32_t contacts = 0;   // objects touched
    double depth_m = 0;      // below the base surface
    double height_m = 0;     // of the texture there
    uint32_t faults = 0;     // bits; 0: none
};

// Of one hand: what it touched in the tick before decides where it is held in this one.
class HAPTEL_API Renderer {
public:
    explicit Renderer(const Scene& scene); // not on the loop's thread, if that may not wait
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    explicit operator bool() const;      // false: messages() says why
    const std::string& messages() const; // why all forces are 0; empty: all is well

    // Once per period of the scene's rate; `periods`, if the loop was late, how many went by. Allocates, locks, throws
    // nothing. A pose that is not finite has no force, and the force rises anew afterwards.
    Force tick(const Pose& pose, uint64_t periods = 1) noexcept;
    // After the force is sent: reads ahead for the next tick. Changes no force.
    void between_ticks() noexcept;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace haptel
