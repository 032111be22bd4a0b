#include "runtime/scene/motion.h"

#include "runtime/scene/validation.h"
#include "runtime/scene/vibration.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace haptel::runtime {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

} // namespace

SteadyMotion::SteadyMotion(const Placement& start, const Figures& figures) : start_(start), figures_(figures) {}

std::optional<Placement> SteadyMotion::at(double time_s) const noexcept
{
    Placement now = start_;
    now.position_m += swing(figures_.swing_hz * time_s) * figures_.swing_m;
    if (figures_.spin_rad_per_s != 0) {
        const double angle = two_pi * std::remainder(figures_.spin_rad_per_s * time_s / two_pi, 1.0);
        now.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), angle, figures_.axis)) * start_.rotation;
    }
    return now;
}

// The ball goes round its axis, and the whole circle swings.
std::optional<MotionBounds> SteadyMotion::bounds(const glm::dvec3& centre_m, double radius_m) const noexcept
{
    const double swing_m = glm::length(figures_.swing_m), turn = std::fabs(figures_.spin_rad_per_s);
    const glm::dvec3 arm_m = start_.rotation * centre_m;
    MotionBounds bounds{start_.position_m + arm_m, radius_m + swing_m, 2 * swing_m, turn};
    if (turn != 0) {
        const glm::dvec3 axis = figures_.axis / glm::length(figures_.axis), along_m = glm::dot(arm_m, axis) * axis;
        bounds.centre_m = start_.position_m + along_m;
        bounds.radius_m += glm::distance(arm_m, along_m);
    }
    bounds.radius_m += 10 * orthonormal_within * (bounds.radius_m + glm::length(arm_m));
    return bounds;
}

double SteadyMotion::speed_max_m_per_s(double radius_m) const noexcept
{
    return two_pi * figures_.swing_hz * glm::length(figures_.swing_m) + std::fabs(figures_.spin_rad_per_s) * radius_m;
}

std::string SteadyMotion::fault(double rate_hz) const
{
    std::string fault = placement_fault(start_);
    const Broken told = [&](std::string_view, const std::string& why) {
        if (fault.empty()) fault = why;
    };
    if (figures_.swing_m != glm::dvec3(0)) {
        swing_fields(figures_, RangeCheck(told));
        check_rounds("swing_hz", figures_.swing_hz, Rounds::swings, rate_hz, told);
    }
    if (figures_.spin_rad_per_s != 0) {
        if (!std::isnormal(glm::length(figures_.axis))) told("axis", "the axis of a turn has no direction");
        check_rounds("spin_deg_per_s", glm::degrees(std::fabs(figures_.spin_rad_per_s)), Rounds::turns, rate_hz, told);
    }
    return fault;
}

LivePlacement::LivePlacement(const Placement& start)
{
    store(start);
}

std::string LivePlacement::publish(const Placement& placement)
{
    std::string fault = placement_fault(placement);
    if (fault.empty()) store(placement);
    return fault;
}

void LivePlacement::store(const Placement& placement) noexcept
{
    const uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed); // who reads a new value sees this, too
    for (int i = 0; i < 3; ++i) {
        values_[9 + i].store(placement.position_m[i], std::memory_order_release);
        for (int j = 0; j < 3; ++j) values_[3 * i + j].store(placement.rotation[i][j], std::memory_order_release);
    }
    version_.store(version + 2, std::memory_order_release);
}

std::optional<Placement> LivePlacement::at(double) const noexcept
{
    for (int attempt = 0; attempt < 2; ++attempt) {
        const uint64_t before = version_.load(std::memory_order_acquire);
        Placement now;
        for (int i = 0; i < 3; ++i) {
            now.position_m[i] = values_[9 + i].load(std::memory_order_acquire);
            for (int j = 0; j < 3; ++j) now.rotation[i][j] = values_[3 * i + j].load(std::memory_order_acquire);
        }
        if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) return now;
    }
    return std::nullopt;
}

} // namespace haptel::runtime
