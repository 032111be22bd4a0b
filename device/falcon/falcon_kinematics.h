// Where the grip of a Falcon is for the angles of its three arms, and which torques of its motors make a force.
//
// A delta mechanism with offset joints (R. E. Stamper, A Three Degree of Freedom Parallel Manipulator with Only
// Translational Degrees of Freedom, 1997). Frame of the device: metres, x to the right, y up, z out of it, towards the
// user; the origin is in the plane of the arms' axles. Allocates nothing, throws nothing.
#pragma once

#include "device/falcon/falcon_packet.h"

#include <glm/glm.hpp>

#include <optional>

namespace haptel::device {

inline constexpr glm::dvec3 falcon_centre_m(0, 0, 0.125); // of the workspace
inline constexpr double falcon_rad_per_count = 0.01425 / 0.110 * (2 * 3.14159265358979323846 / 1280);
inline constexpr double falcon_counts_per_n_m = -10000; // of a motor, at its arm; known to about a tenth
inline constexpr int falcon_motor_max_counts = 4095;

// Angles of the arms (rad) for a place, or nothing if no arm reaches it.
std::optional<glm::dvec3> falcon_angles(const glm::dvec3& place_m) noexcept;

// The angles that the encoders of a homed Falcon tell.
glm::dvec3 falcon_encoder_angles(const FalconCounts& encoders) noexcept;

struct FalconPlace {
    glm::dvec3 place_m{0};
    int iterations = 0;
};

// By Newton's method from `near_m`, and from the centre if that leads nowhere. Good to 1e-9 m. Nothing if these angles
// belong to no place that the grip can be at.
std::optional<FalconPlace> falcon_place(const glm::dvec3& angles_rad, const glm::dvec3& near_m) noexcept;
inline constexpr int falcon_iterations_max = 24; // of both tries together

// Row i: the gradient of angle i over the place, rad/m.
std::optional<glm::dmat3> falcon_angle_gradients(const glm::dvec3& place_m, const glm::dvec3& angles_rad) noexcept;

// Torques at the arms (N m) that push the grip with this force: virtual work, force = sum of torque_i * gradient_i.
// Nothing where the mechanism is singular.
std::optional<glm::dvec3> falcon_torques(const glm::dvec3& force_n, const glm::dvec3& place_m,
                                         const glm::dvec3& angles_rad) noexcept;

// Zero for what is not finite. What exceeds the range of one motor makes all three smaller, so that the force keeps its
// direction.
FalconCounts falcon_motor_counts(const glm::dvec3& torques_n_m) noexcept;

} // namespace haptel::device
