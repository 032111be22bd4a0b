#include "device/falcon/falcon_kinematics.h"

#include "runtime/geometry/finite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haptel::device {

namespace {

// Metres. The arm turns about an axle of the base, and its end carries a parallelogram that holds the grip.
constexpr double arm_m = 0.060, parallelogram_m = 0.1025;
constexpr double joint_offsets_m = 2 * 0.01125;
constexpr double grip_u_m = 0.01443, grip_v_m = -0.025;
constexpr double base_u_m = 0.0400, base_v_m = -0.02309;
constexpr double homed_angle_rad = 35 * std::numbers::pi / 180;

constexpr double converged_m = 1e-11; // of a step: the error after it is its square
constexpr double step_max_m = 0.03;   // Newton goes no further at once
// The grip cannot leave this box around the centre; solutions outside are the mechanism's mirror images.
constexpr glm::dvec3 reach_m(0.1, 0.1, 0.11);

// Where the legs stand around the axis of the device: 105, -15 and -135 degrees from x.
struct LegDirection {
    double cosine, sine;
};
constexpr std::array<LegDirection, 3> leg_directions = {{{-0.25881904510252076, 0.96592582628906829},
                                                         {0.96592582628906829, -0.25881904510252076},
                                                         {-0.70710678118654752, -0.70710678118654752}}};

LegDirection leg_direction(int leg)
{
    return leg_directions[static_cast<std::size_t>(leg)];
}

// A place as one leg sees it: from its axle to the grip's joint along u and w. The parallelogram leans out of that
// plane by v, which leaves it the length `within_m` in the plane; with the joints it spans `span_m` there.
struct LegView {
    double u_m, w_m, v_m, within_m, span_m;
    bool reaches;
};

LegView seen_from_leg(int leg, const glm::dvec3& place_m) noexcept
{
    const auto [cosine, sine] = leg_direction(leg);
    const double u = place_m.x * cosine + place_m.y * sine - base_u_m + grip_u_m;
    const double v = -place_m.x * sine + place_m.y * cosine - base_v_m + grip_v_m;
    const double square = parallelogram_m * parallelogram_m - v * v;
    const double within = std::sqrt(std::max(square, 0.0));
    return {u, place_m.z, v, within, joint_offsets_m + within, square > 0};
}

// How far the arm's end is from closing the loop, as squares, and how that changes.
struct LegClosure {
    double gap_m2, by_angle_m2;
    glm::dvec3 by_place_m;
};

LegClosure closure_of_leg(int leg, const LegView& view, double angle_rad) noexcept
{
    const auto [cosine, sine] = leg_direction(leg);
    const double cos_arm = std::cos(angle_rad), sin_arm = std::sin(angle_rad);
    const double u = view.u_m - arm_m * cos_arm, w = view.w_m - arm_m * sin_arm;
    const double by_u = 2 * u, by_w = 2 * w, by_v = 2 * view.span_m * view.v_m / view.within_m;
    return {u * u + w * w - view.span_m * view.span_m,
            2 * arm_m * (u * sin_arm - w * cos_arm),
            {by_u * cosine - by_v * sine, by_u * sine + by_v * cosine, by_w}};
}

// x with row_i . x = right_i. Nothing if the rows are too near to one plane.
std::optional<glm::dvec3> solve(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                                const glm::dvec3& right) noexcept
{
    const glm::dvec3 bc = glm::cross(b, c);
    const double volume = glm::dot(a, bc);
    const double size = glm::length(a) * glm::length(b) * glm::length(c);
    if (!(std::abs(volume) > 1e-6 * size)) return std::nullopt;
    return (right.x * bc + right.y * glm::cross(c, a) + right.z * glm::cross(a, b)) / volume;
}

bool within_reach(const glm::dvec3& place_m) noexcept
{
    const glm::dvec3 from_centre = glm::abs(place_m - falcon_centre_m);
    return from_centre.x < reach_m.x && from_centre.y < reach_m.y && from_centre.z < reach_m.z;
}

std::optional<glm::dvec3> newton(const glm::dvec3& angles_rad, glm::dvec3 place_m, int& iterations) noexcept
{
    for (int i = 0; i < falcon_iterations_max / 2; ++i) {
        ++iterations;
        std::array<LegClosure, 3> legs{};
        for (int leg = 0; leg < 3; ++leg) {
            const LegView view = seen_from_leg(leg, place_m);
            if (!view.reaches) return std::nullopt;
            legs[static_cast<std::size_t>(leg)] = closure_of_leg(leg, view, angles_rad[leg]);
        }
        const auto step_m = solve(legs[0].by_place_m, legs[1].by_place_m, legs[2].by_place_m,
                                  {-legs[0].gap_m2, -legs[1].gap_m2, -legs[2].gap_m2});
        if (!step_m) return std::nullopt;
        const double length_m = glm::length(*step_m);
        place_m += length_m > step_max_m ? *step_m * (step_max_m / length_m) : *step_m;
        if (!within_reach(place_m)) return std::nullopt;
        if (length_m < converged_m) return place_m;
    }
    return std::nullopt;
}

} // namespace

std::optional<glm::dvec3> falcon_angles(const glm::dvec3& place_m) noexcept
{
    glm::dvec3 angles_rad{0};
    for (int leg = 0; leg < 3; ++leg) {
        const LegView view = seen_from_leg(leg, place_m);
        const double square = view.u_m * view.u_m + view.w_m * view.w_m, distance = std::sqrt(square);
        // The law of cosines in the triangle of axle, arm's end and grip.
        const double cosine = (square + arm_m * arm_m - view.span_m * view.span_m) / (2 * arm_m * distance);
        if (!view.reaches || !(std::abs(cosine) <= 1)) return std::nullopt;
        angles_rad[leg] = std::atan2(view.w_m, view.u_m) - std::acos(cosine);
    }
    return angles_rad;
}

glm::dvec3 falcon_encoder_angles(const FalconCounts& encoders) noexcept
{
    return homed_angle_rad + falcon_rad_per_count * glm::dvec3(encoders[0], encoders[1], encoders[2]);
}

std::optional<FalconPlace> falcon_place(const glm::dvec3& angles_rad, const glm::dvec3& near_m) noexcept
{
    if (!runtime::finite(angles_rad)) return std::nullopt;
    FalconPlace found;
    for (const glm::dvec3& start_m : {near_m, falcon_centre_m}) {
        if (!runtime::finite(start_m)) continue;
        const auto place_m = newton(angles_rad, start_m, found.iterations);
        if (!place_m) continue;
        found.place_m = *place_m;
        return found;
    }
    return std::nullopt;
}

std::optional<glm::dmat3> falcon_angle_gradients(const glm::dvec3& place_m, const glm::dvec3& angles_rad) noexcept
{
    glm::dmat3 columns(0);
    for (int leg = 0; leg < 3; ++leg) {
        const LegView view = seen_from_leg(leg, place_m);
        if (!view.reaches) return std::nullopt;
        const LegClosure closure = closure_of_leg(leg, view, angles_rad[leg]);
        if (!(std::abs(closure.by_angle_m2) > 1e-9)) return std::nullopt;
        columns[leg] = -closure.by_place_m / closure.by_angle_m2;
    }
    return glm::transpose(columns);
}

std::optional<glm::dvec3> falcon_torques(const glm::dvec3& force_n, const glm::dvec3& place_m,
                                         const glm::dvec3& angles_rad) noexcept
{
    const auto gradients = falcon_angle_gradients(place_m, angles_rad);
    if (!gradients) return std::nullopt;
    const glm::dmat3& rows = *gradients; // rows[c] is a column, so it multiplies the torques to the force along axis c
    return solve(rows[0], rows[1], rows[2], force_n);
}

FalconCounts falcon_motor_counts(const glm::dvec3& torques_n_m) noexcept
{
    glm::dvec3 counts = falcon_counts_per_n_m * torques_n_m;
    if (!runtime::finite(counts)) return {};
    const double largest = std::max({std::abs(counts.x), std::abs(counts.y), std::abs(counts.z)});
    if (largest > falcon_motor_max_counts) counts *= falcon_motor_max_counts / largest;
    const auto rounded = [](double value) {
        return static_cast<int16_t>(
            std::clamp<long>(std::lround(value), -falcon_motor_max_counts, falcon_motor_max_counts));
    };
    return {rounded(counts.x), rounded(counts.y), rounded(counts.z)};
}

} // namespace haptel::device
