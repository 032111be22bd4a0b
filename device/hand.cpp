#include "device/hand.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace haptel::device {

Hand::Hand(const HandImpedance& impedance, Stroke stroke, double press_n, double period_s)
    : impedance_(impedance), stroke_(std::move(stroke)), press_n_(press_n), period_s_(period_s)
{
    aim_from_m_ = aim_to_m_ = stroke_.at(0).point_m;
}

void Hand::advance()
{
    const double passed = 1 - std::exp(-2 * std::numbers::pi * hand_bandwidth_hz * period_s_);
    const StrokeTarget target = stroke_.at(static_cast<double>(++periods_) * period_s_);

    glm::dvec3 step_m = passed * (target.point_m - aim_to_m_);
    const double step_max_m = hand_speed_max_m_per_s * period_s_;
    if (const double length_m = glm::length(step_m); length_m > step_max_m) step_m *= step_max_m / length_m;
    aim_from_m_ = aim_to_m_;
    aim_to_m_ += step_m;

    push_from_n_ = push_to_n_;
    push_to_n_ += passed * (-press_n_ * target.press * target.normal - push_to_n_);

    opened_from_ = opened_to_;
    if (press_n_ > 0) opened_to_ += passed * (1 - target.press - opened_to_);
}

} // namespace haptel::device
