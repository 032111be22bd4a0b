#include "runtime/geometry/half_spaces.h"

#include <algorithm>
#include <limits>

namespace haptel::runtime {

namespace {

constexpr uint32_t none = ~0u;
constexpr int steps_max = 64;

// Sine of the angle below which a normal counts as within the span of others.
constexpr double independent = 1e-7;

// A normal as a combination of the active ones, and what is left of it at right angles to them all.
struct Split {
    std::array<double, 3> share{};
    glm::dvec3 rest;
};

Split split(std::span<const HalfSpace> spaces, const NearestInHalfSpaces& now, const glm::dvec3& normal)
{
    // Gram and Schmidt over the active normals, each kept as a combination of them.
    std::array<glm::dvec3, 3> basis;
    std::array<std::array<double, 3>, 3> made{}; // basis[i] = sum of made[i][j] * active normal j
    for (std::size_t i = 0; i < now.count; ++i) {
        glm::dvec3 direction = spaces[now.active[i]].normal;
        made[i][i] = 1;
        for (int twice = 0; twice < 2; ++twice)
            for (std::size_t j = 0; j < i; ++j) {
                const double along = glm::dot(direction, basis[j]);
                direction -= along * basis[j];
                for (std::size_t k = 0; k <= j; ++k) made[i][k] -= along * made[j][k];
            }
        const double length = glm::length(direction);
        basis[i] = direction / length;
        for (double& part : made[i]) part /= length;
    }
    Split result{{}, normal};
    for (int twice = 0; twice < 2; ++twice)
        for (std::size_t i = 0; i < now.count; ++i) {
            const double along = glm::dot(result.rest, basis[i]);
            result.rest -= along * basis[i];
            for (std::size_t k = 0; k <= i; ++k) result.share[k] += along * made[i][k];
        }
    return result;
}

uint32_t most_violated(std::span<const HalfSpace> spaces, const glm::dvec3& at, double tolerance)
{
    uint32_t worst = none;
    double by = tolerance;
    for (uint32_t i = 0; i < spaces.size(); ++i) {
        const double violation = spaces[i].offset - glm::dot(spaces[i].normal, at);
        if (violation <= by) continue;
        by = violation;
        worst = i;
    }
    return worst;
}

void drop(NearestInHalfSpaces& now, std::size_t which)
{
    for (std::size_t i = which + 1; i < now.count; ++i) {
        now.active[i - 1] = now.active[i];
        now.push[i - 1] = now.push[i];
    }
    --now.count;
}

// Makes one more space hold; false if that cannot be, as rounding has it.
bool take_in(std::span<const HalfSpace> spaces, uint32_t space, NearestInHalfSpaces& now)
{
    const HalfSpace& added = spaces[space];
    double push = 0;
    for (;;) {
        const Split parts = split(spaces, now, added.normal);
        std::size_t first_to_go = 3;
        double until_it_goes = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < now.count; ++i)
            if (parts.share[i] > 0 && now.push[i] / parts.share[i] < until_it_goes) {
                until_it_goes = now.push[i] / parts.share[i];
                first_to_go = i;
            }
        const double square = glm::dot(parts.rest, parts.rest);
        const bool can_move = now.count < 3 && square > independent * independent;
        const double violation = added.offset - glm::dot(added.normal, now.at);
        const double until_it_holds = can_move ? violation / square : std::numeric_limits<double>::infinity();
        if (!can_move && first_to_go == 3) return false;
        const double step = std::min(until_it_goes, until_it_holds);
        if (can_move) now.at += step * parts.rest;
        for (std::size_t i = 0; i < now.count; ++i) now.push[i] -= step * parts.share[i];
        push += step;
        if (until_it_holds <= until_it_goes) {
            now.active[now.count] = space;
            now.push[now.count++] = push;
            return true;
        }
        if (first_to_go == 3) return false; // what is no number
        drop(now, first_to_go);
    }
}

} // namespace

double open_share(std::span<const HalfSpace> spaces, const glm::dvec3& from, const glm::dvec3& way,
                  double tolerance) noexcept
{
    double open = 1;
    for (const HalfSpace& space : spaces) {
        const double before = glm::dot(space.normal, from) - space.offset, change = glm::dot(space.normal, way);
        if (before + change < -tolerance && change < 0) open = std::min(open, std::max(0.0, before) / -change);
    }
    return open;
}

NearestInHalfSpaces nearest_in(std::span<const HalfSpace> spaces, const glm::dvec3& target, const glm::dvec3& inside,
                               double tolerance) noexcept
{
    NearestInHalfSpaces now;
    now.at = target;
    for (int step = 0; step < steps_max; ++step) {
        const uint32_t space = most_violated(spaces, now.at, tolerance);
        if (space == none) return now;
        if (!take_in(spaces, space, now)) break;
    }
    const double share = open_share(spaces, inside, now.at - inside, tolerance);
    if (share < 1) now.at = inside + share * (now.at - inside);
    return now;
}

} // namespace haptel::runtime
