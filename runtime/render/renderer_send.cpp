// What of the force of a tick goes to the hand: rise, limits, what a scene before left over, and what is left out.
#include "runtime/force/force_model.h"
#include "runtime/geometry/finite.h"
#include "runtime/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

// Each in the time in which a texture turns into another one.
void Renderer::fade_shares(Degradation degradation, uint64_t periods) noexcept
{
    const double step = static_cast<double>(periods) * period_s_ / fade_s;
    const auto fade = [&](double& share, Degradation left_out) {
        share = std::clamp(share + (degradation >= left_out ? -step : step), 0.0, 1.0);
    };
    const bool effects = shares_.effects > 0;
    fade(shares_.effects, Degradation::no_effects);
    fade(shares_.textures, Degradation::no_textures);
    fade(shares_.force, Degradation::no_force);
    if (effects && shares_.effects == 0) effects_.lose_hand(); // a medium begins anew where the hand comes back
}

// Of a force that does not change, on a hand that goes from one pose to another.
double Renderer::work_j(const OnHand& on_hand, const DevicePose& from, const DevicePose& to) const noexcept
{
    if (!probe_.has_tail()) return glm::dot(on_hand.n, to.tip_m - from.tip_m);
    const glm::dvec3 before = from.tail_m - from.tip_m, now = to.tail_m - to.tip_m;
    const double before_m = glm::length(before), now_m = glm::length(now);
    const glm::dvec3 way = probe_.grip_of(to.tip_m, to.tail_m) - probe_.grip_of(from.tip_m, from.tail_m);
    double work = glm::dot(on_hand.n, way) + on_hand.grip_n * (now_m - before_m);
    if (before_m > 0 && now_m > 0) work += glm::dot(on_hand.n_m, glm::cross(before, now)) / (before_m * now_m);
    return work;
}

// What of the force and the torque goes to the hand. `lever_m`: of the end that is farther from the grip. Contacts that
// push against each other may add up to a torque without a force: it is limited by what the largest force has there.
// `left_work_j`: of what is left over from another scene, in this tick and had it not faded.
void Renderer::limit_and_send(TickResult& result, double lever_m, double left_work_j) noexcept
{
    if (!finite(result.unlimited_force_n) || !finite(result.unlimited_torque_n_m) ||
        !std::isfinite(result.grip_force_n)) {
        result.unlimited_force_n = result.unlimited_torque_n_m = glm::dvec3(0);
        result.grip_force_n = held_j_ = 0;
        result.faults |= fault_force_not_finite;
        interrupted_ = true;
    }
    const double small_n = scene_->servo.wait_for_small_force_n;
    const auto small = [&](const OnHand& of) {
        return glm::length(of.n) <= small_n && glm::length(of.n_m) <= small_n * lever_m &&
               std::abs(of.grip_n) <= small_n;
    };
    if (std::exchange(swapped_, false)) {
        rise_period_ = left_period_ = period_;
        left_ = interrupted_ ? OnHand() : sent_;
        left_work_j_ = left_work_max_j_ = 0;
        waiting_ =
            waiting_ ||
            (small_n > 0 && !small({result.unlimited_force_n - computed_.n, result.unlimited_torque_n_m - computed_.n_m,
                                    result.grip_force_n - computed_.grip_n}));
    }
    computed_.n = result.unlimited_force_n;
    computed_.n_m = result.unlimited_torque_n_m;
    computed_.grip_n = result.grip_force_n;
    if (waiting_) {
        waiting_ = !small(computed_) || interrupted_;
        rise_period_ = period_;
        result.waiting = waiting_;
    }
    const double rise_s = scene_->servo.force_rise_s;
    const auto risen_since = [&](uint64_t period) {
        const double rising_s = static_cast<double>(period_ - period) * period_s_;
        return rising_s < rise_s ? rising_s / rise_s : 1.0;
    };
    const double risen = waiting_ ? 0.0 : risen_since(rise_period_);
    glm::dvec3 force_n = risen * result.unlimited_force_n, torque_n_m = risen * result.unlimited_torque_n_m;
    double grip_n = risen * result.grip_force_n, held_j = risen * held_j_;
    if (left_ != OnHand()) {
        // A spring that has given w of the 2 E that its force would give on the way on which it slackens, pushes by
        // 1 - w / 2E of that force and holds the square of it. It is not stretched again.
        left_work_j_ += left_work_j;
        left_work_max_j_ = std::max(left_work_max_j_, left_work_j_);
        const double unfaded = 1 - risen_since(left_period_);
        const double stretched = left_work_max_j_ > 0 ? std::max(0.0, 1 - left_work_max_j_ / (2 * left_.held_j)) : 1.0;
        const double left = unfaded * stretched;
        held_j += left * stretched * left_.held_j;
        force_n += left * left_.n;
        torque_n_m += left * left_.n_m;
        grip_n += left * left_.grip_n;
        if (left == 0) left_ = {};
    }
    force_n *= shares_.force;
    torque_n_m *= shares_.force;
    grip_n *= shares_.force;
    held_j *= shares_.force;
    result.force_n = limited(force_n, force_limit_n_);
    result.grip_force_n = std::clamp(grip_n, -force_limit_n_, force_limit_n_);
    const auto share = [](double of, double all) { return of < all ? of / all : 1.0; };
    if (torque_n_m != glm::dvec3(0)) {
        result.torque_n_m = share(force_limit_n_, glm::length(force_n)) * torque_n_m;
        const double by_lever = share(force_limit_n_ * lever_m, glm::length(result.torque_n_m));
        result.force_n *= by_lever, result.torque_n_m *= by_lever;
    }
    const double of_force = result.force_n == force_n ? 1.0 : share(glm::length(result.force_n), glm::length(force_n));
    const double limit = std::min(of_force, share(std::abs(result.grip_force_n), std::abs(grip_n)));
    sent_.n = result.force_n;
    sent_.n_m = result.torque_n_m;
    sent_.grip_n = result.grip_force_n;
    sent_.held_j = limit * limit * held_j;
}

} // namespace haptel::runtime
