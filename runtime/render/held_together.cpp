#include "runtime/render/held_together.h"

#include "runtime/geometry/rise.h"
#include "runtime/texture/surface_texture.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr double exact_within = 1e-9; // of the way from the hand to the proxy

// Of the way from the hand to the proxy: what holds so much of it keeps the hand's places on what else is touched
// still. With five times as much closed paths in smooth valleys give ten times as much.
constexpr double holds_still = 0.05;

// Squared sine of the angle within which facets count as of one direction, 6 degrees (up to 8 of a shaft): what holds
// goes over from one to the other on so short a way that the force would step.
constexpr double one_direction = 0.01;

// A row is eased in until it is so many times as deep as it would begin too early: while that stays, its force grows by
// at most 2 / 5 faster than its depth.
constexpr double eased_over = 5;

// What one of several contacts holds, of how deep the hand is below what is touched there: two walls at right angles
// hold all of it each, several facets nearly in one plane hold it together. Along the way from the hand to the proxy
// the shares of damping add up to 1, but in grooves narrower than a right angle: more than all of it is held by none.
double share_of(const Contact& contact, double below_m)
{
    return contact.depth_m < below_m ? contact.depth_m / below_m : 1.0;
}

// Along what another row touches, of the place where it does: how that goes by a push of this one.
glm::dvec3 way_of(const Row& row, const Row& other)
{
    return tangential(row.direction.at(other.contact.along), other.normal);
}

// All places that the row leaves, of a probe that contact holds by that way.
ShaftRow plane_of(const Row& row, const Shaft& way_m)
{
    return {row.felt_normal, dot(row.felt_direction, way_m) + row.raised_m, row.contact.along};
}

// What rows do not hold of a way, (1 + sum of gain d d^T)^-1 of it, d their directions: by rank-one updates.
class Unheld {
public:
    void add(const Shaft& direction, double gain) noexcept;
    Shaft of(const Shaft& way) const noexcept;

private:
    struct Update { // left as it is until it is told
        glm::dvec3 tip, tail;
        double weight;
    };
    std::array<Update, CreaseRows::rows_most> updates_;
    std::size_t count_ = 0;
};

void Unheld::add(const Shaft& direction, double gain) noexcept
{
    const Shaft left = of(direction);
    updates_[count_++] = {left.tip, left.tail, gain / (1 + gain * dot(direction, left))};
}

Shaft Unheld::of(const Shaft& way) const noexcept
{
    Shaft left = way;
    for (const auto& [tip, tail, weight] : std::span(updates_.data(), count_)) {
        const Shaft direction{tip, tail};
        left -= weight * dot(direction, way) * direction;
    }
    return left;
}

} // namespace

HeldTogether::HeldTogether(std::span<Row> all, At where) noexcept
{
    for (Row& row : all) {
        const bool elsewhere = where != At::both && (row.contact.along > 0) != (where == At::tail);
        if (elsewhere || row.contact.unsettled || !(row.contact.depth_m > 0)) continue;
        row.normal = row.placement->direction_to_world(row.contact.normal);
        row.direction = Shaft::pushed_at(row.contact.along, row.normal);
        way_m_ += row.contact.depth_m * row.direction;
        row_[count_++] = &row;
    }
    if (count_ < 2 || !(length(way_m_) > 0)) {
        count_ = 0;
        return;
    }
    for (Row* row : rows()) {
        row->below_m = dot(row->direction, way_m_);
        row->share = share_of(row->contact, row->below_m);
    }
    hold_still();
    for (Row* row : rows()) {
        glm::dvec3 moved_m(0);
        for (const Row* other : rows())
            if (other != row) moved_m += (other->still_m - other->contact.depth_m) * way_of(*other, *row);
        row->contact.proxy_m += row->placement->direction_to_object(moved_m);
    }
}

// In how far each row does, and how that changes with the hand's place: by what all others leave of its direction, each
// in so far as it holds. Of what all rows leave, its own part is taken back.
void HeldTogether::hold_still() const noexcept
{
    const double way_m = length(way_m_);
    const auto gain = [](double holds) { return holds / (1 - (1 - one_direction) * holds); };
    Unheld by_all;
    for (Row* row : rows()) {
        row->held = Rise(row->contact.depth_m / (holds_still * way_m)).value;
        by_all.add(row->direction, gain(row->held));
    }
    for (Row* row : rows()) {
        const Shaft rest = by_all.of(row->direction),
                    left = 1 / (1 - gain(row->held) * dot(row->direction, rest)) * rest; // by the others
        const double square = dot(row->direction, left);
        row->depth_dp = -1 / square * left;
        const double depth_m = row->contact.depth_m, q = depth_m / (holds_still * way_m);
        const Rise rise(q);
        row->still_m = depth_m * rise.value;
        row->still_dp =
            holds_still * q * q * rise.slope / way_m * way_m_ + (rise.value + q * rise.slope) * row->depth_dp;
        row->off_m = std::sqrt(square) * depth_m;
        row->off_dp = std::sqrt(square) * row->depth_dp;
    }
}

// By the places of both ends, what changes so with the place on a row: that goes with the hand, and with what the
// others hold still.
Shaft HeldTogether::felt_by(const Row& row, const glm::dvec3& by_place) const noexcept
{
    Shaft felt = Shaft::pushed_at(row.contact.along, by_place);
    for (const Row* other : rows())
        if (other != &row) felt += glm::dot(by_place, way_of(*other, row)) * other->still_dp;
    return felt;
}

// How far the proxy is below what is felt on a row, mostly less than 0, and how that changes with the hand's place, as
// the proxy stays.
void HeldTogether::raise(Row& row) const noexcept
{
    glm::dvec3 left_m = way_m_.at(row.contact.along); // from where it is felt to the proxy
    for (const Row* other : rows())
        if (other != &row) left_m -= other->still_m * way_of(*other, row);
    row.raised_m = row.felt_m - glm::dot(row.felt_normal, left_m);
    row.raised_dp = felt_by(row, row.felt_normal + row.felt_dp - left_m * row.normal_dp);
}

// The gradient of how far `at_m` is below the plane of a row (plane_of), as that place stays.
Shaft HeldTogether::below_dp(const Row& row, const Shaft& way_m, const Shaft& at_m) const noexcept
{
    const double along = row.contact.along;
    return row.raised_dp - row.felt_direction + felt_by(row, (way_m - at_m).at(along) * row.normal_dp);
}

// Where the others hold the probe lower than this row is, it comes to it before contact does, and the row would begin
// with a step. So its plane is lower at first, by what it adds to the way: the root of what it adds to the square, of
// which the gradient does not step where others begin to push.
void HeldTogether::ease_in() const noexcept
{
    const double tolerance_m = exact_within * length(way_m_);
    for (Row* row : rows()) {
        // Of a hand that is farther on by this row's push: as where it begins.
        const Shaft way_m = way_m_ - row->contact.depth_m * row->direction;
        std::array<ShaftRow, CreaseRows::rows_most> planes;
        std::array<const Row*, CreaseRows::rows_most> of;
        std::size_t count = 0;
        for (const Row* other : rows())
            if (other != row) planes[count] = plane_of(*other, way_m), of[count++] = other;
        planes[count] = plane_of(*row, way_m), of[count] = row;
        const auto held_by = [&](std::size_t first) {
            return project(std::span<const ShaftRow>(planes.data(), first), {}, tolerance_m);
        };
        const Projection<Shaft> others = held_by(count);
        if (dot(row->felt_direction, way_m - others.at) + row->raised_m <= tolerance_m) continue;
        const Projection<Shaft> all = held_by(count + 1);
        const double more_m = std::sqrt(std::max(0.0, dot(all.at, all.at) - dot(others.at, others.at))),
                     left = more_m > tolerance_m ? 1 - row->off_m / (eased_over * more_m) : 0;
        if (left <= 0) continue;
        Shaft more_dp; // times more_m
        const auto add = [&](const Projection<Shaft>& at, double sign) {
            for (std::size_t i = 0; i < at.count; ++i) {
                const Row& active = *of[at.active[i]];
                more_dp +=
                    sign * at.push[i] *
                    (below_dp(active, way_m, at.at) - dot(active.felt_direction, row->direction) * row->depth_dp);
            }
        };
        add(all, 1);
        add(others, -1);
        row->eased_m = more_m * left * left;
        row->eased_dp = (left * left + 2 * (1 - left) * left) / more_m * more_dp - 2 / eased_over * left * row->off_dp;
    }
    for (Row* row : rows()) {
        row->raised_m -= row->eased_m;
        row->raised_dp -= row->eased_dp;
    }
}

void HeldTogether::push() const noexcept
{
    const double way_m = length(way_m_);
    const auto is_facet = [&](const Row* row) {
        return std::fabs(row->raised_m) <= exact_within * way_m && length(row->raised_dp) <= exact_within &&
               row->felt_normal == row->normal;
    };
    for (Row* row : rows()) raise(*row);
    std::array<double, CreaseRows::rows_most> push_m{};
    double told = 1;
    Shaft at_m = way_m_;
    if (std::ranges::all_of(rows(), is_facet)) {
        for (std::size_t i = 0; i < count_; ++i) push_m[i] = row_[i]->contact.depth_m;
    } else {
        ease_in();
        std::array<ShaftRow, CreaseRows::rows_most> planes;
        for (std::size_t i = 0; i < count_; ++i) planes[i] = plane_of(*row_[i], way_m_);
        const Projection<Shaft> at =
            project(std::span<const ShaftRow>(planes.data(), count_), {}, exact_within * way_m);
        double pushes_m = 0;
        for (std::size_t i = 0; i < at.count; ++i) pushes_m += push_m[at.active[i]] = at.push[i];
        told = std::min(1.0, opposed_most * length(at.at) / pushes_m);
        at_m = at.at;
    }
    for (std::size_t i = 0; i < count_; ++i) {
        Row& row = *row_[i];
        const double along = row.contact.along;
        ObjectForce& force = row.force;
        const Shaft more_n = -told * (force.felt_n_per_m * push_m[i] * below_dp(row, way_m_, at_m) +
                                      Shaft::pushed_at(along, row.share * force.spring_n));
        row.at_ends_n = more_n;
        const glm::dvec3 here_n = row.contact.by_shaft ? more_n.tip + more_n.tail
                                  : along > 0          ? more_n.tail
                                                       : more_n.tip;
        const double along_n = glm::dot(force.force_n + here_n, force.normal);
        if (along_n < 0) force.force_n -= std::max(along_n, -glm::length(here_n)) * force.normal; // never pulls
    }
}

} // namespace haptel::runtime
