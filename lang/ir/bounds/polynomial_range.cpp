// What a polynomial can be where its parts lie in intervals.
#include "lang/ir/bounds/polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace haptel::ir {

// In the form of Bernstein it lies between its coefficients, of which the first and the last are values of it; of
// halves they are nearer (de Casteljau).
Interval Polynomial::of_one_part(const Interval& at) const
{
    using Numbers = std::array<double, degree_max + 1>;
    Numbers powers{}; // of s, where the part is minimum + width * s
    const size_t degree = coefficients.size() - 1;
    const double width = at.maximum - at.minimum;
    for (size_t power = 0; power <= degree; ++power) {
        double share = coefficients[power].factor; // times the binomial of power and i
        for (size_t i = 0; i <= power; ++i) {
            double scaled = share;
            for (size_t k = 0; k < power; ++k) scaled *= k < i ? width : at.minimum;
            powers[i] += scaled;
            share *= static_cast<double>(power - i) / static_cast<double>(i + 1);
        }
    }
    Numbers bernstein{};
    for (size_t j = 0; j <= degree; ++j) {
        double ratio = 1; // of binomials: j over i, degree over i
        for (size_t i = 0; i <= j; ++i) {
            bernstein[j] += ratio * powers[i];
            ratio *= static_cast<double>(j - i) / static_cast<double>(degree - i);
        }
    }
    Interval found = no_value;
    const auto look = [&](const auto& self, Numbers left, int halvings) -> void {
        const auto [least, most] = std::minmax_element(left.begin(), left.begin() + static_cast<ptrdiff_t>(degree) + 1);
        const double ends[] = {std::min(left[0], left[degree]), std::max(left[0], left[degree])};
        if (halvings == 0 || (*least == ends[0] && *most == ends[1])) {
            found = join(found, {*least, *most});
            return;
        }
        Numbers right{};
        for (size_t k = 0; k <= degree; ++k) {
            right[degree - k] = left[degree];
            for (size_t i = degree; i > k; --i) left[i] = (left[i] + left[i - 1]) / 2;
        }
        self(self, left, halvings - 1);
        self(self, right, halvings - 1);
    };
    look(look, bernstein, 4);
    return found;
}

// Linear in each part, it is least and greatest where each is: at an end. Part by part the coefficients become values
// at both. Of a circle, which is the first and hence the last that is left, c + a cos + b sin + d cos sin is within
// hypot(a, b) + |d| / 2 of c.
Interval Polynomial::of_corners(std::span<const Interval> values) const
{
    std::array<double, size_t{1} << corners_max> corner;
    for (size_t i = 0; i < coefficients.size(); ++i) corner[i] = coefficients[i].factor;
    Interval circle{-infinity, infinity};
    for (size_t k = parts.size(); k-- > 0;) {
        if (k == 1 && has_circle) {
            circle = no_value;
            for (size_t i = 0; i < coefficients.size(); i += 4) {
                const double radius = std::hypot(corner[i + 1], corner[i + 2]) + std::fabs(corner[i + 3]) / 2;
                circle = join(circle, {corner[i] - radius, corner[i] + radius});
            }
        }
        const Interval& at = values[parts[k].index];
        for (size_t i = 0, bit = size_t{1} << k; i < coefficients.size(); ++i) {
            if (i & bit) continue;
            const double with = corner[i | bit], without = corner[i];
            corner[i] = without + with * at.minimum;
            corner[i | bit] = without + with * at.maximum;
        }
    }
    const auto [least, most] = std::minmax_element(corner.begin(), corner.begin() + std::ssize(coefficients));
    Interval all{std::max(*least, circle.minimum), std::min(*most, circle.maximum)};
    for (const auto& [part, times] : alone) {
        const Interval& at = values[part.index];
        const double a = times.factor * at.minimum, b = times.factor * at.maximum;
        all = {all.minimum + std::min(a, b), all.maximum + std::max(a, b)};
    }
    return all;
}

// At least the sum of all that is added up on the way, without signs.
double Polynomial::magnitude(std::span<const Interval> values) const
{
    double sum = 0;
    if (is_of_powers) {
        const Interval& at = values[parts[0].index];
        const double size = std::fabs(at.minimum) + (at.maximum - at.minimum);
        for (size_t i = coefficients.size(); i-- > 0;) sum = sum * size + coefficients[i].magnitude;
        return sum;
    }
    std::array<double, size_t{1} << corners_max> product;
    for (size_t i = 0; i < coefficients.size(); ++i) product[i] = coefficients[i].magnitude;
    for (size_t k = parts.size(); k-- > 0;)
        for (size_t i = 0, bit = size_t{1} << k; i < bit; ++i)
            product[i] += product[i | bit] * size_of(values[parts[k].index]);
    sum = product[0];
    for (const auto& [part, times] : alone) sum += times.magnitude * size_of(values[part.index]);
    return sum;
}

std::optional<Interval> Polynomial::range(std::span<const Interval> values) const
{
    const auto is_finite = [&](Value part) { return values[part.index].is_finite(); };
    if (!std::ranges::all_of(parts, is_finite) || !std::ranges::all_of(alone, is_finite, &Alone::part))
        return std::nullopt;
    // Each operation is off by half a unit in the last place of what is added up, at most; or of the least number, and
    // that may be multiplied by all that there is, and by what makes the least coefficient on the way the one at the
    // end.
    double most = 1;
    for (const Coefficient& times : coefficients) most = std::max(most, times.magnitude);
    for (const Alone& one : alone) most = std::max(most, one.times.magnitude);
    for (const Value part : parts)
        for (size_t i = 0; i < (is_of_powers ? coefficients.size() : 1); ++i)
            most *= std::max(1.0, size_of(values[part.index]));
    using Limits = std::numeric_limits<double>;
    const double lost = Limits::denorm_min() / least_magnitude * most;
    const double slack = 4.0 * operations * (Limits::epsilon() * magnitude(values) + lost);
    if (!std::isfinite(slack)) return std::nullopt;
    const Interval found = is_of_powers ? of_one_part(values[parts[0].index]) : of_corners(values);
    return Interval{found.minimum - slack, found.maximum + slack};
}

} // namespace haptel::ir
