#include "lang/ir/bounds/variation.h"

#include "lang/ir/bounds/seams.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace haptel::ir {
namespace {

constexpr double rounding_up = 1 + 1e-14; // norms are computed to nearest
constexpr size_t axis_count = Variation::directions;
constexpr size_t pair_of[axis_count][axis_count] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}; // in `hessian`

// An infinite bound times an exact zero is zero: what is bounded is a finite number.
double times(double a, double b)
{
    return a == 0 || b == 0 ? 0 : a * b;
}

void add_product(const Interval& a, const Interval& b, Interval& sum)
{
    if (!a.is_zero() && !b.is_zero()) sum = add(sum, multiply(a, b));
}

// Euclidean, of the sizes of these parts.
template <typename Parts, typename Size>
double norm(const Parts& parts, const Size& size)
{
    double squares = 0;
    for (const auto& part : parts) squares += times(std::invoke(size, part), std::invoke(size, part));
    return std::sqrt(squares) * rounding_up;
}

// Spectral norm of a symmetric matrix: at most its largest sum of a row, and at most its Frobenius norm.
double spectral_norm(const std::array<Interval, 6>& matrix)
{
    double rows = 0, squares = 0;
    for (size_t j = 0; j < axis_count; ++j) {
        double row = 0;
        for (size_t k = 0; k < axis_count; ++k) {
            const double part = size_of(matrix[pair_of[j][k]]);
            row += part;
            squares += times(part, part);
        }
        rows = std::max(rows, row);
    }
    return std::min(rows, std::sqrt(squares)) * rounding_up;
}

Interval square(const Interval& a)
{
    Interval product = multiply(a, a);
    return {std::max(product.minimum, 0.0), product.maximum};
}

// Spectral norm of the Jacobian whose rows these are.
double jacobian_norm(std::span<const Variation> rows)
{
    double gram_norm = 0; // largest row sum of J J^T
    for (const Variation& row : rows) {
        double sum = 0;
        for (const Variation& other : rows) {
            Interval product{0, 0};
            for (size_t j = 0; j < axis_count; ++j)
                product = add(product,
                              &row == &other ? square(row.gradient[j]) : multiply(row.gradient[j], other.gradient[j]));
            sum += size_of(product);
        }
        gram_norm = std::max(gram_norm, sum);
    }
    return std::min(norm(rows, &Variation::slope), std::sqrt(gram_norm) * rounding_up);
}

Interval around_zero(double size)
{
    return {-size, size};
}

Variation roughest_of(std::span<const Variation> parts)
{
    Variation all;
    for (const Variation& part : parts) {
        if (!part.is_active) continue;
        all.is_active = true;
        roughen(all, part.continuity, part.cause);
    }
    return all;
}

Continuity of_power(uint32_t power)
{
    return power == 1 ? Continuity::c0 : power == 2 ? Continuity::c1 : Continuity::c2;
}

// A length that is not 0 is smooth in the squares of its parts: of kinks where they are 0, twice the power is left.
void smooth_in_length(std::span<const Variation> parts, Variation& made)
{
    made.continuity = Continuity::smooth;
    for (const Variation& part : parts) {
        if (!part.is_active) continue;
        const Continuity left = part.kink != 0 ? of_power(2 * part.kink_power) : part.continuity;
        roughen(made, std::max(left, part.continuity), part.cause);
    }
}

// Operations that keep a kink where the value is 0: products raise it to a power, what is smooth may be a factor.
void keep_kink(Op op, std::span<const Variation> variations, Variation& made)
{
    if (op != Op::mul && op != Op::neg && op != Op::div) return;
    uint32_t kink = 0, power = 0;
    for (size_t i = 0; i < variations.size(); ++i) {
        const Variation& a = variations[i];
        const bool is_smooth = !a.is_active || a.continuity >= Continuity::c2;
        const bool is_numerator = op != Op::div || i == 0;
        if (is_smooth && a.kink == 0) continue;
        if (a.kink == 0 || !is_numerator || (kink != 0 && kink != a.kink)) return;
        kink = a.kink;
        power += a.kink_power;
    }
    if (kink == 0) return;
    made.kink = kink;
    made.kink_power = power;
    made.continuity = of_power(power);
}

// A gradient without bound, of partials and gradients that have some.
bool overflows(const Interval* partials, std::span<const Variation> variations, const Variation& made)
{
    for (size_t i = 0; i < variations.size(); ++i)
        if (variations[i].is_active &&
            !(is_bounded(partials[i]) && std::ranges::all_of(variations[i].gradient, is_bounded)))
            return false;
    return !std::ranges::all_of(made.gradient, is_bounded);
}

} // namespace

Variation axis(size_t direction)
{
    Variation variation;
    variation.is_active = variation.has_tangent = true;
    variation.gradient[direction] = {1, 1};
    variation.slope = 1;
    return variation;
}

Variation unknown_variation(Span where)
{
    Variation variation;
    variation.is_active = variation.has_tangent = true;
    variation.continuity = Continuity::unknown;
    variation.cause = {where, {}};
    variation.gradient.fill(around_zero(infinity));
    variation.hessian.fill(around_zero(infinity));
    variation.slope = variation.curvature = infinity;
    variation.may_fault = true;
    return variation;
}

void tighten(Variation& variation)
{
    variation.slope = std::min(variation.slope, norm(variation.gradient, size_of));
    variation.curvature = std::min(variation.curvature, spectral_norm(variation.hessian));
}

void roughen(Variation& variation, Continuity continuity, const Cause& cause)
{
    if (continuity >= variation.continuity) return;
    variation.continuity = continuity;
    variation.cause = cause;
}

void jump_with(const Variation& choice, Span where, Variation& variation)
{
    if (!choice.is_active) return;
    variation.is_active = true;
    variation.kink = 0;
    if (choice.continuity <= Continuity::jump) roughen(variation, choice.continuity, {where, {}});
}

Variation join(const Variation& a, const Variation& b)
{
    if (a.crossings.empty() && b.crossings.empty()) return merge(a, b);
    return merge(settled(a), settled(b));
}

Variation merge(const Variation& a, const Variation& b)
{
    Variation all;
    all.is_active = a.is_active || b.is_active;
    all.has_tangent = a.has_tangent || b.has_tangent;
    all.may_fault = a.may_fault || b.may_fault;
    roughen(all, a.continuity, a.cause);
    roughen(all, b.continuity, b.cause);
    for (size_t j = 0; j < all.gradient.size(); ++j) all.gradient[j] = join(a.gradient[j], b.gradient[j]);
    for (size_t j = 0; j < all.hessian.size(); ++j) all.hessian[j] = join(a.hessian[j], b.hessian[j]);
    all.slope = std::max(a.slope, b.slope);
    all.curvature = std::max(a.curvature, b.curvature);
    return all;
}

Variation intersect(const Variation& a, const Variation& b)
{
    Variation both = settled(a).continuity >= settled(b).continuity ? a : b;
    both.is_active = a.is_active && b.is_active;
    both.may_fault = a.may_fault && b.may_fault;
    for (size_t j = 0; j < both.gradient.size(); ++j) both.gradient[j] = intersect(a.gradient[j], b.gradient[j]);
    for (size_t j = 0; j < both.hessian.size(); ++j) both.hessian[j] = intersect(a.hessian[j], b.hessian[j]);
    both.slope = std::min(a.slope, b.slope);
    both.curvature = std::min(a.curvature, b.curvature);
    return both;
}

Variation chain(Op op, std::span<const Interval> operands, std::span<const Variation> variations,
                const Partials& partials, bool with_curvature)
{
    Variation made = roughest_of(variations);
    for (size_t i = 0; i < variations.size(); ++i)
        made.may_fault |= variations[i].has_tangent && (variations[i].may_fault || partials.may_fault[i]);
    if (!made.is_active) return made;
    // The direction of a length is a unit vector, and turns the slower the longer it is: as an angle does.
    const bool is_norm = is_length(op), is_radial = is_norm || traits(op).shape == Shape::angle;
    double shortest = 0;
    for (const Interval& operand : operands) {
        const double least = std::max({0.0, operand.minimum, -operand.maximum});
        shortest += least * least;
    }
    shortest = std::sqrt(shortest) / rounding_up;
    const double steepest = is_norm ? 1 : traits(op).period / (2 * std::numbers::pi) / shortest;
    Interval first[operands_max];
    for (size_t i = 0; i < operands.size(); ++i)
        first[i] = is_radial ? intersect(partials.first[i], around_zero(steepest)) : partials.first[i];

    double slope = 0, curvature = 0;
    for (size_t i = 0; i < variations.size(); ++i) {
        const Variation& a = variations[i];
        if (!a.is_active) continue;
        const Interval& by = first[i];
        slope += times(size_of(by), a.slope);
        for (size_t j = 0; j < axis_count; ++j) add_product(by, a.gradient[j], made.gradient[j]);
        if (!with_curvature) continue;
        curvature += times(size_of(by), a.curvature);
        for (size_t j = 0; j < made.hessian.size(); ++j) add_product(by, a.hessian[j], made.hessian[j]);
        for (size_t l = 0; l < variations.size(); ++l) {
            const Variation& b = variations[l];
            const Interval& bend = partials.second[i][l];
            if (!b.is_active || bend.is_zero()) continue;
            curvature += times(size_of(bend), times(a.slope, b.slope));
            for (size_t j = 0; j < axis_count; ++j)
                for (size_t k = j; k < axis_count; ++k) {
                    if (a.gradient[j].is_zero() || b.gradient[k].is_zero()) continue;
                    const Interval product =
                        i == l && j == k ? square(a.gradient[j]) : multiply(a.gradient[j], b.gradient[k]);
                    add_product(bend, product, made.hessian[pair_of[j][k]]);
                }
        }
    }
    if (is_radial) { // second partials: 1 / r at most of a length r, 1 / r^2 of an angle
        const double turns = jacobian_norm(variations);
        slope = std::min(slope, times(turns, steepest));
        const double bend = times(turns * turns, steepest / shortest);
        if (with_curvature)
            curvature = std::min(curvature, bend + times(steepest, norm(variations, &Variation::curvature)));
    }
    made.may_fault |= overflows(first, variations, made);
    made.slope = slope * rounding_up;
    made.curvature = curvature * rounding_up;
    tighten(made);
    keep_kink(op, variations, made);
    if (is_norm && shortest > 0) smooth_in_length(variations, made);
    return made;
}

Variation chain(const Facts& facts, std::span<const Variation> arguments)
{
    Variation made = roughest_of(arguments);
    for (const Variation& argument : arguments) {
        made.may_fault |= argument.may_fault;
        made.may_fault |= argument.has_tangent && !facts.slope; // a bound of the slope says that there is one
    }
    if (!made.is_active) return made;
    if (facts.continuity) roughen(made, *facts.continuity, arguments.empty() ? Cause{} : arguments[0].cause);
    const double jacobian = jacobian_norm(arguments), second = norm(arguments, &Variation::curvature);
    const double slope = facts.slope.value_or(infinity), curvature = facts.curvature.value_or(infinity);

    double column[axis_count];
    for (size_t j = 0; j < axis_count; ++j) {
        column[j] = norm(arguments, [&](const Variation& argument) { return size_of(argument.gradient[j]); });
        made.gradient[j] = around_zero(times(slope, column[j]));
    }
    for (size_t j = 0; j < axis_count; ++j)
        for (size_t k = j; k < axis_count; ++k) {
            const size_t pair = pair_of[j][k];
            const double bend =
                norm(arguments, [&](const Variation& argument) { return size_of(argument.hessian[pair]); });
            made.hessian[pair] = around_zero(times(curvature, column[j] * column[k]) + times(slope, bend));
        }
    made.slope = times(slope, jacobian) * rounding_up;
    made.curvature = (times(curvature, jacobian * jacobian) + times(slope, second)) * rounding_up;
    tighten(made);
    return made;
}

} // namespace haptel::ir
