#include "jit/check/measure_facts.h"

#include "jit/check/check_points.h"
#include "jit/check/short_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace haptel::jit {

namespace {

using Point = std::array<double, 3>;

constexpr double nothing = -HUGE_VAL; // where a figure has no value

double length(const Point& a)
{
    return std::hypot(a[0], a[1], a[2]);
}

class Search {
public:
    Search(const TextureBinding& of, const CheckBox& within, const CheckPoints& where)
        : binding(of), box(within), points(where)
    {
    }

    haptel_sample sample(const Point& p_m) const
    {
        const double at[3] = {p_m[0], p_m[1], p_m[2]};
        const haptel_point point = points.at(at);
        haptel_sample found{};
        binding.texture->height_gradient(&point, binding.block, &found);
        return found;
    }

    double height(const Point& p_m) const
    {
        const haptel_sample found = sample(p_m);
        return found.faults ? nothing : found.height_m;
    }

    double slope(const Point& p_m) const
    {
        const haptel_sample found = sample(p_m);
        return found.faults ? nothing : length({found.gradient[0], found.gradient[1], found.gradient[2]});
    }

    // The greatest eigenvalue of the second derivative, by the power method: differences of the gradient turn toward
    // its direction. Nothing at a kink, where they grow as the step shrinks.
    double curvature(const Point& p_m) const
    {
        const double step_m = points.side_m() * 1e-6; // rounding and the third derivative weigh about the same
        Point direction = {0.6, 0.48, 0.64};
        for (int i = 0; i < 4; ++i) {
            const Point change = change_along(p_m, direction, step_m);
            const double size = length(change);
            if (!(size > 0)) return size == 0 ? 0 : nothing;
            for (size_t k = 0; k < 3; ++k) direction[k] = change[k] / size;
        }
        const double wide = length(change_along(p_m, direction, step_m));
        const double narrow = length(change_along(p_m, direction, step_m / 4));
        return narrow <= 2 * wide ? narrow : nothing;
    }

    // The greatest value of a figure: of the places, and uphill from the best of them.
    struct Found {
        double most = nothing;
        bool is_endless = false; // it grew so much uphill that it will go on
    };
    Found greatest(const std::vector<Point>& places, const std::function<double(const Point&)>& figure) const
    {
        std::vector<std::pair<double, size_t>> best;
        for (size_t i = 0; i < places.size(); ++i) best.emplace_back(figure(places[i]), i);
        const size_t tried = std::min<size_t>(best.size(), 12);
        std::partial_sort(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(tried), best.end(),
                          std::greater<>());
        Found found;
        for (size_t i = 0; i < tried; ++i) {
            if (best[i].first == nothing) break;
            found.most = std::max(found.most, climbed(places[best[i].second], best[i].first, figure));
        }
        // Of a smooth function the best of thousands of places is near its greatest value.
        constexpr double will_go_on = 30;
        found.is_endless = found.most > will_go_on * best.front().first && best.front().first > 0;
        return found;
    }

private:
    // By central differences, per metre.
    Point change_along(const Point& p_m, const Point& direction, double step_m) const
    {
        Point a = p_m, b = p_m;
        for (size_t k = 0; k < 3; ++k) a[k] -= direction[k] * step_m, b[k] += direction[k] * step_m;
        const haptel_sample low = sample(a), high = sample(b);
        if (low.faults || high.faults) return {NAN, NAN, NAN};
        Point change;
        for (size_t k = 0; k < 3; ++k) change[k] = (high.gradient[k] - low.gradient[k]) / (2 * step_m);
        return change;
    }

    // Along the axes, with steps that are halved where none leads up.
    double climbed(Point p_m, double value, const std::function<double(const Point&)>& figure) const
    {
        constexpr int halvings = 40; // a step of the first length is 2^40 of the last
        double step_m = points.side_m() / 64;
        for (int i = 0; i < halvings;) {
            bool is_higher = false;
            for (size_t axis = 0; axis < 3; ++axis)
                for (const double sign : {-1.0, 1.0}) {
                    Point next = p_m;
                    next[axis] = std::clamp(next[axis] + sign * step_m, box.minimum_m[axis], box.maximum_m[axis]);
                    const double there = figure(next);
                    if (there > value) p_m = next, value = there, is_higher = true;
                }
            if (!is_higher) step_m /= 2, ++i;
        }
        return value;
    }

    const TextureBinding& binding;
    const CheckBox& box;
    const CheckPoints& points;
};

} // namespace

MeasuredFacts measure_facts(const TextureBinding& binding, const CheckBox& box, uint32_t count, uint64_t seed)
{
    const CheckPoints points(box, seed);
    const Search search(binding, box, points);
    MeasuredFacts facts;
    std::vector<Point> places;
    for (uint32_t i = 0; i < count; ++i) {
        const haptel_point point = points.random(i);
        const Point p_m = {point.p[0], point.p[1], point.p[2]};
        if (search.sample(p_m).faults == 0) places.push_back(p_m);
    }
    facts.faulty = 1 - static_cast<double>(places.size()) / std::max(count, 1u);
    if (places.empty()) return facts;

    facts.value_maximum = search.greatest(places, [&](const Point& p_m) { return search.height(p_m); }).most;
    facts.value_minimum = -search
                               .greatest(places,
                                         [&](const Point& p_m) {
                                             const double height_m = search.height(p_m);
                                             return height_m == nothing ? nothing : -height_m;
                                         })
                               .most;
    const auto slope = search.greatest(places, [&](const Point& p_m) { return search.slope(p_m); });
    if (!slope.is_endless) facts.slope = std::max(slope.most, 0.0);
    const auto curvature = search.greatest(places, [&](const Point& p_m) { return search.curvature(p_m); });
    if (!curvature.is_endless) facts.curvature = std::max(curvature.most, 0.0);

    ShortPaths paths(binding, points);
    constexpr double shares[] = {1.0 / 4, 1.0 / 32, 1.0 / 256}; // to cross a seam once, and to meet one of many
    for (uint64_t i = 0; i < 1200; ++i) paths.follow(i, shares[i % std::size(shares)]);
    facts.continuity = paths.roughest;
    return facts;
}

} // namespace haptel::jit
