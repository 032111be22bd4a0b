#include "runtime/contact/project.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

constexpr uint32_t none = ~0u;
constexpr int steps_max = 64;

// Rows that contradict the others: so many are remembered.
constexpr std::size_t refused_max = 8;

// Sine of the angle below which a row's direction counts as within the span of others: pushes would be rounding over
// it. Both ends of a shaft are less well known, for its rows turn with it.
constexpr double independent(const glm::dvec3&)
{
    return nearly_parallel;
}
constexpr double independent(const Shaft&)
{
    return 1e-5;
}

// How a place moves by a push of the row, and how high it is over it.
glm::dvec3 direction(const HalfSpace& row, EndsGive)
{
    return row.normal;
}
double height(const HalfSpace& row, const glm::dvec3& at)
{
    return glm::dot(row.normal, at) - row.offset;
}
Shaft direction(const ShaftRow& row, EndsGive gives)
{
    return {(gives.tip ? 1 - row.arm : 0.0) * row.normal, (gives.tail ? row.arm : 0.0) * row.normal};
}
double height(const ShaftRow& row, const Shaft& at)
{
    return glm::dot(row.normal, at.at(row.arm)) - row.offset;
}

// Directions at right angles to each other that span those of the active rows, each as a combination of them.
template <class Place>
struct Basis {
    static constexpr std::size_t n = Projection<Place>::active_max;
    std::array<Place, n> unit;
    std::array<std::array<double, n>, n> made; // unit[i] = sum of made[i][j] * direction of the active row j
};

template <class Place, class Row>
Basis<Place> basis_of(std::span<const Row> rows, const Projection<Place>& now, EndsGive gives)
{
    Basis<Place> basis;
    for (std::size_t i = 0; i < now.count; ++i) {
        Place left = direction(rows[now.active[i]], gives);
        basis.made[i] = {};
        basis.made[i][i] = 1;
        for (int twice = 0; twice < 2; ++twice) // once leaves the rounding of nearly equal ones
            for (std::size_t j = 0; j < i; ++j) {
                const double along = dot(left, basis.unit[j]);
                left -= along * basis.unit[j];
                for (std::size_t k = 0; k <= j; ++k) basis.made[i][k] -= along * basis.made[j][k];
            }
        const double length = std::sqrt(dot(left, left));
        basis.unit[i] = left / length;
        for (double& part : basis.made[i]) part /= length;
    }
    return basis;
}

template <class Place>
void drop(Projection<Place>& now, std::size_t which)
{
    for (std::size_t i = which + 1; i < now.count; ++i) {
        now.active[i - 1] = now.active[i];
        now.push[i - 1] = now.push[i];
    }
    --now.count;
}

// Makes one more row hold; false if that cannot be, as rounding has it.
template <class Place, class Row>
bool take_in(std::span<const Row> rows, uint32_t row, EndsGive gives, Projection<Place>& now)
{
    const Place added = direction(rows[row], gives);
    const double least = independent(now.at) * independent(now.at) * dot(added, added);
    double push = 0;
    for (;;) {
        const Basis<Place> basis = basis_of(rows, now, gives);
        Place rest = added; // what is left of it at right angles to the active ones, and its shares of them
        std::array<double, Projection<Place>::active_max> share{};
        for (int twice = 0; twice < 2; ++twice)
            for (std::size_t i = 0; i < now.count; ++i) {
                const double along = dot(rest, basis.unit[i]);
                rest -= along * basis.unit[i];
                for (std::size_t k = 0; k <= i; ++k) share[k] += along * basis.made[i][k];
            }
        std::size_t first_to_go = now.count;
        double until_it_goes = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < now.count; ++i)
            if (share[i] > 0 && now.push[i] / share[i] < until_it_goes) {
                until_it_goes = now.push[i] / share[i];
                first_to_go = i;
            }
        const double square = dot(rest, rest);
        const bool can_move = now.count < now.active_max && square > least;
        const double until_it_holds =
            can_move ? -height(rows[row], now.at) / square : std::numeric_limits<double>::infinity();
        if (!can_move && first_to_go == now.count) return false;
        const double step = std::min(until_it_goes, until_it_holds);
        if (can_move) now.at += step * rest;
        for (std::size_t i = 0; i < now.count; ++i) now.push[i] -= step * share[i];
        push += step;
        if (until_it_holds <= until_it_goes) {
            now.active[now.count] = row;
            now.push[now.count++] = push;
            return true;
        }
        if (first_to_go == now.count) return false; // what is no number
        drop(now, first_to_go);
    }
}

// Rows that are known as well as they will be.
template <class Row>
struct KnownRows {
    std::span<const Row> all;

    std::span<const Row> rows() const { return all; }
    bool renew(uint32_t) { return false; }
};

template <class Place, class Rows>
Projection<Place> solve(Rows& known, const Place& target, double tolerance, EndsGive gives)
{
    Projection<Place> now;
    now.at = target;
    std::array<uint32_t, refused_max> refused;
    std::size_t refusals = 0;
    for (int step = 0; step < steps_max; ++step) {
        uint32_t worst = none;
        double by = tolerance;
        auto rows = known.rows();
        for (uint32_t i = 0; i < rows.size(); ++i) {
            double violation = -height(rows[i], now.at);
            while (violation > by && known.renew(i)) {
                rows = known.rows();
                violation = -height(rows[i], now.at);
            }
            if (violation <= by) continue;
            const Place way = direction(rows[i], gives);
            const auto last = refused.begin() + std::ptrdiff_t(refusals);
            if (dot(way, way) == 0 || std::find(refused.begin(), last, i) != last) // nothing of it can move
                continue;
            by = violation;
            worst = i;
        }
        if (worst == none) break;
        if (take_in(rows, worst, gives, now)) continue;
        if (refusals == refused_max) break;
        refused[refusals++] = worst;
    }
    return now;
}

template <class Rows>
Projection<glm::dvec3> solve_from(Rows& known, const glm::dvec3& target, const glm::dvec3& inside, double tolerance)
{
    Projection<glm::dvec3> held = solve(known, target, tolerance, {});
    const double share = open_share(known.rows(), inside, held.at - inside, tolerance);
    if (share < 1) held.at = inside + share * (held.at - inside);
    return held;
}

} // namespace

double open_share(std::span<const HalfSpace> rows, const glm::dvec3& from, const glm::dvec3& way,
                  double tolerance) noexcept
{
    double open = 1;
    for (const HalfSpace& row : rows) {
        const double before = height(row, from), change = glm::dot(row.normal, way);
        if (before + change < -tolerance && change < 0) open = std::min(open, std::max(0.0, before) / -change);
    }
    return open;
}

Projection<glm::dvec3> project(std::span<const HalfSpace> rows, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept
{
    KnownRows<HalfSpace> known{rows};
    return solve_from(known, target, inside, tolerance);
}

Projection<glm::dvec3> project(RenewedRows& rows, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept
{
    return solve_from(rows, target, inside, tolerance);
}

Projection<Shaft> project(std::span<const ShaftRow> rows, const Shaft& target, double tolerance,
                          EndsGive gives) noexcept
{
    KnownRows<ShaftRow> known{rows};
    return solve(known, target, tolerance, gives);
}

// What the rows leave free is what is at right angles to all of them.
glm::dmat3 compliance(ShaftEnd end, std::span<const ShaftRow> rows, const Projection<Shaft>& held,
                      EndsGive gives) noexcept
{
    const Basis<Shaft> basis = basis_of(rows, held, gives);
    glm::dmat3 give(1);
    for (std::size_t i = 0; i < held.count; ++i) {
        const glm::dvec3& own = end == ShaftEnd::tip ? basis.unit[i].tip : basis.unit[i].tail;
        give -= glm::outerProduct(own, own);
    }
    return give;
}

} // namespace haptel::runtime
