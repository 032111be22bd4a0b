#include "tests/runtime/contact/accomplice.h"

#include <algorithm>
#include <cmath>

namespace haptel::test {

using glm::dvec3;
using runtime::Proxy;

namespace {

dvec3 on_grid(const dvec3& p)
{
    return glm::round(p * 1024.0) / 1024.0;
}

// A hand that lies on a face, an edge or a vertex is taken to be moved by (e, e^2, e^3): as near to that as the grid
// has; by less where something else is in the way at that distance.
dvec3 beside(const dvec3& hand, int attempt = 0)
{
    return hand + on_grid(std::exp2(-2 * (attempt % 6)) * dvec3(192, 0.375, 1.0 / 1024));
}

} // namespace

dvec3 Accomplice::in_ball()
{
    for (;;) {
        const dvec3 p(2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1);
        if (glm::dot(p, p) < 1) return p;
    }
}

void Accomplice::put(const dvec3& hand)
{
    before_ = hand;
    at_ = mesh_.holds(hand) ? beside(hand) : hand;
    last_ = {at_, {}};
    last_.proxy.at = hand;
    placed_ = true;
}

// Points near the proxy, on the claimed side, the likeliest first.
dvec3 Accomplice::witness(const Proxy& proxy, int attempt)
{
    if (proxy.on == Proxy::On::nothing) return mesh_.holds(proxy.at) ? beside(proxy.at, attempt) : proxy.at;
    const dvec3 &a = mesh_.corner(proxy.face, 0), &b = mesh_.corner(proxy.face, 1), &c = mesh_.corner(proxy.face, 2);
    double u = std::sqrt(uniform()), v = uniform();
    if (attempt == 0) u = 2.0 / 3, v = 0.5; // the middle
    const dvec3 inside = (1 - u) * a + u * (1 - v) * b + u * v * c;
    const dvec3 start = mesh_.nearest(proxy.face, proxy.at);
    const double length = glm::length(inside - start);
    const double nearest = attempt < 60 ? 1.0 / 32 : 0.9; // so near first that walls beside the proxy are farther
    const double way = attempt == 0 ? 8.0 : nearest * reach * std::exp2(-8 * uniform());
    const dvec3 foot = length > way ? start + way / length * (inside - start) : inside;
    const double height = attempt == 0 ? 2.0 : way * std::exp2(-10 * uniform());
    return on_grid(foot + (proxy.side ? -height : height) * mesh_.normal(proxy.face));
}

bool Accomplice::bears_out(const Proxy& proxy, const dvec3& point) const
{
    if (glm::length(point - proxy.at) > reach) return false;
    if (proxy.on == Proxy::On::nothing) return true;
    if (mesh_.side_of(proxy.face, point) != (proxy.side ? -1 : 1)) return false;
    const dvec3 n = mesh_.normal(proxy.face);
    const double height = glm::dot(point - mesh_.corner(proxy.face, 0), n);
    const dvec3 beyond = on_grid(point - (height + (proxy.side ? -1.0 : 1.0) / 128) * n);
    return mesh_.side_of(proxy.face, beyond) != (proxy.side ? -1 : 1) && mesh_.touches_only(proxy.face, point, beyond);
}

// A point near the place, or just above one of the faces that pass near it, at any scale.
dvec3 Accomplice::scout(const dvec3& around, const std::vector<uint32_t>& faces, double radius)
{
    dvec3 p = around + radius * in_ball();
    if (!faces.empty() && uniform() < 0.7) {
        const uint32_t face = faces[random_() % faces.size()];
        const double height = radius * std::exp2(-12 * uniform());
        p = mesh_.nearest(face, p) + (uniform() < 0.5 ? height : -height) * mesh_.normal(face);
    }
    return on_grid(p);
}

// Grows what the accomplice can see, and what the goals can see, until they meet.
bool Accomplice::search(const Proxy& proxy, const Points& goals, int most)
{
    const std::vector<uint32_t> faces[2] = {mesh_.near(before_, reach), mesh_.near(proxy.at, reach)};
    Points here{at_}, there = goals;
    std::vector<dvec3> root = goals; // the goal that each of `there` leads to
    for (int i = 0; i < most; ++i) {
        const int end = int(random_() % 2);
        const dvec3& centre = end == 0 ? before_ : proxy.at;
        const double radius = reach * (i % 2 == 0 ? uniform() : std::exp2(-8 * uniform()));
        const dvec3 p = scout(centre, faces[end], radius);
        if (glm::length(p - centre) > reach) continue;
        const auto sees = [&](const dvec3& q) { return mesh_.open(p, q); };
        // The latest first: they are deepest in whatever the way leads through.
        const auto from = std::find_if(here.rbegin(), here.rend(), sees);
        const auto to = std::find_if(there.rbegin(), there.rend(), sees);
        if (from != here.rend() && to != there.rend()) {
            at_ = root[size_t(there.rend() - to) - 1];
            return true;
        }
        if (from != here.rend()) {
            // A free proxy has one place only. If that is on a triangle, a point within reach must do: beside a plane
            // that is nearly level the grid cannot tell the sides that ties are decided by.
            const bool anywhere = proxy.on != Proxy::On::nothing || mesh_.holds(proxy.at);
            const bool good = goals.empty() ? glm::length(p - proxy.at) <= reach : anywhere && bears_out(proxy, p);
            if (good) {
                at_ = p;
                return true;
            }
            here.push_back(p);
        } else if (to != there.rend()) {
            const dvec3 goal = root[size_t(there.rend() - to) - 1];
            there.push_back(p);
            root.push_back(goal);
        }
    }
    return false;
}

bool Accomplice::could_go_nearer_from(const dvec3& point, const dvec3& hand) const
{
    const double way = 0x1p20;
    const dvec3 to_hand = hand - point;
    if (glm::length(to_hand) < 4 * way) return false;
    std::vector<dvec3> ways{to_hand};
    const std::vector<uint32_t> faces = mesh_.near(before_, reach);
    for (size_t i = 0; i < faces.size(); ++i) {
        const dvec3 n = mesh_.normal(faces[i]);
        ways.push_back(to_hand - glm::dot(to_hand, n) * n);
        for (size_t j = 0; j < i; ++j) {
            const dvec3 crease = glm::cross(n, mesh_.normal(faces[j]));
            ways.push_back(glm::dot(crease, to_hand) * crease);
        }
    }
    return std::any_of(ways.begin(), ways.end(), [&](const dvec3& direction) {
        const double length = glm::length(direction);
        if (length == 0 || glm::dot(direction, to_hand) < 0.05 * length * glm::length(to_hand)) return false;
        return mesh_.open(point, on_grid(point + way / length * direction));
    });
}

bool Accomplice::could_go_nearer(const Proxy& proxy, const dvec3& hand)
{
    if (!placed_ || !could_go_nearer_from(at_, hand)) return false;
    int asked = 0;
    for (int attempt = 1; attempt < 100 && asked < 12; ++attempt) {
        const dvec3 point = witness(proxy, attempt);
        if (!bears_out(proxy, point)) continue;
        ++asked;
        if (!could_go_nearer_from(point, hand)) return false;
    }
    return asked > 0;
}

bool Accomplice::follow(const Proxy& proxy)
{
    if (!placed_) return false;
    const Followed now{at_, proxy};
    placed_ = go(proxy);
    before_ = proxy.at;
    last_ = now;
    return placed_;
}

bool Accomplice::go(const Proxy& proxy)
{
    Points goals;
    for (int attempt = 0; attempt < 200 && goals.size() < 8; ++attempt) {
        const dvec3 goal = witness(proxy, attempt);
        if (!bears_out(proxy, goal)) continue;
        // From tie to tie, along an edge, it may be open nearer by only.
        const dvec3 nearer = beside(before_, attempt);
        const bool ties = attempt > 0 && proxy.on == Proxy::On::nothing && mesh_.holds(proxy.at);
        if (mesh_.open(at_, goal) || (ties && mesh_.open(at_, nearer) && mesh_.open(nearer, goal))) {
            detours += attempt > 0;
            at_ = goal;
            return true;
        }
        goals.push_back(goal);
    }
    if (goals.empty()) {
        const bool there =
            proxy.on != Proxy::On::nothing && glm::length(proxy.at - mesh_.nearest(proxy.face, proxy.at)) <= reach;
        if (!there) return false;
        ++sideless;
    }
    ++detours;
    for (int i = 0; i < 4; ++i) // anew, rather than long: what a search costs grows with the square of its tries
        if (search(proxy, goals, tries / 8)) return true;
    return go_otherwise(proxy) || search(proxy, goals, tries);
}

// Where a wall stands within reach of the proxy's last place, both of its sides bear that place out, and the accomplice
// may have chosen the one that the proxy did not come to. It goes the last step anew, to other places.
bool Accomplice::go_otherwise(const Proxy& proxy)
{
    for (int i = 0; i < tries; ++i) {
        const dvec3 point = witness(last_.proxy, 1 + i % 200);
        if (!bears_out(last_.proxy, point) || !mesh_.open(last_.at, point)) continue;
        for (int attempt = 0; attempt < 8; ++attempt) {
            const dvec3 goal = witness(proxy, attempt);
            if (!bears_out(proxy, goal) || !mesh_.open(point, goal)) continue;
            at_ = goal;
            return true;
        }
    }
    return false;
}

} // namespace haptel::test
