// Of the faces around a ball those that it may touch on its way: the planes that hold it.
#include "runtime/contact/near_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace haptel::runtime {

namespace {

// Behind how many planes others are left out, and by how many lattice units they may rise above one: faces in one plane
// do, as their vertices are rounded.
constexpr std::size_t screens_most = 4;
constexpr double rises = 1024;

// Of the radius: planes seen from so near lie within 1/128 of it as those seen from here.
constexpr double as_good = 1.0 / 8;

} // namespace

void NearFaces::pick(const glm::dvec3& centre, double radius, double reach, Screened screened, Laid laid) noexcept
{
    picked_.clear();
    see_from(centre);
    radius_ = radius;
    picked_at_ = centre;
    if (glm::distance(centre, renewed_at_) > as_good * radius) {
        renewed_at_ = centre;
        renewed_since_ = centres_;
    }
    near_ = radius + reach + distance_rounding;
    screened_ = screened == Screened::yes;
    place_of_.clear();
    const std::size_t known = planes_.size();
    if (screened_) {
        for_each_close([&](uint32_t place) { place_of_.push_back(place); });
        return pick_screened(laid);
    }
    const uint64_t since = laid == Laid::before ? renewed_since_ : centres_;
    const auto take = [&](uint32_t place) {
        if (laid_[place] < since) {
            lay(place);
            if (ahead(planes_[place]) > near_) return;
        }
        if (is_group(place) && ahead(planes_[place]) < radius && look_into(place)) return;
        picked_.push_back(planes_[place]);
        picked_.back().offset += radius;
        place_of_.push_back(place);
    };
    for_each_close(take);
    for (std::size_t place = known; place < planes_.size(); ++place) // from behind groups
        if (!(ahead(planes_[place]) > near_)) take(static_cast<uint32_t>(place));
}

// Of those known by now all that are near enough by their planes. Which of them is as good as random, so all are
// written, and those that are near are counted.
template <class Visit>
void NearFaces::for_each_close(Visit&& visit) noexcept
{
    std::array<uint32_t, 64> close;
    const std::size_t known = planes_.size();
    for (std::size_t first = 0; first < known; first += close.size()) {
        std::size_t count = 0;
        for (std::size_t place = first; place < std::min(first + close.size(), known); ++place) {
            close[count] = static_cast<uint32_t>(place);
            count += !(ahead(planes_[place]) > near_);
        }
        for (std::size_t i = 0; i < count; ++i) visit(close[i]);
    }
}

// The nearest first: what lies behind it need not be laid.
void NearFaces::pick_screened(Laid laid) noexcept
{
    std::size_t left = place_of_.size(); // that are not screened
    const auto is_near = [&](std::size_t i) {
        const uint32_t place = place_of_[i];
        if (laid_[place] < centres_) lay(place);
        if (!(ahead(planes_[place]) > near_)) return true;
        place_of_[i] = place_of_[--left];
        place_of_[left] = place_of_.back();
        place_of_.pop_back();
        return false;
    };
    std::size_t screen = 0;
    while (screen < screens_most && screen < left) {
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = screen; i < left;) {
            if (!(ahead(planes_[place_of_[i]]) < least)) { // laid it would be farther still
                ++i;
            } else if (is_near(i)) {
                if (const double here = ahead(planes_[place_of_[i]]); here < least) least = here, nearest = i;
                ++i;
            }
        }
        if (screen == left) break; // none is near enough
        std::swap(place_of_[screen], place_of_[nearest]);
        picked_.push_back(seen(place_of_[screen], laid));
        for (std::size_t i = left; i-- > screen + 1;)
            if (is_behind(place_of_[i], picked_[screen])) std::swap(place_of_[i], place_of_[--left]);
        ++screen;
    }
    for (std::size_t i = screen; i < left;)
        if (is_near(i)) picked_.push_back(seen(place_of_[i++], laid));
}

void NearFaces::keep_near(double reach) noexcept
{
    std::size_t kept = 0;
    for (std::size_t i = 0; i < picked_.size(); ++i) {
        if (ahead(picked_[i]) > reach + distance_rounding) continue;
        picked_[kept] = picked_[i];
        place_of_[kept++] = place_of_[i];
    }
    const auto screened = place_of_.begin() + std::ptrdiff_t(picked_.size());
    place_of_.erase(place_of_.begin() + std::ptrdiff_t(kept), screened);
    picked_.resize(kept);
}

bool NearFaces::renew(uint32_t picked) noexcept
{
    const std::size_t place = place_of_[picked], known = planes_.size();
    if (laid_[place] != centres_) {
        lay(place);
        picked_[picked] = {planes_[place].normal, planes_[place].offset + radius_};
        return true;
    }
    if (!is_group(place) || !look_into(place)) return false;
    picked_[picked] = planes_[place]; // nothing is held by that any more
    const double near = near_ + glm::distance(centre_, picked_at_);
    for (std::size_t behind = known; behind < planes_.size(); ++behind) {
        if (ahead(planes_[behind]) < radius_ && !is_group(behind)) lay(behind); // it does not separate them
        if (ahead(planes_[behind]) > near) continue;
        picked_.push_back({planes_[behind].normal, planes_[behind].offset + radius_});
        place_of_.push_back(static_cast<uint32_t>(behind));
    }
    return true;
}

bool NearFaces::is_behind(std::size_t place, const HalfSpace& row) const noexcept
{
    const double behind = row.offset - radius_ + rises;
    return std::all_of(corners_[place].begin(), corners_[place].end(),
                       [&](const glm::dvec3& corner) { return glm::dot(row.normal, corner) <= behind; });
}

double NearFaces::open(const glm::dvec3& way, double tolerance, std::span<const uint32_t> along) noexcept
{
    double open = 1;
    for (uint32_t i = 0; i < picked_.size(); ++i) { // what was behind a group comes behind them
        if (ahead(picked_[i]) + glm::dot(picked_[i].normal, way) >= -tolerance) continue;
        double share = open_share({&picked_[i], 1}, centre_, way, tolerance);
        while (share < open && renew(i)) share = open_share({&picked_[i], 1}, centre_, way, tolerance);
        if (share >= open) continue;
        const bool is_along = std::find(along.begin(), along.end(), i) != along.end();
        const auto screens = [&](uint32_t row) { return is_behind(place_of_[i], picked_[row]); };
        if (!is_along && !is_group(place_of_[i]) && std::any_of(along.begin(), along.end(), screens)) continue;
        open = share;
    }
    return open;
}

// Of a triangle that the ball touches the triangle's own plane, where that makes no difference: rounding does not tilt
// it.
HalfSpace NearFaces::seen(std::size_t place, Laid laid) const noexcept
{
    const HalfSpace& plane = planes_[place];
    const bool touches = ahead(plane) < radius_ + rises;
    if (touches || laid == Laid::ahead) {
        const glm::dvec3& facet = surface_->faces[faces_[place]].normal;
        const double cosine = glm::dot(plane.normal, facet);
        const glm::dvec3 normal = cosine < 0 ? -facet : facet;
        const auto& [a, b, c] = corners_[place];
        const HalfSpace own{normal,
                            std::max({glm::dot(normal, a), glm::dot(normal, b), glm::dot(normal, c)}) + radius_};
        if (touches ? std::fabs(cosine) > 1 - rises / radius_ && ahead(own) > -rises : ahead(own) > rises) return own;
    }
    return {plane.normal, plane.offset + radius_};
}

NearFaces::Touching NearFaces::touching(const glm::dvec3& centre, double within) noexcept
{
    const auto above = [at = centre](const HalfSpace& plane) { return glm::dot(plane.normal, at) - plane.offset; };
    const auto before = [&](std::size_t i) { // of a triangle that lies ahead its own plane may be touched beside it
        const double seen = above(picked_[i]);
        if (!screened_) return seen;
        const double laid = above(planes_[place_of_[i]]) - radius_;
        return laid > seen + rises ? laid : seen;
    };
    const auto known = [&](std::size_t i, double most) {
        double here = before(i);
        while (!screened_ && here <= most && renew(static_cast<uint32_t>(i))) here = before(i);
        return here;
    };
    std::size_t nearest = 0;
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < picked_.size(); ++i)
        if (const double here = before(i); here < gap) gap = here, nearest = i;
    if (gap <= near_) gap = known(nearest, near_);
    std::size_t count = 0;
    for (std::size_t i = 0; i < picked_.size(); ++i) { // what was behind a group comes behind them
        const double here = known(i, std::min(std::max(0.0, gap) + within, near_));
        if (here > std::max(0.0, gap) + within) continue;
        gap = std::min(gap, here);
        std::swap(picked_[i], picked_[count]);
        std::swap(place_of_[i], place_of_[count++]);
    }
    for (std::size_t i = count; i-- > 0;) {
        if (before(i) <= std::max(0.0, gap) + within) continue;
        std::swap(picked_[i], picked_[--count]);
        std::swap(place_of_[i], place_of_[count]);
    }
    return {count, gap};
}

} // namespace haptel::runtime
