// What a ball knows of the faces around it, and from where.
#include "runtime/contact/sphere_contact.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// Of the radius: how far around a point looks at once at least, and a ball; and when anew.
constexpr double margin_of_point = 1.0 / 16, margin_of_ball = 1.0 / 8, margin_least = 1.0 / 64;

// A point looks anew where it knows less far than this share of what a look may tell.
constexpr double look_again = 0.25;

// Where there are fewer faces it looks farther around, where there are more less far: a look costs by the face, and
// each tick goes through all that are known.
constexpr std::size_t few_faces = 8, many_faces = 24;

// Where there are too many faces for a point or a ball it looks less far by this, so often below its margin.
constexpr double less_far = 1.0 / 8;
constexpr int looks_most = 4;

// The plane before a ball is that of its triangle if the cosine between their normals is 1 within rounding; a point has
// been given the triangle's own.
constexpr double one_direction = 1 - 1e-15;

} // namespace

// Finds the faces within the radius and a margin, or within less where there are too many; a ball's in groups. False:
// nothing less is left.
bool SphereContact::find_around(double margin, std::size_t far_most) noexcept
{
    close_.margin = -1;
    const double near = margin_of_point * radius_, beyond = radius_ + distance_rounding;
    if (!is_point_) margin = std::max(margin, margin_of_ball * radius_);
    for (int looks = 0; looks < looks_most;) {
        const bool far = is_point_ && margin > near;
        const bool all = is_point_ ? faces_.find(proxy_.at, beyond + margin, far ? far_most : NearFaces::faces_most)
                                   : faces_.find_groups(proxy_.at, grown_, beyond + margin);
        ++counters_.sweeps;
        counters_.triangles_tested += faces_.boxes();
        if (all) {
            around_ = {proxy_.at, margin};
            if (faces_.count() == 0) close_ = around_;
            if (faces_.count() < few_faces) margin_ = std::min(2 * std::max(margin, margin_), Lattice::extent);
            if (faces_.count() > many_faces) margin_ = std::max(0.5 * margin, margin_least * radius_);
            return true;
        }
        margin = far ? std::max(near, less_far * margin) : less_far * margin;
        margin_ = margin;
        looks += !far;
    }
    around_.margin = -1;
    return false;
}

// Looks anew where less is known around than it may need, or where many groups were looked into that it has left.
// `goes` of the way at most this tick; as much as a quarter of its rounds have to do for is seen at once. A point
// that flies looks farther each time, while there is little. How far it may go now; below 0: it cannot look.
double SphereContact::look_as_far_as(double way, double goes, bool flies) noexcept
{
    const double enough = is_point_ ? look_again * margin_ : margin_least * radius_;
    if (const double room = around_.room(proxy_.at); room >= std::min(way, enough) && !faces_.is_crowded()) return room;
    const double farthest = std::max({margin_, margin_of_point * radius_, 4 * goes / rounds_max});
    const double last = flies ? (faces_.count() < few_faces ? 2 : 1) * around_.margin : 0;
    find_around(std::clamp(std::max(2 * way, last), margin_least * radius_, farthest),
                last > 2 * way ? many_faces : far_faces);
    return around_.margin;
}

// A point meets few faces, and what lies behind others does not hold it at every edge. A ball meets hundreds: its
// planes serve for several rounds, but for those that hold it.
void SphereContact::pick(double reach, Laid laid) noexcept
{
    close_ = {proxy_.at, reach};
    laid_ = laid;
    faces_.pick(proxy_.at, grown_, reach, is_point_ ? NearFaces::Screened::yes : NearFaces::Screened::no, laid);
    if (faces_.rows().empty()) close_.margin = std::min(around_.room(proxy_.at), faces_.gap());
}

double SphereContact::look_from(const glm::dvec3& at, double reach, std::size_t most, bool is_first) noexcept
{
    proxy_.at = at;
    const double room = look_as_far_as(reach, reach);
    if (room < 0) return 0;
    grow();
    double within = std::min(reach, room);
    if (faces_.rows().empty() && close_.room(at) >= within) return within;
    if (close_.centre == at && close_.margin >= within && laid_ == Laid::here && faces_.rows().size() <= most) {
        faces_.keep_near(within);
        close_.margin = within;
        return within;
    }
    const Laid laid = is_first ? Laid::ahead : Laid::here;
    for (pick(within, laid); faces_.rows().size() > most; pick(within, laid))
        if ((within *= less_far) < 1) return 0;
    return within;
}

std::size_t SphereContact::touching() noexcept
{
    const auto [count, gap] = faces_.touching(proxy_.at, radius_);
    return gap > radius_ ? 0 : count;
}

// Whether what holds it are the planes of their own triangles, over the inside of which it is.
bool SphereContact::stands(const Held& held) noexcept
{
    return std::all_of(held.row.begin(), held.row.begin() + std::ptrdiff_t(held.count), [&](const Row& row) {
        const glm::dvec3& facet = surface_->faces[row.face].normal;
        const bool is_own = is_point_ ? row.normal == facet || row.normal == -facet
                                      : std::fabs(glm::dot(row.normal, facet)) > one_direction;
        if (!is_own) return false;
        const NearestPoint& foot = nearest_on(row.face, proxy_.at);
        return glm::dot(row.normal, proxy_.at - foot.at) <= grown_ + 4 * distance_rounding &&
               glm::all(glm::greaterThan(foot.barycentric, glm::dvec3(0)));
    });
}

} // namespace haptel::runtime
