#include "jit/check/check_continuity.h"

#include "jit/check/check_code.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptel::jit {
namespace {

constexpr int paths = 400;
constexpr int halvings = 26, halvings_before = 13; // of a path; by then what is smooth looks straight
constexpr double rounding = 1e-9;                  // of the largest values met

struct Touch {
    double height = 0;
    std::array<double, 3> gradient{};
};

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class Paths {
public:
    Paths(const TextureBinding& texture, const CheckPoints& where) : binding(texture), points(where) {}

    uint64_t too_steep = 0, too_curved = 0;
    uint32_t roughest = HAPTEL_CONTINUITY_C1;

    void follow(uint64_t index)
    {
        const haptel_point first = points.random(2 * index), second = points.random(2 * index + 1);
        // 1/32 of the box long: long enough to meet a kink, short enough to be about one
        for (bool by_height : {true, false}) {
            std::array<double, 3> a{}, b{};
            for (size_t i = 0; i < 3; ++i) a[i] = first.p[i], b[i] = first.p[i] + (second.p[i] - first.p[i]) / 32;
            halve(a, b, by_height);
        }
    }

private:
    const TextureBinding& binding;
    const CheckPoints& points;
    double largest_height = 0, largest_gradient = 0;

    Touch touch(const std::array<double, 3>& at)
    {
        const double p_m[3] = {at[0], at[1], at[2]};
        const haptel_point point = points.at(p_m);
        haptel_sample sample{};
        binding.texture->height_gradient(&point, binding.block, &sample);
        const Touch touched{sample.height_m, {sample.gradient[0], sample.gradient[1], sample.gradient[2]}};
        const double slope = distance(touched.gradient, {});
        too_steep += slope > binding.facts.slope_max * (1 + rounding);
        largest_height = std::max(largest_height, std::fabs(touched.height));
        largest_gradient = std::max(largest_gradient, slope);
        return touched;
    }

    // Into the half with the greater change, again and again: at a jump or kink the change stays, else it is halved.
    void halve(std::array<double, 3> a, std::array<double, 3> b, bool by_height)
    {
        Touch at_a = touch(a), at_b = touch(b);
        const auto change = [by_height](const Touch& one, const Touch& other) {
            return by_height ? std::fabs(one.height - other.height) : distance(one.gradient, other.gradient);
        };
        double before = 0;
        for (int i = 0; i < halvings; ++i) {
            std::array<double, 3> middle{};
            for (size_t k = 0; k < 3; ++k) middle[k] = a[k] / 2 + b[k] / 2;
            const Touch at_middle = touch(middle);
            if (i == halvings_before) before = change(at_a, at_b);
            const bool in_first = change(at_a, at_middle) > change(at_middle, at_b);
            (in_first ? b : a) = middle;
            (in_first ? at_b : at_a) = at_middle;
        }
        const double left = change(at_a, at_b);
        const double size = by_height ? largest_height : largest_gradient;
        if (left > 0.4 * before && left > 100 * rounding * size)
            roughest = std::min<uint32_t>(roughest, by_height ? HAPTEL_CONTINUITY_JUMP : HAPTEL_CONTINUITY_C0);
        const bool is_promised = binding.facts.continuity == HAPTEL_CONTINUITY_C1;
        const double reach = distance(a, b) * binding.facts.curvature_max_per_m;
        too_curved += is_promised &&
                      distance(at_a.gradient, at_b.gradient) > reach * (1 + rounding) + rounding * largest_gradient;
    }
};

} // namespace

void check_continuity(GradientCheck& check, const TextureBinding& binding, const CheckPoints& points)
{
    Paths all(binding, points);
    for (uint64_t i = 0; i < paths; ++i) all.follow(i);
    check.continuity_measured = all.roughest;
    check.bounds_exceeded += all.too_steep + all.too_curved;
    expect_at_most(check, "places along paths where the slope leaves its bound", static_cast<double>(all.too_steep), 0);
    expect_at_most(check, "paths along which the gradient changes faster than its bound",
                   static_cast<double>(all.too_curved), 0);
    const auto name = [](uint32_t continuity) {
        return continuity == HAPTEL_CONTINUITY_JUMP ? "jump" : continuity == HAPTEL_CONTINUITY_C0 ? "C0" : "C1";
    };
    if (all.roughest < binding.facts.continuity)
        check.failures.push_back(std::string("the class is said to be ") + name(binding.facts.continuity) +
                                 ", measured is " + name(all.roughest));
}

} // namespace haptel::jit
